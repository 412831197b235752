// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "cli/verdict.hpp"
#include "drive_mapping.hpp"
#include "drive_overview.hpp"
#include "ground_report.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/pipelines/effective_options.hpp"

namespace nadir::cli {

struct GroundOptions {
  DriveOptionsOfVerb drive;
  std::filesystem::path site;
  std::filesystem::path map;      ///< to put into the site; may be empty
  std::filesystem::path surface;  ///< its heights; may be empty
  bool self_check = false;
  OptionSources sources;
};

/// The options of a DriveMapping out of those of a verb. Throws Error (usage).
DriveMapping::Options mapping_options(const DriveOptionsOfVerb& drive,
                                      const EffectiveOptions& effective, bool self_check);

/// The work of `nadir ground`: a drive in, a site out.
class GroundJob {
 public:
  /// Opens the drive and checks everything. Throws Error (usage, input).
  GroundJob(const GroundOptions& options, const Invocation& invocation, int threads);

  /// --dry-run: says what would be done; returns the exit code.
  int explain() const;
  /// Returns the exit code.
  int run();

 private:
  std::vector<std::filesystem::path> inputs() const;
  void write_maps(SequenceWriter& writer, DriveOverview& overview);
  void write_local_map(SequenceWriter& writer, const RenderedMap& rendered);
  void write_rest(SequenceWriter& writer, const DriveOverview& overview,
                  const std::filesystem::path& folder, const Verdict& verdict,
                  double seconds) const;
  Odometry odometry() const;

  const GroundOptions& options_;
  const Invocation& invocation_;
  int threads_;
  EffectiveOptions effective_;
  Drive drive_;
  DriveMapping mapping_;
  std::vector<double> render_ms_;
  int low_coverage_ = 0;
};

}  // namespace nadir::cli
