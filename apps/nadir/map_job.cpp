// SPDX-License-Identifier: Apache-2.0
#include "map_job.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/file_names.hpp"
#include "nadir/io/photos/colmap_process.hpp"
#include "nadir/io/unfinished_folder.hpp"
#include "nadir/pipelines/flight/flight_poses.hpp"
#include "nadir/pipelines/flight/mapping_work.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/pipelines/threads.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kProgressSteps = 1000;

FlightInput read_input(const MapOptions& options, const AerialMappingOptions& stage,
                       const CommonOptions& common) {
  std::optional<Progress> progress;
  FlightInput input = read_flight(options.flight, stage, [&](int done, int total) {
    stop_if_interrupted();
    if (!progress) progress.emplace("reading photos", total, common);
    progress->update(done);
  });
  progress.reset();
  if (input.frame) print_note("map frame " + input.frame->name(), common.quiet);
  return input;
}

int explain(const MapOptions& options, const FlightInput& input, const CommonOptions& common) {
  const Json plan{{"dry_run", true},
                  {"photos", input.found},
                  {"used", input.set.photos.size()},
                  {"cameras", input.set.cameras.size()},
                  {"crs", input.frame ? Json(input.frame->name()) : Json(nullptr)},
                  {"photo_pixel_m", input.estimate.photo_pixel_m},
                  {"extent_m", {input.estimate.width_m, input.estimate.height_m}},
                  {"output", options.map.string()},
                  {"warnings", input.warnings}};
  if (common.json) {
    print(plan);
  } else {
    print(fmt::format("would map {} of {} photos, about {:.0f} x {:.0f} m, to {}\n",
                      input.set.photos.size(), input.found, input.estimate.width_m,
                      input.estimate.height_m, options.map.string()));
  }
  return 0;
}

/// In a folder beside the map, which goes when the poses have been read.
void solve_by_colmap(const MapOptions& options, const CommonOptions& common, FlightInput& input) {
  const fs::path work = options.map.parent_path() / ("." + short_name(options.map.stem()) +
                                                     ".colmap-" + std::to_string(getpid()));
  fs::remove_all(work);  // of a run that was killed, in another container, under this number
  fs::create_directories(work);
  std::vector<std::string> names;
  for (const fs::path& file : input.files) {
    names.push_back(fs::relative(file, options.flight.photos).string());
  }
  try {
    add_poses(
        run_colmap(
            options.flight.photos, names, work,
            [&](const std::string& step) { print_note(step, common.quiet); }, interrupt_token()),
        "colmap", input);
  } catch (const Stopped&) {
    fs::remove_all(work);
    throw;
  } catch (const Error& error) {
    // Its log is worth keeping where it ran at all.
    if (error.kind() == ErrorKind::kUsage) fs::remove_all(work);
    throw;
  }
  fs::remove_all(work);
}

/// Takes up what an earlier mapping of these photos left beside the map, and leaves there what it
/// finds until the map is written, whatever stops it: a photo that cannot be read, or that does not
/// join, costs no more than itself.
AerialMap map_resumably(const PhotoSet& photos, const AerialMappingOptions& options,
                        const CommonOptions& common, MappingWork& work) {
  try {
    AerialMap map = map_photos(photos, options, mapping_progress(common), &work, interrupt_token());
    if (work.taken_up() > 0) {
      print_note(fmt::format("took up {} features and matches from {}", work.taken_up(),
                             work.folder().string()),
                 common.quiet);
    }
    return map;
  } catch (...) {
    if (work.holds_something()) {
      print_note("the same command goes on from " + work.folder().string(), common.quiet);
    }
    throw;
  }
}

}  // namespace

MappingProgress mapping_progress(const CommonOptions& common) {
  const auto bar = std::make_shared<Progress>("mapping", kProgressSteps, common);
  return [bar](const std::string& stage, double share) {
    double done = 0.0;
    for (const MappingStage& known : kMappingStages) {
      if (stage == known.name) {
        bar->rename("mapping: " + stage);
        bar->update(static_cast<int>(std::lround(kProgressSteps * (done + share * known.share))));
        return;
      }
      done += known.share;
    }
  };
}

void check_size(const AerialMappingOptions& options, const fs::path& map, FlightInput& input) {
  const FlightEstimate& estimate = input.estimate;
  const double pixel = estimate.photo_pixel_m;
  if (pixel > 0.0 && options.resolution_m < 0.5 * pixel) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} m a pixel is finer than half a pixel of the photos ({:.3f} m)",
                            options.resolution_m, pixel),
                "--gsd", fmt::format("give --gsd {:.3f} or coarser", pixel));
  }
  if (pixel > 0.0 && options.resolution_m < pixel) {
    input.warnings.push_back(
        fmt::format("{} m a pixel is finer than the photos ({:.3f} m): the map shows no more",
                    options.resolution_m, pixel));
  }
  const double megapixels =
      estimate.width_m * estimate.height_m / (options.resolution_m * options.resolution_m) / 1e6;
  if (megapixels > 4.0 * options.max_megapixels) {
    throw Error(ErrorKind::kUsage,
                fmt::format("the map would have {:.0f} million pixels ({:.0f} x {:.0f} m at {} m)",
                            megapixels, estimate.width_m, estimate.height_m, options.resolution_m),
                "--gsd", "give a coarser one, or raise aerial_mapping.max_megapixels");
  }
  // Colours, mask, views, quality and sources, and what the writers copy of them.
  constexpr double kMemoryPerPixel = 20.0;
  const double memory_mb = megapixels * kMemoryPerPixel;
  const double installed_mb = 1e-6 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                              static_cast<double>(sysconf(_SC_PAGESIZE));
  if (memory_mb > installed_mb) {
    throw Error(ErrorKind::kUsage,
                fmt::format("the map would need {:.0f} MB of memory ({:.0f} x {:.0f} m at {} m a "
                            "pixel), this machine has {:.0f} MB",
                            memory_mb, estimate.width_m, estimate.height_m, options.resolution_m,
                            installed_mb),
                "--gsd", "give a coarser one, or map a part of the photos");
  }
  constexpr double kBytesPerPixel = 9.0;  // colours, mask, views, quality, before compression
  std::error_code unknown;
  const auto space = fs::space(standing_folder_of(map), unknown);
  const double needed_mb = megapixels * kBytesPerPixel;
  const double free_mb = static_cast<double>(space.available) / 1e6;
  if (!unknown && needed_mb > free_mb) {
    throw Error(ErrorKind::kUsage,
                fmt::format("the map may take {:.0f} MB, {:.0f} MB are free", needed_mb, free_mb),
                map.string(), "free some space or give another -o");
  }
}

int write_map(AerialMap map, const FlightInput& input, const MapOptions& options,
              const CommonOptions& common) {
  const Stopwatch stopwatch;
  const UnfinishedFolder unfinished(options.map);
  const MapFiles files(unfinished.path() / options.map.filename());
  write_file(files.page, report_page(map, input, options.map.filename().string()));
  stop_if_interrupted();
  write_map_files(files, map);
  map.report.seconds.emplace_back("write", stopwatch.seconds());
  const Verdict verdict = verdict_of(map, input, options.allow_parts);
  Json report = report_of(map, input);
  add_verdict(report, verdict);
  write_file(files.report, json_text(report, 2) + "\n");
  stop_if_interrupted();
  move_map_files(files, MapFiles(options.map));
  for (const std::string& warning : map.report.warnings) {
    if (std::ranges::count(map.report.doubts, warning) == 0) print_note(warning, common.quiet);
  }
  return finish(summary_of(map, input),
                text_of(map, input) + "written to " + options.map.string() + "\n", verdict, common);
}

int map_flight(const MapOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  const ThreadLimit limit(common.threads);
  const EffectiveOptions effective(options.sources);
  AerialMappingOptions stage = effective.aerial_mapping();
  require_new(options.map, common);
  require_room_for_sisters(options.map);
  const Stopwatch stopwatch;
  FlightInput input = read_input(options, stage, common);
  const double read_s = stopwatch.seconds();
  for (const std::string& warning : input.warnings) print_note(warning, common.quiet);
  const std::size_t told = input.warnings.size();
  check_size(stage, options.map, input);
  for (std::size_t i = told; i < input.warnings.size(); ++i) {
    print_note(input.warnings[i], common.quiet);
  }
  if (common.dry_run) return explain(options, input, common);

  make_folder_of(options.map);
  if (options.sfm == "colmap") {
    solve_by_colmap(options, common, input);
    stage.refine_given_poses = true;  // so that positions, gimbal and focal length have their say
  }
  MappingWork work(options.map);
  AerialMap map = map_resumably(input.set, stage, common, work);
  map.report.seconds.insert(map.report.seconds.begin(), {"read", read_s});
  const int code = write_map(std::move(map), input, options, common);
  work.remove();
  return code;
}

}  // namespace nadir::cli
