// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/simulate/simulated_site.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/drives/drive_writer.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/photos/photo_file.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;

constexpr double kTruthResolution = 0.10;
/// Random numbers of flight and drive are of the same seed but of one each.
constexpr std::uint64_t kDriveSeed = 0x6472697665;  // "drive" in ASCII

}  // namespace

std::string photo_name(int photo) { return fmt::format("photo_{:04}.jpg", photo); }

SimulatedSite::SimulatedSite(const SimulatedWorld& world, const SimulationOptions& options,
                             std::uint64_t seed, StopToken stop)
    : world_(world),
      at_flight_(world.seen(options.at_flight)),
      flight_(world, at_flight_, options.flight, seed),
      drive_(world, world.seen(options.at_drive), options.route, seed ^ kDriveSeed, options.stereo,
             options.lidar),
      stop_(std::move(stop)) {}

std::vector<int> SimulatedSite::photos(int most) const {
  std::vector<std::pair<double, int>> by_distance;
  for (int photo = 0; photo < flight_.size(); ++photo) {
    const Point3<frames::Map>& above =
        flight_.plan().waypoints[static_cast<std::size_t>(photo)].position;
    double nearest = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame < drive_.size(); ++frame) {
      const Eigen::Vector3d& at = drive_.map_from_robot(frame).translation;
      nearest = std::min(nearest, std::hypot(above.x - at.x(), above.y - at.y()));
    }
    by_distance.emplace_back(nearest, photo);
  }
  if (most > 0 && most < flight_.size()) {
    std::ranges::sort(by_distance);
    by_distance.resize(static_cast<std::size_t>(most));
  }
  std::vector<int> photos;
  for (const auto& [distance, photo] : by_distance) photos.push_back(photo);
  std::ranges::sort(photos);
  return photos;
}

double SimulatedSite::travel_m() const {
  double travel = 0.0;
  for (int frame = 1; frame < drive_.size(); ++frame) {
    travel +=
        (drive_.map_from_robot(frame).translation - drive_.map_from_robot(frame - 1).translation)
            .norm();
  }
  return travel;
}

void SimulatedSite::write_photos(const fs::path& folder, const std::vector<int>& photos,
                                 const Tick& tick) const {
  create_folder(folder);
  for (const int photo : photos) {
    stop_.check();
    Photo rendered = flight_.render(photo);
    rendered.metadata.name = photo_name(photo);
    nadir::write_photo(folder / photo_name(photo), rendered);
    tick();
  }
}

void SimulatedSite::write_stereo(const fs::path& folder, const Tick& tick) const {
  StereoDriveWriter writer(folder, drive_.stereo_rig());
  for (int frame = 0; frame < drive_.size(); ++frame) {
    stop_.check();
    writer.write(drive_.stereo(frame), drive_.odom_from_robot(frame));
    tick();
  }
  writer.write_truth(truth_on_grid());
  writer.finish();
}

void SimulatedSite::write_lidar(const fs::path& folder, const Tick& tick) const {
  LidarDriveWriter writer(folder, drive_.lidar_rig());
  for (int frame = 0; frame < drive_.size(); ++frame) {
    stop_.check();
    writer.write(drive_.lidar(frame), drive_.odom_from_robot(frame));
    tick();
  }
  writer.write_truth(truth_on_grid());
  writer.finish();
}

Trajectory SimulatedSite::truth_on_grid() const {
  Trajectory truth = drive_.truth();
  for (auto& stamped : truth) stamped.pose = world_.anchor().on_grid(stamped.pose);
  return truth;
}

void SimulatedSite::write_truth(const fs::path& folder, const std::vector<int>& photos,
                                const std::string& name, const Tick& tick) const {
  const GeoReference geo{0.0, world_.depth_m(), kTruthResolution, {}};
  const int width = static_cast<int>(std::lround(world_.width_m() / kTruthResolution));
  const int height = static_cast<int>(std::lround(world_.depth_m() / kTruthResolution));
  Orthomosaic map = at_flight_.true_orthomosaic(geo, width, height);
  ElevationMap surface = at_flight_.true_surface(geo, width, height);
  map.geo = surface.geo = world_.anchor().on_grid(geo);

  create_folder(folder);
  SequenceWriter writer(folder, name);
  writer.write_map(map);
  writer.write_surface(surface);
  Odometry odometry;
  for (int frame = 0; frame < drive_.size(); ++frame) {
    stop_.check();
    const Frame local = drive_.true_local(frame, {});
    writer.write_local_map(frame, drive_.stamp(frame), local.local, local.elevation);
    odometry.push_back({drive_.stamp(frame), planar(drive_.odom_from_robot(frame))});
    tick();
  }
  writer.write_odometry(odometry);
  writer.write_truth(truth_on_grid());
  writer.finish();

  std::string poses = "photo,x,y,z,qx,qy,qz,qw\n";
  for (const int photo : photos) {
    const auto& pose = flight_.truth(photo).map_from_camera;
    const Pose2 on_grid =
        world_.anchor().on_grid(Pose2{pose.translation.x(), pose.translation.y(), 0.0});
    const auto& q = pose.rotation;
    poses += fmt::format("{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}\n", photo_name(photo),
                         on_grid.x, on_grid.y, pose.translation.z() + world_.anchor().altitude_m,
                         q.x(), q.y(), q.z(), q.w());
  }
  write_file(folder / "photo_poses.csv", poses);
}

}  // namespace nadir
