// SPDX-License-Identifier: Apache-2.0
#include "end_to_end/small_site.hpp"

#include "end_to_end/nadir_process.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/simulation/simulated_drive.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeed = 5;

fs::path write_small_site() {
  WorldOptions place;
  place.width_m = 70.0;
  place.depth_m = 60.0;
  place.margin_m = 5.0;
  place.texel_m = 0.10;
  const SimulatedWorld world = SimulatedWorld::make(kSeed, place);
  RouteOptions route;
  route.frames = kSmallSiteFrames;
  const SimulatedDrive drive(world, world.seen(drive_appearance()), route, kSeed);
  LocalTruthOptions local;
  local.size_m = 12.0;
  local.only_seen = false;

  const fs::path site = scratch_folder() / "site";
  SequenceWriter writer(site, "small");
  writer.write_map(
      world.seen(flight_appearance()).true_orthomosaic({0.0, place.depth_m, 0.10, {}}, 700, 600));
  Odometry odometry;
  for (int number = 0; number < drive.size(); ++number) {
    const Frame frame = drive.true_local(number, local);
    writer.write_local_map(number, frame.stamp, frame.local);
    odometry.push_back({frame.stamp, frame.odom_from_robot.value()});
  }
  writer.write_odometry(odometry);
  writer.write_truth(drive.truth());
  writer.finish();
  return site;
}

}  // namespace

fs::path small_site() {
  static const fs::path site = write_small_site();
  return site;
}

fs::path copy_of_small_site(const std::string& name) {
  const fs::path copy = scratch_folder() / name;
  fs::copy(small_site(), copy, fs::copy_options::recursive);
  return copy;
}

fs::path local_map_file(const fs::path& site, int position) {
  return read_sequence(site).local_maps.at(static_cast<std::size_t>(position)).image;
}

fs::path map_file(const fs::path& site) { return read_sequence(site).map.value(); }

}  // namespace nadir::testing
