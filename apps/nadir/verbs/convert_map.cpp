// SPDX-License-Identifier: Apache-2.0
#include "verbs/convert_map.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/verdict.hpp"
#include "map_files.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/maps/orthomosaic_import.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertMapOptions {
  fs::path input;
  fs::path map;
  double resolution_m = 0.0;
  double metres_per_pixel = 0.0;
  std::vector<double> points;
  double distance_m = 0.0;
  std::string crs;
  std::string collar = "none";
};

ImportOptions import_options(const ConvertMapOptions& options) {
  ImportOptions result;
  if (options.resolution_m > 0.0) result.resolution_m = options.resolution_m;
  if (options.metres_per_pixel > 0.0) result.metres_per_pixel = options.metres_per_pixel;
  if (options.distance_m > 0.0) result.distance_m = options.distance_m;
  if (!options.points.empty()) {
    const auto& p = options.points;
    result.points_px = {p.at(0), p.at(1), p.at(2), p.at(3)};
  }
  result.crs = options.crs;
  if (options.collar == "white") result.collar = Collar::kWhite;
  if (options.collar == "black") result.collar = Collar::kBlack;
  return result;
}

int run(const ConvertMapOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  require_new(options.map, common);
  std::error_code unknown;
  if (fs::equivalent(options.input, options.map, unknown)) {
    throw Error(ErrorKind::kUsage, "the output is the input", options.map.string(),
                "give another -o");
  }
  const ImportedOrthomosaic imported = import_orthomosaic(options.input, import_options(options));
  if (!common.dry_run) {
    make_folder_of(options.map);
    write_orthomosaic(options.map, imported.map);
  }
  const GeoReference& geo = imported.map.geo;
  const Json document{{"map", options.map.string()},
                      {"width_px", imported.map.width()},
                      {"height_px", imported.map.height()},
                      {"resolution_m", geo.resolution},
                      {"west", geo.west},
                      {"north", geo.north},
                      {"crs", geo.crs.empty() ? Json(nullptr) : Json(geo.crs)},
                      {"notes", imported.notes}};
  if (!common.json) {
    for (const std::string& note : imported.notes) print_note(note, common.quiet);
  }
  return finish(document,
                options.map.string() + ": " + std::to_string(imported.map.width()) + " x " +
                    std::to_string(imported.map.height()) + " px\n",
                {}, common);
}

}  // namespace

void add_convert_map(CLI::App& parent, Invocation& invocation) {
  auto [verb, options] = add_verb<ConvertMapOptions>(
      parent, invocation, "map",
      "A map of another program: warped to a north-up metric grid, pixels as 8-bit grey or RGB",
      run);
  verb->add_option("input", options.input, "GeoTIFF, COG, VRT, or an image with a world file")
      ->type_name("FILE")
      ->required();
  verb->add_option("-o,--output", options.map, "GeoTIFF to write")
      ->type_name("MAP.tif")
      ->required();
  verb->add_option("--gsd", options.resolution_m, "Metres per pixel of the result")
      ->check(CLI::PositiveNumber);
  verb->add_option("--metres-per-pixel", options.metres_per_pixel,
                   "Size of a pixel of an image without geo-reference")
      ->check(CLI::PositiveNumber);
  verb->add_option("--points", options.points, "Two of its pixels, whose distance is known")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X1,Y1,X2,Y2");
  verb->add_option("--distance", options.distance_m, "Metres between them")
      ->check(CLI::PositiveNumber);
  verb->add_option("--crs", options.crs, "Reference system of a file that names none")
      ->type_name("EPSG:CODE");
  verb->add_option("--collar", options.collar, "Colour of a border that becomes a hole")
      ->check(CLI::IsMember({"none", "white", "black"}))
      ->capture_default_str();
  add_writing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir convert map drone.tif -o map.tif --gsd 0.1\n"
      "  nadir convert map screenshot.png -o map.tif --points 120,80,910,95 --distance 64.5\n");
}

}  // namespace nadir::cli
