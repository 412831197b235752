// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>

#include "cli/add_verb.hpp"
#include "cli/context.hpp"
#include "cli/interrupt.hpp"
#include "cli/option_flags.hpp"
#include "cli/progress.hpp"
#include "cli/streams.hpp"
#include "cli/verdict.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/pipelines/effective_options.hpp"
#include "nadir/pipelines/manifest_of.hpp"
#include "nadir/pipelines/simulate/simulated_site.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/pipelines/threads.hpp"
#include "nadir/runs/output_folder.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  fs::path site;
  fs::path from;
  fs::path dsm;
  int photos = 0;
  std::string gps;
  std::string sensors = "stereo";
  OptionSources sources;
};

OptionSources with_gps(const SimulateOptions& options) {
  OptionSources sources = options.sources;
  if (!options.gps.empty()) {
    sources.sets.push_back(std::string("simulation.flight_rtk=") +
                           (options.gps == "rtk" ? "true" : "false"));
  }
  return sources;
}

SimulatedWorld make_world(const SimulateOptions& options, const SimulationOptions& simulation,
                          std::uint64_t seed, bool quiet) {
  if (options.from.empty()) {
    if (options.dsm.empty()) return SimulatedWorld::make(seed, simulation.world);
    throw Error(ErrorKind::kUsage, "a surface needs the orthomosaic that lies on it", "--dsm",
                "give --from MAP too");
  }
  std::optional<ElevationMap> surface;
  if (!options.dsm.empty()) surface = read_elevation_map(options.dsm);
  const Orthomosaic map = read_orthomosaic(options.from);
  const std::optional<int> zone =
      utm_zone_at(map.geo.crs, map.geo.x_at(0.5 * map.width()), map.geo.y_at(0.5 * map.height()));
  if (!zone) {
    const SiteAnchor anchor;
    print_note(
        fmt::format(
            "{} is not on the WGS84 grid of its UTM zone: its south-west corner is placed at "
            "{:.0f} east, {:.0f} north in zone {} north",
            options.from.string(), anchor.easting_m, anchor.northing_m, anchor.utm_zone),
        quiet);
  }
  return SimulatedWorld::drape(map, surface, seed, zone);
}

/// A given map leaves nothing to the options of a procedural world: refused rather than ignored,
/// where somebody typed them.
void require_options_of_given_map(const SimulateOptions& options, const OptionOrigins& origins) {
  if (options.from.empty()) return;
  WorldOptions world;
  OptionTable made;
  declare(made, world);
  std::vector<std::string> names{"simulation.drive_lane_offset_m"};
  for (const std::string visit : {"simulation.flight_", "simulation.drive_"}) {
    for (const char* name : {"dryness", "car_share", "cars_per_km"}) names.push_back(visit + name);
  }
  for (const Option& option : made.options()) names.push_back(option.name);
  for (const std::string& name : names) {
    const auto origin = origins.find(name);
    if (origin == origins.end()) continue;
    if (!origin->second.starts_with("--")) continue;  // a file of all options may hold it
    throw Error(ErrorKind::kUsage, name + " is for procedural worlds, --from gives a map",
                origin->second, "leave one of the two out");
  }
}

std::vector<fs::path> inputs_of(const SimulateOptions& options) {
  std::vector<fs::path> inputs;
  for (const fs::path& path : {options.from, options.dsm}) {
    if (!path.empty()) inputs.push_back(path);
  }
  return inputs;
}

Json describe(const SimulateOptions& options, const SimulationOptions& simulation,
              const SimulatedSite& site, std::size_t photos) {
  const FlightOptions& flight = simulation.flight;
  return {{"output", options.site.string()},
          {"photos", photos},
          {"photo_width_px", flight.image_width},
          {"photo_height_px", flight.image_height},
          {"photo_resolution_m", flight.height_m / flight.focal_px},
          {"gps", flight.rtk ? "rtk" : "consumer"},
          {"sensors", options.sensors},
          {"frames", site.drive().size()},
          {"travel_m", site.travel_m()}};
}

std::string in_words(const Json& site) {
  return fmt::format(
      "{} photos of {} x {} px, {:.3f} m a pixel, {} GPS; {} frames ({}) over {:.0f} m\n",
      site["photos"].get<int>(), site["photo_width_px"].get<int>(),
      site["photo_height_px"].get<int>(), site["photo_resolution_m"].get<double>(),
      site["gps"].get<std::string>(), site["frames"].get<int>(), site["sensors"].get<std::string>(),
      site["travel_m"].get<double>());
}

std::string where(const SimulateOptions& options) {
  const std::string drive = options.sensors == "both" ? "stereo, lidar" : options.sensors;
  return fmt::format("written to {}: photos, {}, truth\n", options.site.string(), drive);
}

void write_site(const SimulateOptions& options, const SimulatedSite& site,
                const std::vector<int>& photos, const std::string& name,
                const CommonOptions& common, const fs::path& folder) {
  const bool stereo = options.sensors != "lidar";
  const bool lidar = options.sensors != "stereo";
  const int passes = 1 + (stereo ? 1 : 0) + (lidar ? 1 : 0);
  Progress progress("simulating", static_cast<int>(photos.size()) + passes * site.drive().size(),
                    common);
  int done = 0;
  const auto tick = [&] { progress.update(++done); };
  site.write_photos(folder / "photos", photos, tick);
  if (stereo) site.write_stereo(folder / "stereo", tick);
  if (lidar) site.write_lidar(folder / "lidar", tick);
  site.write_truth(folder / "truth", photos, name, tick);
}

int run(const SimulateOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  require_device(common.device);
  const ThreadLimit limit(common.threads);
  const EffectiveOptions effective(with_gps(options));
  require_options_of_given_map(options, effective.origins());
  const SimulationOptions& simulation = effective.simulation();
  const std::vector<fs::path> inputs = inputs_of(options);
  require_writable(options.site, common.overwrite, inputs);
  const Stopwatch stopwatch;
  const SimulatedSite site(make_world(options, simulation, common.seed, common.quiet), simulation,
                           common.seed, interrupt_token());
  const std::vector<int> photos = site.photos(options.photos);
  Json document = describe(options, simulation, site, photos.size());
  if (common.dry_run) {
    document["dry_run"] = true;
    common.json ? print(document) : print("would make: " + in_words(document));
    return 0;
  }
  OutputFolder output(options.site, common.overwrite, inputs);
  const std::string name = fmt::format("simulated, seed {}", common.seed);
  write_site(options, site, photos, name, common, output.staging());
  Manifest manifest = manifest_of(context_of(invocation), limit.threads(), inputs);
  manifest.stages.push_back({"simulate", stopwatch.seconds()});
  write_manifest(output.staging(), manifest, effective.table(), effective.origins());
  output.commit();
  return finish(document, in_words(document) + where(options), {}, common);
}

void add_world(CLI::App& verb, SimulateOptions& options) {
  add_option_flag(verb, options.sources, "--preset", "simulation.preset");
  verb.add_option("--from", options.from,
                  "Take the ground from this orthomosaic instead; the drive keeps to what is free")
      ->type_name("MAP");
  verb.add_option("--dsm", options.dsm, "Heights of that map: a surface model")->type_name("FILE");
}

void add_visits(CLI::App& verb, SimulateOptions& options) {
  verb.add_option("--photos", options.photos,
                  "Take only the photos nearest to the drive, this many; 0 = all")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  add_option_flag(verb, options.sources, "--height", "simulation.flight_height_m");
  add_option_flag(verb, options.sources, "--forward-overlap", "simulation.flight_forward_overlap");
  add_option_flag(verb, options.sources, "--side-overlap", "simulation.flight_side_overlap");
  verb.add_option("--gps", options.gps, "Receiver of the drone: consumer, rtk")
      ->check(CLI::IsMember({"consumer", "rtk"}));
  add_option_flag(verb, options.sources, "--frames", "simulation.drive_frames");
  verb.add_option("--sensors", options.sensors, "Of the robot: stereo, lidar, both")
      ->check(CLI::IsMember({"stereo", "lidar", "both"}))
      ->capture_default_str();
}

}  // namespace

void add_simulate(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<SimulateOptions>(
      program, invocation, "simulate", "Make a site: drone photos, a drive, and the truth", run);
  verb->add_option("-o,--output", options.site, "Folder to write")->type_name("SITE")->required();
  add_world(*verb, options);
  add_visits(*verb, options);
  add_config_and_set(*verb, options.sources);
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir simulate -o out/site\n"
      "  nadir simulate -o out/site --preset parking --seed 3 --height 60 --gps rtk\n"
      "  nadir simulate -o out/site --from campus.tif --dsm surface.tif --sensors lidar\n"
      "SITE holds photos/ (JPEG with EXIF and XMP), stereo/ and lidar/ as asked (KITTI's layout,\n"
      "odometry and true poses) and truth/, a site of its own: what a perfect pipeline would make "
      "of it.\n");
}

}  // namespace nadir::cli
