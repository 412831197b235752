// SPDX-License-Identifier: Apache-2.0
// The adjustment on exact observations of points: no image has a part in it.
#include "nadir/aerial_mapping/sfm/adjustment.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "nadir/aerial_mapping/sfm/triangulation.hpp"
#include "nadir/core/random.hpp"
#include "nadir/core/rolling_shutter.hpp"

namespace nadir::aerial {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kStrips = 3;
constexpr int kPhotos = 5;  // a strip
constexpr double kStepM = 10.0;
constexpr double kStepS = 2.0;
constexpr double kSpeed = kStepM / kStepS;

/// Strips there and back, 40 m over points with relief, as a rolling shutter sees them.
struct Block {
  PhotoSet set;
  Model truth;
};

Block block_of(double readout_s) {
  Block block;
  const RandomStream noise(3, 1);
  std::uint64_t draw = 0;
  block.set.cameras.push_back({"camera", 480, 360, {400.0, 0.01, "told by the test"}});
  CameraModel camera{480, 360, 400.0, 400.0, 239.5, 179.5, -0.01, 0.0, 0.0, 0.0, 0.0};
  block.truth.cameras = {camera};
  block.truth.readout_s = {readout_s};
  for (int strip = 0; strip < kStrips; ++strip)
    for (int k = 0; k < kPhotos; ++k) {
      const double way = strip % 2 == 0 ? 1.0 : -1.0;
      Pose pose;
      pose.centre = {17.0 * strip, way * kStepM * (k - 0.5 * (kPhotos - 1)), 40.0};
      const double pitch = 2.0 * kDegree * noise.uniform(draw++) - 0.5 * std::numbers::pi;
      const double roll = 2.0 * kDegree * noise.normal(draw++);
      const PhotoAttitude attitude{way * 0.5 * std::numbers::pi, pitch, roll};
      pose.camera_from_map = map_from_camera_rotation(attitude).transpose();
      pose.flown = {0.0, readout_s * way * kSpeed, 0.0};
      pose.known = true;
      block.truth.poses.push_back(pose);
      block.truth.camera_of.push_back(0);
      MappingPhoto photo;
      photo.name = std::to_string(100 + strip * kPhotos + k);
      photo.prior.position = Point3<frames::Map>::from(pose.centre);
      photo.prior.attitude = attitude;
      const double seconds = strip * (kPhotos + 3) * kStepS + k * kStepS;
      photo.prior.taken_at = Stamp{static_cast<std::int64_t>(seconds * 1e9)};
      block.set.photos.push_back(photo);
    }
  for (int i = 0; i < 900; ++i) {
    Landmark landmark;
    const double x = -15.0 + 64.0 * noise.uniform(draw++);
    const double y = -32.0 + 64.0 * noise.uniform(draw++);
    landmark.position = {x, y, 3.0 * noise.normal(draw++)};
    for (std::size_t photo = 0; photo < block.truth.poses.size(); ++photo) {
      const auto pixel = block.truth.project(photo, landmark.position);
      if (pixel && pixel->x() > 0 && pixel->y() > 0 && pixel->x() < 479 && pixel->y() < 359)
        landmark.track.push_back({photo, pixel->x(), pixel->y()});
    }
    landmark.used.assign(landmark.track.size(), 1);
    landmark.valid = landmark.track.size() > 1;
    block.truth.landmarks.push_back(landmark);
  }
  return block;
}

AdjustmentPlan plan_of(double gimbal_deg) {
  AdjustmentPlan plan;
  plan.free_readout = true;
  plan.gimbal_sigma = {gimbal_deg * kDegree, gimbal_deg * kDegree};
  plan.max_iterations = 100;
  return plan;
}

TEST(RollingShutter, ARowIsSeenFromWhereTheCameraWasWhenItWasRead) {
  const Block block = block_of(0.06);
  const Model& model = block.truth;
  for (const Landmark& landmark : model.landmarks)
    for (const Observation& seen : landmark.track) {
      const Pose& pose = model.poses[seen.photo];
      const auto pixel = model.cameras[0].project(
          pose.camera_from_map * (landmark.position - model.centre_at(seen.photo, seen.v)));
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel->x(), seen.u, 0.03);
      EXPECT_NEAR(pixel->y(), seen.v, 0.03);
    }
}

TEST(RollingShutter, StandsStillWithoutMotion) {
  const CameraModel camera = block_of(0.0).truth.cameras[0];
  const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d p{3.0, -2.0, 20.0};
  EXPECT_EQ(*project_row_by_row(camera, turn, p, Eigen::Vector3d::Zero()), *camera.project(p));
  EXPECT_FALSE(project_row_by_row(camera, turn, -p, {1.0, 0.0, 0.0}));
}

TEST(Adjustment, FindsTheReadoutOfARollingShutter) {
  for (const double readout : {0.0, 0.02, 0.05, -0.03}) {
    Block block = block_of(readout);
    Model model = block.truth;
    model.readout_s = {0.0};
    for (Pose& pose : model.poses) pose.flown.setZero();
    AdjustmentState state;
    AerialMappingOptions options;
    options.gps_sigma_m = 0.02;
    adjust(model, state, block.set, options, plan_of(0.02));
    EXPECT_NEAR(model.readout_s[0], readout, 0.003);
    for (std::size_t i = 0; i < model.poses.size(); ++i)
      EXPECT_NEAR((model.poses[i].flown - block.truth.poses[i].flown).norm(), 0.0, 0.015) << i;
  }
}

TEST(Adjustment, KeepsWhatFlewWhereTheReadoutIsHeld) {
  Block block = block_of(0.05);
  Model model = block.truth;
  AdjustmentState state;
  AerialMappingOptions options;
  AdjustmentPlan plan = plan_of(0.02);
  plan.free_readout = false;
  adjust(model, state, block.set, options, plan);
  EXPECT_EQ(model.readout_s[0], 0.05);
  triangulate(model, {0.1, 1.0, 2});
  EXPECT_LT(reprojection_error(model).rms, 0.03);
  for (Pose& pose : model.poses) pose.flown.setZero();
  triangulate(model, {4.0, 1.0, 2});
  EXPECT_GT(reprojection_error(model).rms, 0.1);  // the limit above catches a shutter left out
}

TEST(Adjustment, VelocitiesAtTheEndsOfStripsAreTheStrips) {
  const Block block = block_of(0.0);
  const auto velocities = velocities_of(block.set.photos);
  for (int strip = 0; strip < kStrips; ++strip)
    for (int k = 0; k < kPhotos; ++k) {
      const Eigen::Vector3d expected{0.0, strip % 2 == 0 ? kSpeed : -kSpeed, 0.0};
      EXPECT_LT((velocities[static_cast<std::size_t>(strip * kPhotos + k)] - expected).norm(), 1e-9)
          << strip << " " << k;
    }
}

TEST(Adjustment, SaysHowWellGimbalsAgreeSidewardAndForward) {
  Block block = block_of(0.0);
  const RandomStream noise(5, 1);
  std::uint64_t draw = 0;
  for (Pose& pose : block.truth.poses)
    for (const auto& [axis, sigma] : {std::pair{Eigen::Vector3d::UnitY().eval(), 1.0},
                                      std::pair{Eigen::Vector3d::UnitX().eval(), 0.2},
                                      std::pair{Eigen::Vector3d::UnitZ().eval(), 10.0}})
      // The turn about the viewing direction is the yaw's, which has no part.
      pose.camera_from_map =
          Eigen::AngleAxisd(sigma * kDegree * noise.normal(draw++), axis) * pose.camera_from_map;
  const auto left = gimbal_residuals(block.truth, block.set, 10);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->sideward_rad, 1.0 * kDegree, 0.6 * kDegree);
  EXPECT_NEAR(left->forward_rad, 0.2 * kDegree, 0.15 * kDegree);
  EXPECT_FALSE(gimbal_residuals(block.truth, block.set, 16));
}

}  // namespace
}  // namespace nadir::aerial
