// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/verdict.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/pipelines/effective_options.hpp"
#include "nadir/runs/output_folder.hpp"
#include "seed_run.hpp"
#include "viewer/live_view.hpp"

namespace nadir::cli {

struct LocalizeOptions {
  std::filesystem::path site;
  std::filesystem::path run;
  std::filesystem::path map;
  std::filesystem::path surface;
  std::string frames;
  std::string odometry = "auto";
  PriorOptions start;
  int seeds = 1;
  bool keep_maps = false;  ///< of a drive: its local maps, as a site in the run folder
  bool serve = false;      ///< let browsers watch
  double rate_hz = 0.0;
  ServerOptions server;
  OptionSources sources;
};

/// Where the local maps of a job come from: a site, or a drive that is mapped on the way.
struct LocalizeInput {
  std::filesystem::path place;  ///< of the site or the drive, for errors and records
  /// A site as it was read; of a drive, one whose local maps have numbers and stamps, no files.
  Sequence sequence;
  /// Of a drive; asked for the same frames again with every seed. Empty = from the files of the
  /// sequence.
  FrameReader read;
  std::vector<std::filesystem::path> inputs;
  /// Of a drive, when all its frames have been read: why its local maps must not be relied on.
  std::function<std::vector<std::string>()> doubts = {};
};

/// The work of `nadir localize` and of the second half of `nadir run`: run every seed, write,
/// report.
class LocalizeJob {
 public:
  /// Reads the site and checks all options. Throws Error (usage, input).
  LocalizeJob(const LocalizeOptions& options, const Invocation& invocation, int threads);
  /// The same of local maps from elsewhere.
  LocalizeJob(LocalizeInput input, const LocalizeOptions& options, const Invocation& invocation,
              int threads);

  /// --dry-run: says what would be done; returns the exit code.
  int explain() const;
  /// Returns the exit code: 4 where no frame could be compared, 5 where poses or local maps are
  /// doubtful.
  int run();

 private:
  std::vector<std::filesystem::path> inputs() const;
  FrameReader keeping_reader();
  void finish_kept_site();
  std::vector<SeedRun> run_seeds(const Orthomosaic& map, const std::filesystem::path& folder);
  /// The map is in the making: its new versions are taken up between frames.
  void follow_map();
  void draw(const Orthomosaic& map, const SeedRun& run, const std::filesystem::path& folder,
            const StopToken& stop);
  /// Adds pictures and page, and puts the run in place.
  void complete(const Orthomosaic& map, const SeedRun& run, OutputFolder& output);
  void write_summary_files(const std::vector<SeedRun>& runs, const std::filesystem::path& folder,
                           const Verdict& verdict, double seconds) const;
  Verdict verdict_of(const std::vector<SeedRun>& runs) const;
  void report(const std::vector<SeedRun>& runs, const Verdict& verdict) const;

  const LocalizeOptions& options_;
  const Invocation& invocation_;
  int threads_;
  EffectiveOptions effective_;
  LocalizeInput input_;
  std::vector<Sequence::LocalMap> frames_;
  std::filesystem::path map_file_;
  std::optional<std::filesystem::path> surface_file_;
  bool use_odometry_file_;
  MapReader new_map_;  ///< empty where the map is finished
  std::vector<std::string> figures_;
  std::unique_ptr<LiveView> live_;
  std::unique_ptr<SequenceWriter> kept_;  ///< the site in the run folder
  bool kept_any_ = false;
};

}  // namespace nadir::cli
