// SPDX-License-Identifier: Apache-2.0
#include "end_to_end/small_site.hpp"

#include "end_to_end/nadir_process.hpp"
#include "nadir/io/sequence.hpp"
#include "nadir/simulation/drive.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;

fs::path write_small_site() {
  DriveOptions drive;
  drive.frames = kSmallSiteFrames;
  drive.local_size_m = 12.0;
  const SimulatedSite simulated = simulate_drive(5, drive);
  const fs::path site = scratch_folder() / "site";
  SequenceWriter writer(site, "small");
  writer.write_map(simulated.map);
  Odometry odometry;
  int number = 0;
  for (const Frame& frame : simulated.frames) {
    writer.write_local_map(number++, frame.stamp, frame.local);
    odometry.push_back({frame.stamp, frame.odom_from_robot.value()});
  }
  writer.write_odometry(odometry);
  writer.write_truth(simulated.truth);
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
