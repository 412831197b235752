// SPDX-License-Identifier: Apache-2.0
#include "ground_job.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/context.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/trajectories/tum.hpp"
#include "nadir/pipelines/manifest_of.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/runs/output_folder.hpp"

namespace nadir::cli {

DriveMapping::Options mapping_options(const DriveOptionsOfVerb& drive,
                                      const EffectiveOptions& effective, bool self_check) {
  DriveMapping::Options options{effective.ground_mapping(), effective.local_map(),
                                parse_spacing(drive.every), self_check};
  if (drive.size_m > 0.0) {
    options.local_map.size_x_m = drive.size_m;
    options.local_map.size_y_m = drive.size_m;
  }
  const double grid_m = options.mapping.resolution_m * options.mapping.grid_cells;
  if (std::max(options.local_map.size_x_m, options.local_map.size_y_m) > grid_m) {
    throw Error(ErrorKind::kUsage,
                fmt::format("a local map of {} x {} m is larger than the grid of {:.1f} x {:.1f} m",
                            options.local_map.size_x_m, options.local_map.size_y_m, grid_m, grid_m),
                "--size", "give a smaller one, or a larger ground_mapping.grid_cells");
  }
  return options;
}

GroundJob::GroundJob(const GroundOptions& options, const Invocation& invocation, int threads)
    : options_(options),
      invocation_(invocation),
      threads_(threads),
      effective_(options.sources),
      drive_(open_drive(options.drive.input, options.drive.reading)),
      mapping_(drive_, mapping_options(options.drive, effective_, options.self_check)) {
  require_writable(options.site, invocation.common.overwrite, inputs());
}

std::vector<std::filesystem::path> GroundJob::inputs() const {
  std::vector<std::filesystem::path> inputs = drive_.inputs;
  for (const auto& file : {options_.map, options_.surface}) {
    if (!file.empty()) inputs.push_back(file);
  }
  return inputs;
}

int GroundJob::explain() const {
  if (invocation_.common.json) {
    print(Json{{"dry_run", true},
               {"input", options_.drive.input.string()},
               {"sensor", drive_.is_stereo() ? "stereo" : "lidar"},
               {"frames", drive_.frames.size()},
               {"local_maps", mapping_.due().size()},
               {"output", options_.site.string()}});
  } else {
    print(fmt::format("would map {} {} frames of {} into {} local maps, and write {}\n",
                      drive_.frames.size(), drive_.is_stereo() ? "stereo" : "lidar",
                      options_.drive.input.string(), mapping_.due().size(),
                      options_.site.string()));
  }
  return 0;
}

void GroundJob::write_local_map(SequenceWriter& writer, const RenderedMap& rendered) {
  const LocalMap& map = rendered.map;
  writer.write_local_map(rendered.number, map.stamp, map.ortho, map.elevation);
  render_ms_.push_back(rendered.render_ms);
  low_coverage_ += map.low_coverage ? 1 : 0;
}

void GroundJob::write_maps(SequenceWriter& writer, DriveOverview& overview) {
  Progress progress("mapping", static_cast<int>(drive_.frames.size()), invocation_.common);
  try {
    for (const std::size_t position : mapping_.due()) {
      const auto rendered = mapping_.map_at(position, [&](int done) { progress.update(done); });
      if (!rendered || rendered->map.coverage <= 0.0) continue;
      write_local_map(writer, *rendered);
      overview.add(rendered->map);
    }
  } catch (const Stopped&) {
    if (render_ms_.empty()) throw;  // what is there by now is worth keeping
  }
  if (render_ms_.empty()) {
    throw Error(ErrorKind::kNoResult, "no frame left a point in the map", drive_.name,
                mapping_.warnings().empty() ? "check the calibration and the poses"
                                            : mapping_.warnings().front());
  }
}

Odometry GroundJob::odometry() const {
  Odometry odometry;
  for (const MappedFrame& frame : mapping_.frames()) {
    if (frame.odom_from_robot) odometry.push_back({frame.stamp, planar(*frame.odom_from_robot)});
  }
  return odometry;
}

void GroundJob::write_rest(SequenceWriter& writer, const DriveOverview& overview,
                           const std::filesystem::path& folder, const Verdict& verdict,
                           double seconds) const {
  writer.write_odometry(odometry());
  if (drive_.truth) writer.write_truth(read_tum(*drive_.truth));
  write_png(folder / "overview.png", overview.draw(odometry(), drive_.name + ", odometry frame"));
  write_file(folder / "frames.csv", frames_csv(mapping_.frames()));
  Manifest manifest = manifest_of(context_of(invocation_), threads_, inputs());
  manifest.stages.push_back({interrupted() ? "ground (interrupted)" : "ground", seconds});
  manifest.doubts = verdict.doubts();
  write_manifest(folder, manifest, effective_.table(), effective_.origins());
  writer.finish();
}

int GroundJob::run() {
  const Stopwatch stopwatch;
  OutputFolder output(options_.site, invocation_.common.overwrite, inputs());
  const DriveMapping::Options mapping =
      mapping_options(options_.drive, effective_, options_.self_check);
  SequenceWriter writer(output.staging(), drive_.name);
  DriveOverview overview(*drive_.odometry,
                         std::hypot(mapping.local_map.size_x_m, mapping.local_map.size_y_m) / 2.0,
                         mapping.local_map.resolution_m);
  // Before the local maps: large ones take longer than an interrupt leaves.
  if (!options_.map.empty()) writer.write_map(read_orthomosaic(options_.map));
  if (!options_.surface.empty()) writer.write_surface(read_elevation_map(options_.surface));
  write_maps(writer, overview);
  const GroundReport report = report_of(mapping_, render_ms_, low_coverage_);
  const Verdict verdict(report.doubts);
  write_rest(writer, overview, output.staging(), verdict, stopwatch.seconds());
  output.commit();
  return finish(to_json(report), to_table(report) + "written to " + options_.site.string() + "\n",
                verdict, invocation_.common);
}

}  // namespace nadir::cli
