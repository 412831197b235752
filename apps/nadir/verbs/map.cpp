// SPDX-License-Identifier: Apache-2.0
#include "cli/add_verb.hpp"
#include "cli/option_flags.hpp"
#include "follow_job.hpp"
#include "map_job.hpp"
#include "nadir/core/error.hpp"
#include "nadir/pipelines/threads.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

int run(const MapOptions& options, const Invocation& invocation) {
  require_device(invocation.common.device);
  return options.follow ? follow_flight(options, invocation) : map_flight(options, invocation);
}

void add_inputs(CLI::App& verb, MapOptions& options) {
  verb.add_option("photos", options.flight.photos, "Folder of the drone's photos")
      ->type_name("PHOTOS")
      ->required();
  verb.add_option("-o,--output", options.map, "GeoTIFF to write; its sisters lie beside it")
      ->type_name("MAP.tif")
      ->required();
  verb.add_option("--positions", options.flight.positions,
                  "Positions of the photos: CSV name,lat,lon,alt[,yaw,pitch,roll,sigma], or ODM's "
                  "geo.txt; goes before the photos' tags")
      ->type_name("FILE");
  verb.add_option("--gcp", options.flight.control_points,
                  "Ground control points: ODM's gcp_list.txt")
      ->type_name("FILE");
  verb.add_option(
          "--poses", options.flight.poses,
          "Poses of the photos, taken as they are: folder of a COLMAP text model, OpenSfM's "
          "reconstruction.json, Metashape's cameras.xml or MAP.poses.json")
      ->type_name("FILE");
  verb.add_option("--sfm", options.sfm,
                  "Who finds the poses: nadir, or colmap where that program is installed")
      ->check(CLI::IsMember({"nadir", "colmap"}))
      ->capture_default_str();
  verb.add_option("--metres-per-pixel", options.flight.metres_per_pixel,
                  "Size of a photo's pixel on the ground, where there are no positions")
      ->check(CLI::PositiveNumber);
  verb.add_flag("--allow-parts", options.allow_parts,
                "Photos that do not join the map are no failure");
}

void add_follow(CLI::App& verb, MapOptions& options) {
  CLI::Option* follow =
      verb.add_flag("--follow", options.follow,
                    "Map while photos arrive in the folder; MAP.tif is kept up to date");
  verb.add_option("--photos", options.photos, "--follow ends after so many photos")
      ->check(CLI::PositiveNumber)
      ->needs(follow);
  verb.add_option("--idle", options.idle_s, "--follow ends when no photo has come for so long, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

}  // namespace

void add_map(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<MapOptions>(
      program, invocation, "map", "Make the drone's photos one georeferenced orthomosaic", run);
  add_inputs(*verb, options);
  add_follow(*verb, options);
  add_option_flag(*verb, options.sources, "--gsd", "aerial_mapping.resolution_m");
  add_option_flag(*verb, options.sources, "--surface", "aerial_mapping.surface");
  add_option_sources(*verb, options.sources);
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir map flight/ -o campus.tif\n"
      "  nadir map flight/ -o campus.tif --gsd 0.05 --gcp gcp_list.txt --json\n"
      "  nadir map kite/ -o field.tif --metres-per-pixel 0.03 --allow-parts\n"
      "  nadir map incoming/ -o live.tif --follow --idle 120\n"
      "Beside MAP.tif: MAP.surface.tif (heights), MAP.views.tif, MAP.quality.tif, MAP.poses.json,\n"
      "MAP.report.json and MAP.report.html (docs/formats.md).\n");
}

}  // namespace nadir::cli
