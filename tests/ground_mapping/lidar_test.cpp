// SPDX-License-Identifier: Apache-2.0
// Perfect depth: points and colours that are exact, so that nothing but the mapping itself errs.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "ground_mapping/scene.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/ground_mapping/mapper.hpp"

namespace nadir::test {
namespace {

bool same(const Raster<float>& a, const Raster<float>& b) {
  return std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end(),
                    [](float x, float y) { return x == y || (x != x && y != y); });
}

/// Points of the ground around a robot, on a grid fine against the cells, coloured by lookup.
LidarFrame dense(const Scene& scene, const LidarRig& rig, const OdomPose3& pose, Stamp stamp,
                 double half_size, double spacing) {
  LidarFrame frame;
  frame.stamp = stamp;
  const auto lidar_from_odom = (pose * rig.robot_from_lidar).inverse();
  for (double x = -half_size; x < half_size; x += spacing) {
    for (double y = -half_size; y < half_size; y += spacing) {
      const auto p = planar(pose) * Point2<frames::Robot>{x, y};
      const auto hit = lidar_from_odom * Point3<frames::Odom>{p.x, p.y, scene.ground(p.x, p.y)};
      frame.points.push_back(
          {static_cast<float>(hit.x), static_cast<float>(hit.y), static_cast<float>(hit.z)});
    }
  }
  for (const MountedCamera& camera : rig.cameras) {
    frame.images.push_back(photograph(scene, camera.model, pose * camera.robot_from_camera));
  }
  return frame;
}

Scene ramped_street() {
  Scene scene;
  scene.kerb_y = 2.0;
  scene.kerb_height = 0.12;
  scene.ramp_x = 6.0;
  scene.ramp_slope = 0.08;
  scene.texture_m = 0.4;
  return scene;
}

const std::vector<LidarFrame>& street_frames() {
  static const std::vector<LidarFrame> frames = [] {
    std::vector<LidarFrame> made;
    for (int i = 0; i < 6; ++i) {
      made.push_back(dense(ramped_street(), make_lidar_rig(), pose_at(0.5 * i, 0.0, 0.0),
                           at_step(i), 6.0, 0.04));
    }
    return made;
  }();
  return frames;
}

LocalMap map_street(const OdomPose3& origin, const GroundMappingOptions& options, bool shuffle,
                    const RenderOptions& rendering) {
  GroundMapper mapper(make_lidar_rig(), options);
  for (int i = 0; i < 6; ++i) {
    const OdomPose3 pose = pose_at(0.5 * i, 0.0, 0.0);
    LidarFrame frame = street_frames()[static_cast<std::size_t>(i)];
    if (shuffle) {
      std::mt19937 random(static_cast<unsigned>(i));
      std::shuffle(frame.points.begin(), frame.points.end(), random);
    }
    const Transform3<frames::Odom, frames::Odom> moved{origin.rotation, origin.translation};
    mapper.integrate(frame, moved * pose);
  }
  return mapper.render(rendering);
}

TEST(PerfectDepth, HeightsAndColoursAreRight) {
  for (const ColourRule rule : {ColourRule::kMean, ColourRule::kInverse}) {
    GroundMappingOptions options;
    options.colour_rule = rule;
    const LocalMap map = map_street({}, options, false, {.size_x_m = 9.0, .size_y_m = 6.0});
    const Agreement a = agreement(truth_under(ramped_street(), map), map);
    EXPECT_LT(a.height_rmse_m, 0.002) << to_string(rule);
    EXPECT_GT(a.zncc, 0.98) << to_string(rule);
    EXPECT_LT(std::abs(a.shift_columns), 0.1) << to_string(rule);
    // The inverse rule takes the mean of whole pixels.
    const double limit = rule == ColourRule::kMean ? 0.1 : 0.15;
    EXPECT_LT(std::abs(a.shift_rows), limit) << to_string(rule);
  }
}

TEST(PerfectDepth, TheOrderOfThePointsDoesNotMatter) {
  for (const ColourRule rule : {ColourRule::kMean, ColourRule::kOverwrite, ColourRule::kNearest}) {
    GroundMappingOptions options;
    options.colour_rule = rule;
    const LocalMap a = map_street({}, options, false, {});
    const LocalMap b = map_street({}, options, true, {});
    EXPECT_EQ(a.ortho.image, b.ortho.image);
    EXPECT_EQ(a.ortho.valid, b.ortho.valid);
    EXPECT_EQ(a.weight, b.weight);
    EXPECT_TRUE(same(a.elevation.height_m, b.elevation.height_m));
    EXPECT_GT(a.coverage, 0.1);
  }
}

double zncc(const LocalMap& a, const LocalMap& b) {
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::size_t i = 0; i < a.ortho.valid.values().size(); ++i) {
    if (a.ortho.valid.values()[i] == kHole || b.ortho.valid.values()[i] == kHole) continue;
    const double x = a.ortho.image.values()[i], y = b.ortho.image.values()[i];
    n += 1, sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
  }
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

TEST(PerfectDepth, LooksTheSameWhereverTheOdometryBegan) {
  const RenderOptions rendering{.size_x_m = 9.0, .size_y_m = 6.0};
  const LocalMap reference = map_street({}, {}, false, rendering);
  for (const auto& [x, y, yaw_deg, z] :
       {std::array{-1234.5, -77.7, 0.0, 0.0}, std::array{500'000.03, -4'000'000.07, 0.0, 0.0},
        std::array{0.0, 0.0, 33.0, 0.0}, std::array{5.0, 0.0, 180.0, 0.0},
        std::array{-3.0, 8.0, 271.0, 0.0}, std::array{0.0, 0.0, 0.0, 4000.0},
        std::array{0.0, 0.0, 0.0, -10.0}}) {
    const LocalMap map = map_street(pose_at(x, y, radians(yaw_deg), z), {}, false, rendering);
    EXPECT_GT(zncc(reference, map), 0.99) << x << " " << y << " " << yaw_deg;
    EXPECT_NEAR(map.coverage, reference.coverage, 0.02);
    ASSERT_TRUE(map.ground_in_odom_m.has_value());
    EXPECT_NEAR(*map.ground_in_odom_m - z, *reference.ground_in_odom_m, 0.005);
  }
}

TEST(PerfectDepth, APitchBiasTiltsTheHeightsByItself) {
  Scene scene;
  const LidarRig rig = make_lidar_rig();
  GroundMapper mapper(rig, {});
  const double bias = radians(0.5);
  const OdomPose3 wrong{Eigen::Quaterniond(Eigen::AngleAxisd(bias, Eigen::Vector3d::UnitY())),
                        Eigen::Vector3d::Zero()};
  mapper.integrate(dense(scene, rig, {}, Stamp{0}, 6.0, 0.05), wrong);
  const LocalMap map = mapper.render({.size_x_m = 10.0, .size_y_m = 4.0, .ground_only = false});
  double sxz = 0, sxx = 0;
  for (int row = 0; row < map.ortho.height(); ++row) {
    for (int column = 0; column < map.ortho.width(); ++column) {
      const double h = map.elevation.height_m.at(column, row);
      const double x = map.ortho.geo.x_at(column + 0.5);
      if (std::isnan(h)) continue;
      sxz += x * h;
      sxx += x * x;
    }
  }
  // Nose down: the ground ahead seems lower, by tan(0.5 degrees) a metre (docs/ground-mapping.md).
  EXPECT_NEAR(sxz / sxx, -std::tan(bias), 2e-4);
}

TEST(PerfectDepth, BlackIsAColour) {
  Scene scene;
  scene.brightness = 0.0;
  const LidarRig rig = make_lidar_rig();
  GroundMapper mapper(rig, {});
  mapper.integrate(dense(scene, rig, {}, Stamp{0}, 6.0, 0.05), {});
  const LocalMap map = mapper.render({.size_x_m = 10.0, .size_y_m = 4.0});
  EXPECT_GT(map.coverage, 0.3);
  for (const std::uint8_t value : map.ortho.image.values()) EXPECT_EQ(value, 0);
}

/// How many cells a post at x = 5 m takes that a sweep sees from 5 m/s, at `times` after its stamp.
int cells_of_post(bool timed) {
  LidarRig rig = make_lidar_rig();
  rig.cameras.clear();
  GroundMapper mapper(rig, {});
  mapper.integrate(sweep_at(at_step(0)), pose_at(0.0, 0.0, 0.0));
  LidarFrame frame = sweep_at(at_step(1));
  for (int k = 0; k < 20; ++k) {
    const double time = 0.005 * k;
    frame.points.push_back({static_cast<float>(4.53 - 5.0 * time), 0.03F, -0.7F, 0.0F,
                            timed ? static_cast<float>(time) : 0.0F});
  }
  const FrameStatistics s = mapper.integrate(frame, pose_at(0.5, 0.0, 0.0));
  return s.cells_new;
}

TEST(PerfectDepth, SweepsAreDeskewedByTheMotion) {
  EXPECT_EQ(cells_of_post(true), 1);
  EXPECT_GE(cells_of_post(false), 5);
}

TEST(PerfectDepth, SmallGapsInTheHeightAreFilledAndFlagged) {
  Scene scene;
  const LidarRig rig = make_lidar_rig();
  LidarFrame frame = dense(scene, rig, {}, Stamp{0}, 6.0, 0.05);
  // A ditch of nothing, 0.3 m wide, and one of 1 m.
  std::erase_if(frame.points, [](const LidarPoint& p) {
    return (p.x > 3.0F && p.x < 3.3F) || (p.x > 4.0F && p.x < 5.0F);
  });
  GroundMapper mapper(rig, {});
  mapper.integrate(frame, {});
  const LocalMap map = mapper.render({.size_x_m = 12.0, .size_y_m = 2.0});
  const auto at = [&](double x) {
    const auto p = map.ortho.geo.pixel_at(x, 0.05);
    const int column = static_cast<int>(p.column), row = static_cast<int>(p.row);
    return std::pair{map.ortho.valid.at(column, row), map.elevation.height_m.at(column, row)};
  };
  EXPECT_EQ(at(2.85).first, kMeasured);
  EXPECT_EQ(at(3.15).first, kFilledHeight);
  EXPECT_NEAR(at(3.15).second, 0.0F, 1e-3F);
  EXPECT_EQ(at(4.55).first, kHole);
  EXPECT_TRUE(std::isnan(at(4.55).second));
}

}  // namespace
}  // namespace nadir::test
