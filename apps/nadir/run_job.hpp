// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "ground_job.hpp"
#include "localize_job.hpp"

namespace nadir::cli {

/// The work of `nadir run`: a drive is mapped frame by frame, and every local map goes straight to
/// the localizer.
class RunJob {
 public:
  /// Opens the drive and checks everything. Throws Error (usage, input).
  RunJob(const DriveOptionsOfVerb& drive, const LocalizeOptions& options,
         const Invocation& invocation, int threads);

  int explain() const { return localizing_.explain(); }
  /// The exit codes of LocalizeJob, and the warnings of the mapping on standard error.
  int run();

 private:
  LocalizeInput input_of(const std::filesystem::path& place, int seeds);
  Frame map(const Sequence::LocalMap& local_map);
  Frame map_once(const Sequence::LocalMap& local_map);

  const Invocation& invocation_;
  Drive drive_;
  DriveMapping mapping_;
  std::size_t next_ = 0;         ///< of the local maps that are due
  std::map<int, Frame> mapped_;  ///< by number, where several seeds ask for them
  LocalizeJob localizing_;
};

}  // namespace nadir::cli
