// SPDX-License-Identifier: Apache-2.0
#include "ground_mapping/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/core/angle.hpp"

namespace nadir::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A value of a lattice point, 0 .. 1.
double lattice(std::int64_t x, std::int64_t y, std::int64_t z) {
  auto h = static_cast<std::uint64_t>(x * 73856093 ^ y * 19349663 ^ z * 83492791);
  h ^= h >> 33;
  h *= 0xff51afd7ed558ccdULL;
  h ^= h >> 33;
  return static_cast<double>(h >> 11) * 0x1.0p-53;
}

/// Smooth noise whose lattice has the given spacing.
double noise(const Eigen::Vector3d& place, double spacing) {
  const Eigen::Vector3d p = place / spacing;
  const Eigen::Vector3d low(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  const auto smooth = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double fx = smooth(p.x() - low.x()), fy = smooth(p.y() - low.y()),
               fz = smooth(p.z() - low.z());
  double sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    const int i = k & 1, j = (k >> 1) & 1, l = k >> 2;
    sum += (i != 0 ? fx : 1.0 - fx) * (j != 0 ? fy : 1.0 - fy) * (l != 0 ? fz : 1.0 - fz) *
           lattice(static_cast<std::int64_t>(low.x()) + i, static_cast<std::int64_t>(low.y()) + j,
                   static_cast<std::int64_t>(low.z()) + l);
  }
  return sum;
}

}  // namespace

double Scene::ground(double x, double y) const {
  return (y > kerb_y ? kerb_height : 0.0) + (x > ramp_x ? (x - ramp_x) * ramp_slope : 0.0);
}

double Scene::grey(const Eigen::Vector3d& place) const {
  const double coarse = noise(place, 4.0 * texture_m);
  const double fine = noise(place + Eigen::Vector3d(31.7, 17.3, 5.1), texture_m);
  const double grains =
      grain > 0.0 ? grain * noise(place + Eigen::Vector3d(7.7, 1.3, 9.1), 0.05) : 0.0;
  // A stripe along the way, 0.3 m wide.
  const double stripe = std::abs(place.y() - 0.8) < 0.15 ? 60.0 : 0.0;
  return std::clamp(brightness * (20.0 + 90.0 * coarse + 70.0 * fine + stripe + grains), 0.0,
                    255.0);
}

double Scene::cast(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
  double nearest = kInfinity;
  const auto meet = [&](double t) {
    if (t > 1e-6) nearest = std::min(nearest, t);
  };
  for (const bool kerb : {false, true}) {
    for (const bool ramp : {false, true}) {
      const double slope = ramp ? ramp_slope : 0.0;
      const double base = (kerb ? kerb_height : 0.0) - (ramp ? ramp_x * ramp_slope : 0.0);
      const double fall = d.z() - slope * d.x();
      if (std::abs(fall) < 1e-12) continue;
      const double t = (base + slope * o.x() - o.z()) / fall;
      const Eigen::Vector3d p = o + t * d;
      if ((p.y() > kerb_y) == kerb && (p.x() > ramp_x) == ramp) meet(t);
    }
  }
  if (std::abs(d.y()) > 1e-12) {  // the kerb's face
    const double t = (kerb_y - o.y()) / d.y();
    const Eigen::Vector3d p = o + t * d;
    const double foot = p.x() > ramp_x ? (p.x() - ramp_x) * ramp_slope : 0.0;
    if (p.z() >= foot && p.z() <= foot + kerb_height) meet(t);
  }
  for (const Box& box : boxes) {
    const Eigen::Vector3d low(box.x_min, box.y_min, 0.0), high(box.x_max, box.y_max, box.height);
    double enter = -kInfinity, leave = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - o[axis]) / d[axis], b = (high[axis] - o[axis]) / d[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter <= leave) meet(enter);
  }
  return nearest;
}

StereoRig make_rig(double height, double pitch_rad, int width, int image_height, double focal,
                   double baseline) {
  StereoRig rig;
  rig.left = {.width = width,
              .height = image_height,
              .fx = focal,
              .fy = focal,
              .cx = 0.5 * (width - 1),
              .cy = 0.5 * (image_height - 1)};
  rig.right = rig.left;
  rig.right_from_left.translation.x() = -baseline;
  const Eigen::Quaterniond down(Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()));
  rig.robot_from_left = {down * forward_camera_rotation(), {0.0, 0.0, height}};
  rig.rectified = true;
  return rig;
}

StereoRig small_rig() { return make_rig(1.2, radians(15.0), 320, 160, 300.0, 0.3); }

Raster<std::uint8_t> photograph(const Scene& scene, const CameraModel& camera,
                                const Transform3<frames::Odom, frames::Camera>& odom_from_camera) {
  Raster<std::uint8_t> image(camera.width, camera.height);
  const Eigen::Vector3d& origin = odom_from_camera.translation;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d pixel(column + (k % 2 == 0 ? -0.25 : 0.25),
                                    row + (k < 2 ? -0.25 : 0.25));
        const Eigen::Vector3d direction = odom_from_camera.rotation * camera.ray(pixel);
        const double t = scene.cast(origin, direction);
        sum += std::isfinite(t) && t < 200.0 ? scene.grey(origin + t * direction) : 200.0;
      }
      image.at(column, row) = static_cast<std::uint8_t>(std::lround(0.25 * sum));
    }
  }
  return image;
}

StereoFrame photograph(const Scene& scene, const StereoRig& rig, const OdomPose3& pose,
                       Stamp stamp) {
  const auto left = pose * rig.robot_from_left;
  const auto right = left * rig.right_from_left.inverse();
  // Both cameras are of one kind for the picture.
  const Transform3<frames::Odom, frames::Camera> right_as_camera{right.rotation, right.translation};
  return {stamp, photograph(scene, rig.left, left), photograph(scene, rig.right, right_as_camera)};
}

LidarRig make_lidar_rig() {
  LidarRig rig;
  rig.robot_from_lidar.translation.z() = 1.2;
  const StereoRig stereo = make_rig(2.5, radians(40.0), 320, 240, 180.0, 0.1);
  rig.cameras.push_back({stereo.left, stereo.robot_from_left});
  return rig;
}

LidarFrame sweep_at(Stamp stamp) {
  LidarFrame frame;
  frame.stamp = stamp;
  return frame;
}

Truth truth_under(const Scene& scene, const LocalMap& map) {
  Truth truth{Raster<float>(map.ortho.width(), map.ortho.height()),
              Raster<float>(map.ortho.width(), map.ortho.height())};
  const auto robot = planar(map.odom_from_robot);
  const double reach = map.ortho.geo.resolution;
  for (int row = 0; row < map.ortho.height(); ++row) {
    for (int column = 0; column < map.ortho.width(); ++column) {
      double grey = 0.0;
      for (int k = 0; k < 25; ++k) {
        const auto p =
            robot * Point2<frames::Robot>{map.ortho.geo.x_at(column + (k % 5 + 0.5) / 5.0),
                                          map.ortho.geo.y_at(row + (k / 5 + 0.5) / 5.0)};
        grey += scene.grey({p.x, p.y, scene.ground(p.x, p.y)}) / 25.0;
      }
      truth.grey.at(column, row) = static_cast<float>(grey);
      const auto p = robot * Point2<frames::Robot>{map.ortho.geo.x_at(column + 0.5),
                                                   map.ortho.geo.y_at(row + 0.5)};
      bool edge = std::abs(p.y - scene.kerb_y) < 1.5 * reach;
      for (const Box& box : scene.boxes) {  // the ground around a box is hidden from some side
        edge |= p.x > box.x_min - 1.0 && p.x < box.x_max + 1.0 && p.y > box.y_min - 1.0 &&
                p.y < box.y_max + 1.0;
      }
      truth.height.at(column, row) = edge ? std::numeric_limits<float>::quiet_NaN()
                                          : static_cast<float>(scene.ground(p.x, p.y));
    }
  }
  return truth;
}

namespace {

double zncc(const Truth& truth, const LocalMap& map, int dx, int dy, double radius) {
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (int row = 1; row + 1 < map.ortho.height(); ++row) {
    for (int column = 1; column + 1 < map.ortho.width(); ++column) {
      if (map.ortho.valid.at(column + dx, row + dy) == kHole ||
          std::isnan(truth.height.at(column, row)) ||
          std::hypot(map.ortho.geo.x_at(column), map.ortho.geo.y_at(row)) > radius) {
        continue;
      }
      const double a = truth.grey.at(column, row), b = map.ortho.image.at(column + dx, row + dy);
      n += 1;
      sa += a;
      sb += b;
      saa += a * a;
      sbb += b * b;
      sab += a * b;
    }
  }
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

}  // namespace

Agreement agreement(const Truth& truth, const LocalMap& map, double radius_m) {
  Agreement result;
  result.zncc = zncc(truth, map, 0, 0, radius_m);
  // The vertex of the parabola through three correlations.
  const auto peak = [&](int dx, int dy) {
    const double before = zncc(truth, map, -dx, -dy, radius_m),
                 after = zncc(truth, map, dx, dy, radius_m);
    return 0.5 * (before - after) / (before - 2.0 * result.zncc + after);
  };
  result.shift_columns = peak(1, 0);
  result.shift_rows = peak(0, 1);
  double n = 0, squares = 0;
  const double ground = map.ground_in_odom_m.value_or(0.0);
  for (int row = 0; row < map.ortho.height(); ++row) {
    for (int column = 0; column < map.ortho.width(); ++column) {
      const double truth_height = truth.height.at(column, row);
      const double height = map.elevation.height_m.at(column, row) + ground;
      if (std::isnan(truth_height) || std::isnan(height) ||
          std::hypot(map.ortho.geo.x_at(column), map.ortho.geo.y_at(row)) > radius_m) {
        continue;
      }
      squares += (height - truth_height) * (height - truth_height);
      n += 1;
    }
  }
  result.height_rmse_m = std::sqrt(squares / n);
  result.compared = n / static_cast<double>(map.ortho.valid.values().size());
  return result;
}

Stamp at_step(int number) { return Stamp{100'000'000LL * number}; }

OdomPose3 pose_at(double x, double y, double yaw, double z) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), {x, y, z}};
}

}  // namespace nadir::test
