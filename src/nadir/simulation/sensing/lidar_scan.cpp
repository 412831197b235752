// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/sensing/lidar_scan.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"

namespace nadir::simulation {

std::vector<LidarPoint> scan(const Scene& scene, const Sweep& sweep, const LidarRig& rig,
                             const LidarOptions& options, std::uint64_t seed, std::uint64_t stream,
                             const Movers& movers) {
  const RandomStream random(seed, stream);
  std::vector<std::vector<LidarPoint>> rings(static_cast<std::size_t>(options.rings));
  tbb::parallel_for(0, options.rings, [&](int ring) {
    const double step =
        options.rings > 1 ? (options.highest_deg - options.lowest_deg) / (options.rings - 1) : 0.0;
    const double elevation = radians(options.lowest_deg + ring * step);
    for (int column = 0; column < options.columns; ++column) {
      const double turn = static_cast<double>(column) / options.columns;
      const double azimuth = kPi - 2.0 * kPi * turn;  // clockwise, from behind
      const double time = turn * options.sweep_s;
      Transform3<frames::Map, frames::Robot> robot = sweep.begin;
      if (options.sweep_s > 0.0) {
        const double share = time / sweep.seconds;
        robot.rotation = sweep.begin.rotation.slerp(share, sweep.next.rotation);
        robot.translation += share * (sweep.next.translation - sweep.begin.translation);
      }
      const auto lidar = robot * rig.robot_from_lidar;
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d direction = lidar.rotation * beam;
      const RayHit hit = scene.caster().cast(lidar.translation, direction, options.shortest_m,
                                             options.longest_m, &movers);
      const auto index =
          static_cast<std::uint64_t>(ring) * static_cast<std::uint64_t>(options.columns) +
          static_cast<std::uint64_t>(column);
      if (hit.solid == RayHit::kSky || random.uniform(2 * index) < options.dropout) continue;
      const double range = hit.t + options.range_noise_m * random.normal(2 * index + 1);
      const Eigen::Vector3f colour =
          scene.colour(lidar.translation, direction, hit, 0.003 * hit.t, &movers);
      const Eigen::Vector3d p = range * beam;
      rings[static_cast<std::size_t>(ring)].push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()),
           std::min(colour.mean(), 1.0F), static_cast<float>(time)});
    }
  });
  std::vector<LidarPoint> points;
  for (const auto& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  return points;
}

}  // namespace nadir::simulation
