// SPDX-License-Identifier: Apache-2.0
#include "demo_site.hpp"

#include "nadir/io/sequence.hpp"
#include "nadir/simulation/drive.hpp"

namespace nadir::cli {

void write_demo_site(const std::filesystem::path& site, std::uint64_t seed) {
  const SimulatedSite simulated = simulate_drive(seed, DriveOptions{});
  SequenceWriter writer(site, "demo");
  writer.write_map(simulated.map);
  Odometry odometry;
  int number = 0;
  for (const Frame& frame : simulated.frames) {
    writer.write_local_map(number++, frame.stamp, frame.local);
    if (frame.odom_from_robot) odometry.push_back({frame.stamp, *frame.odom_from_robot});
  }
  if (!odometry.empty()) writer.write_odometry(odometry);
  writer.write_truth(simulated.truth);
  writer.finish();
}

}  // namespace nadir::cli
