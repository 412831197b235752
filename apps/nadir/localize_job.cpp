// SPDX-License-Identifier: Apache-2.0
#include "localize_job.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

#include "cli/context.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "cli/server_options.hpp"
#include "localize_inputs.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/pipelines/flight/growing_map_file.hpp"
#include "nadir/pipelines/manifest_of.hpp"
#include "nadir/pipelines/site.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/pipelines/threads.hpp"
#include "nadir/runs/particle_log.hpp"
#include "run_doubts.hpp"
#include "run_figures.hpp"
#include "run_files.hpp"
#include "run_report.hpp"
#include "run_tracks.hpp"

namespace nadir::cli {
namespace {

/// The local maps of a drive, in the run folder.
constexpr const char* kKeptSite = "site";

std::string seed_folder(std::uint64_t seed) { return "seed_" + std::to_string(seed); }

/// Keeps the cloud of every frame, for the viewer.
class ParticleKeeper : public RunObserver {
 public:
  explicit ParticleKeeper(const std::filesystem::path& folder) : log_(folder / "particles.bin") {}
  void frame_done(const FrameRecord& /*record*/, const ParticleSet& particles) override {
    log_.append(particles);
  }

 private:
  ParticleLogWriter log_;
};

}  // namespace

LocalizeJob::LocalizeJob(const LocalizeOptions& options, const Invocation& invocation, int threads)
    : LocalizeJob({options.site, read_sequence(options.site), {}, {options.site}}, options,
                  invocation, threads) {}

LocalizeJob::LocalizeJob(LocalizeInput input, const LocalizeOptions& options,
                         const Invocation& invocation, int threads)
    : options_(options),
      invocation_(invocation),
      threads_(threads),
      effective_(options.sources),
      input_(std::move(input)),
      frames_(frames_of(options, input_.sequence, invocation.common.quiet)),
      map_file_(map_path(input_.sequence, options.map)),
      surface_file_(surface_path(input_.sequence, options.map, options.surface,
                                 effective_.values().matching.layers)),
      use_odometry_file_(uses_odometry_file(options.odometry, input_.sequence)) {
  effective_.use_device(invocation.common.device);
  if (use_odometry_file_) {
    note_coverage(*input_.sequence.odometry, frames_, invocation.common.quiet);
  }
  start_of(options.start, truth_of(input_.sequence, frames_), invocation.common.seed);
  require_writable(options.run, invocation.common.overwrite, inputs());
}

std::vector<std::filesystem::path> LocalizeJob::inputs() const {
  std::vector<std::filesystem::path> inputs = input_.inputs;
  if (!options_.map.empty()) inputs.push_back(options_.map);
  if (!options_.surface.empty()) inputs.push_back(options_.surface);
  return inputs;
}

int LocalizeJob::explain() const {
  const Json plan{{"dry_run", true},
                  {"site", input_.place.string()},
                  {"map", map_file_.string()},
                  {"surface", surface_file_ ? Json(surface_file_->string()) : Json(nullptr)},
                  {"frames", frames_.size()},
                  {"odometry", use_odometry_file_ ? "file" : "maps"},
                  {"seeds", options_.seeds},
                  {"threads", threads_},
                  {"output", options_.run.string()}};
  if (invocation_.common.json) {
    print(plan);
  } else {
    print(fmt::format("would localize {} frames of {} in {} with {} seeds, and write {}\n",
                      frames_.size(), input_.place.string(), map_file_.string(), options_.seeds,
                      options_.run.string()));
  }
  return 0;
}

/// Reads the frames of a drive, and writes those that show something.
FrameReader LocalizeJob::keeping_reader() {
  return [this](const Sequence::LocalMap& local_map) {
    Frame frame = input_.read(local_map);
    if (frame.elevation) {
      kept_->write_local_map(local_map.number, frame.stamp, frame.local, frame.elevation);
      kept_any_ = true;
    }
    return frame;
  };
}

void LocalizeJob::finish_kept_site() {
  if (!kept_any_) return;
  const Sequence& sequence = input_.sequence;
  if (sequence.odometry) kept_->write_odometry(*sequence.odometry);
  if (sequence.truth) kept_->write_truth(*sequence.truth);
  kept_->finish();
}

std::vector<SeedRun> LocalizeJob::run_seeds(const Orthomosaic& map,
                                            const std::filesystem::path& folder) {
  const int per_seed = static_cast<int>(frames_.size());
  std::optional<ElevationMap> surface;
  if (surface_file_) surface = read_elevation_map(*surface_file_);
  Progress progress("localizing", per_seed * options_.seeds, invocation_.common);
  std::vector<SeedRun> runs;
  for (int k = 0; k < options_.seeds && !interrupted(); ++k) {
    const std::uint64_t seed = invocation_.common.seed + static_cast<std::uint64_t>(k);
    const Prior start = start_of(options_.start, truth_of(input_.sequence, frames_), seed);
    const std::filesystem::path run_folder =
        options_.seeds == 1 ? folder : folder / seed_folder(seed);
    create_folder(run_folder);
    ParticleKeeper particles(run_folder);
    std::vector<RunObserver*> observers{&particles};
    if (live_) observers.push_back(live_.get());
    const RunPlan plan{map,
                       surface,
                       input_.sequence,
                       frames_,
                       effective_.values(),
                       start,
                       seed,
                       use_odometry_file_,
                       observers,
                       kept_ && k == 0 ? keeping_reader() : input_.read,
                       new_map_};
    std::optional<SeedRun> run =
        run_and_judge(plan, [&](int done) { progress.update(k * per_seed + done); });
    if (!run) break;
    write_run(run_folder, run->result, run->truth);
    write_tracks(run_folder, run->result, map.geo, input_.sequence.name);
    runs.push_back(std::move(*run));
  }
  return runs;
}

void LocalizeJob::follow_map() {
  new_map_ = [watched = std::make_shared<GrowingMapFile>(map_file_), this] {
    auto newer = watched->newer();
    if (newer) {
      print_note(fmt::format("took up version {} of {}", watched->version(), map_file_.string()),
                 invocation_.common.quiet);
    }
    return newer;
  };
}

void LocalizeJob::draw(const Orthomosaic& map, const SeedRun& run,
                       const std::filesystem::path& folder, const StopToken& stop) {
  const Evaluation* evaluation = run.judgement ? &run.judgement->evaluation : nullptr;
  const std::string title = fmt::format("{}, seed {}", input_.sequence.name, run.seed);
  Trajectory odometry;
  if (use_odometry_file_) {
    odometry = odometry_alone(*input_.sequence.odometry, run.result, run.truth);
  }
  figures_ =
      draw_run(folder, {map, run.result, run.truth, std::move(odometry), evaluation, title}, stop);
}

void LocalizeJob::complete(const Orthomosaic& map, const SeedRun& run, OutputFolder& output) {
  try {
    draw(map, run, output.staging(), interrupt_token());
    stop_if_interrupted();
    write_run_report(output.staging());
    return output.commit();
  } catch (const Stopped&) {
  }
  // What was computed goes first: there may be no time for the pictures.
  output.commit();
  draw(map, run, options_.run, {});
  write_run_report(options_.run);
}

void LocalizeJob::write_summary_files(const std::vector<SeedRun>& runs,
                                      const std::filesystem::path& folder, const Verdict& verdict,
                                      double seconds) const {
  const auto summary = summary_of(runs);
  if (options_.seeds > 1 && summary) {
    write_file(folder / "summary.json", json_text(to_json(*summary), 2) + "\n");
  }
  Manifest manifest = manifest_of(context_of(invocation_), threads_, inputs());
  manifest.sources = {{"map", map_file_}};
  if (kept_any_) {
    manifest.sources.emplace_back("site", options_.run / kKeptSite);
  } else {
    manifest.sources.emplace_back(input_.read ? "drive" : "site", input_.place);
  }
  if (surface_file_) manifest.sources.emplace_back("surface", *surface_file_);
  const bool partial = interrupted();
  manifest.stages.push_back({partial ? "localize (interrupted)" : "localize", seconds});
  manifest.doubts = verdict.doubts();
  write_manifest(folder, manifest, effective_.table(), effective_.origins());
}

/// Of the mapping of the drive, where there was one, and of every seed.
Verdict LocalizeJob::verdict_of(const std::vector<SeedRun>& runs) const {
  Verdict verdict;
  if (input_.doubts) verdict.doubt(input_.doubts());
  if (std::ranges::all_of(runs, [](const SeedRun& run) { return run.result.answered() == 0; })) {
    verdict.nothing_found({ErrorKind::kNoResult, "no local map could be compared with the map",
                           input_.place.string(),
                           "check the prior and that map and site belong together"});
    return verdict;
  }
  for (const SeedRun& run : runs) {
    for (const std::string& doubt : doubts_of(run)) {
      verdict.doubt(options_.seeds == 1 ? doubt : fmt::format("seed {}: {}", run.seed, doubt));
    }
  }
  return verdict;
}

void LocalizeJob::report(const std::vector<SeedRun>& runs, const Verdict& verdict) const {
  const auto summary = summary_of(runs);
  std::string text = options_.seeds == 1 ? to_text(runs.front())
                     : summary           ? to_table(*summary)
                                         : std::to_string(runs.size()) + " seeds done\n";
  text += "open " + (options_.run / "report.html").string() + "\n";
  Json document = to_json(runs.front());
  if (options_.seeds > 1) {
    document = Json{{"summary", summary ? to_json(*summary) : Json(nullptr)}};
    document["runs"] = Json::array();
    for (const SeedRun& run : runs) document["runs"].push_back(to_json(run));
  }
  document["odometry"] = use_odometry_file_ ? "file" : "maps";
  document["output"] = options_.run.string();
  document["figures"] = figures_;
  document["report"] = (options_.run / "report.html").string();
  print_result(std::move(document), text, verdict, invocation_.common);
}

int LocalizeJob::run() {
  note_device(invocation_.common);
  const Stopwatch stopwatch;
  OutputFolder output(options_.run, invocation_.common.overwrite, inputs());
  if (options_.seeds == 1 && is_growing(map_file_)) follow_map();
  const Orthomosaic map = read_orthomosaic(map_file_);
  if (options_.serve) {
    live_ = std::make_unique<LiveView>(RunSources{options_.site, map_file_}, effective_.values(),
                                       output.staging() / "particles.bin", options_.server,
                                       options_.rate_hz);
    warn_where_open(options_.server, invocation_.common.quiet);
    print_note("watch at " + live_->url(), false);
  }
  if (options_.keep_maps) {
    kept_ = std::make_unique<SequenceWriter>(output.staging() / kKeptSite, input_.sequence.name);
  }
  const std::vector<SeedRun> runs = run_seeds(map, output.staging());
  finish_kept_site();
  if (runs.empty()) throw Stopped{};
  const Verdict verdict = verdict_of(runs);
  write_summary_files(runs, output.staging(), verdict, stopwatch.seconds());
  complete(map, runs.front(), output);
  report(runs, verdict);
  if (live_ && !interrupted()) {
    print_note("finished; still at " + live_->url() + ", Ctrl-C ends", false);
    interrupt_is_the_end(true);
    live_->serve_until_interrupted();
  }
  return conclude(verdict);
}

}  // namespace nadir::cli
