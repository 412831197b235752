// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/checks.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "nadir/io/maps/gdal_info.hpp"
#include "nadir/localizer.hpp"
#include "nadir/map_matching/cuda_status.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/pipelines/threads.hpp"
#include "nadir/simulation/simulated_drive.hpp"

namespace nadir {
namespace {

constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

Check check_driver(const char* name, bool needed) {
  const bool there = has_gdal_driver(name);
  return {std::string("GDAL driver ") + name, there, needed,
          there ? "present" : "missing from this GDAL"};
}

Check check_proj_data() {
  const bool found = knows_epsg_codes();
  return {"PROJ data", found, false,
          found ? "EPSG codes are known" : "proj.db not found: install proj-data or set PROJ_DATA"};
}

Check check_memory() {
  const auto page = static_cast<double>(sysconf(_SC_PAGESIZE));
  const double total = page * static_cast<double>(sysconf(_SC_PHYS_PAGES));
  const double free = page * static_cast<double>(sysconf(_SC_AVPHYS_PAGES));
  return {"memory", total > 0.0, false,
          fmt::format("{:.1f} GiB free of {:.1f}", free / kGibibyte, total / kGibibyte)};
}

Check check_disk() {
  std::error_code error;
  const auto space = std::filesystem::space(".", error);
  if (error) return {"disk", false, false, error.message()};
  return {"disk", space.available > 0, false,
          fmt::format("{:.1f} GiB free here", static_cast<double>(space.available) / kGibibyte)};
}

Check check_gpu() {
  const bool there = std::filesystem::exists("/dev/nvidia0");
  return {"GPU", there, false, there ? "an NVIDIA device is present" : "no NVIDIA device"};
}

}  // namespace

std::vector<Check> check_backends() {
  const CudaStatus cuda = cuda_status();
  return {{"backend cpu", true, true, "built and usable"},
          {"backend reference", true, true, "built and usable; slow, the oracle of the tests"},
          {"backend cuda", cuda.usable, false,
           fmt::format("{}{}: {}", cuda.built ? "built, " : "",
                       cuda.usable ? "usable" : "not usable", cuda.detail)}};
}

std::vector<Check> check_files() {
  return {check_driver("GTiff", true), check_driver("PNG", true),  check_driver("JPEG", true),
          check_driver("VRT", false),  check_driver("COG", false), check_proj_data()};
}

std::vector<Check> check_host() {
  return {{"cores", true, false, fmt::format("{} may be used", allowed_cores())},
          check_memory(),
          check_disk(),
          check_gpu()};
}

Check check_core_path() {
  const Stopwatch stopwatch;
  WorldOptions place;
  place.width_m = place.depth_m = 50.0;
  place.margin_m = 0.0;
  place.texel_m = 0.10;
  const SimulatedWorld world = SimulatedWorld::make(1, place);
  const Orthomosaic map = world.seen(flight_appearance())
                              .true_orthomosaic({0.0, place.depth_m, place.texel_m, {}}, 500, 500);
  RouteOptions route;
  route.frames = 5;
  const SimulatedDrive drive(world, world.seen(drive_appearance()), route, 1);

  LocalTruthOptions all_around;
  all_around.only_seen = false;

  Localizer localizer(map, LocalizerOptions{}, 1);
  localizer.start_near(planar(drive.map_from_robot(0)), Spread{1.0, radians(2.0)});
  Estimate estimate;
  for (int frame = 0; frame < drive.size(); ++frame) {
    estimate = localizer.update(drive.true_local(frame, all_around));
  }
  const Pose2 truth = planar(drive.map_from_robot(drive.size() - 1));
  const double error_m =
      std::hypot(estimate.map_from_robot.x - truth.x, estimate.map_from_robot.y - truth.y);
  return {"core path", error_m < 1.0, true,
          fmt::format("{} simulated frames localized in {:.1f} s, error {:.2f} m", drive.size(),
                      stopwatch.seconds(), error_m)};
}

}  // namespace nadir
