// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/focal_prior.hpp"

#include <gtest/gtest.h>

#include "nadir/aerial_mapping/attitude.hpp"

namespace nadir {
namespace {

PhotoMetadata fc300s() {
  PhotoMetadata metadata;
  metadata.name = "a.jpg";
  metadata.width = 1600;
  metadata.height = 900;
  metadata.exif_width = 4000;
  metadata.make = "DJI";
  metadata.model = "FC300S";
  metadata.focal_length_mm = 3.6;  // as EXIF rounds it
  metadata.focal_length_35mm = 20.0;
  return metadata;
}

TEST(FocalPrior, SensorTableWinsAndTheOtherValueIsSaid) {
  std::vector<std::string> warnings;
  const FocalPrior prior = focal_prior(fc300s(), 1600, &warnings);
  EXPECT_NEAR(prior.focal_px, 3.61 / 6.17 * 1600, 0.01);
  EXPECT_DOUBLE_EQ(prior.relative_sigma, 0.02);
  ASSERT_EQ(warnings.size(), 1U);  // 889 px by the 35 mm equivalent, 5.3 % away
  EXPECT_NE(warnings[0].find("889"), std::string::npos) << warnings[0];
}

TEST(FocalPrior, FollowsTheWorkingSizeNotTheClaimedOne) {
  EXPECT_NEAR(focal_prior(fc300s(), 800).focal_px, 0.5 * focal_prior(fc300s(), 1600).focal_px,
              1e-9);
}

TEST(FocalPrior, UprightPhotosSpanTheSensorWithTheirHeight) {
  PhotoMetadata upright = fc300s();
  std::swap(upright.width, upright.height);
  EXPECT_NEAR(focal_prior(upright, 900).focal_px, focal_prior(fc300s(), 1600).focal_px, 1e-9);
}

TEST(FocalPrior, FocalPlaneResolutionIsOfTheFullSize) {
  PhotoMetadata metadata;
  metadata.width = 1000;
  metadata.height = 750;
  metadata.exif_width = 4000;
  metadata.focal_length_mm = 8.0;
  metadata.focal_plane_pixels_per_mm = 4000 / 10.0;  // a sensor 10 mm wide
  EXPECT_NEAR(focal_prior(metadata, 1000).focal_px, 800.0, 1e-9);
}

TEST(FocalPrior, EquivalentThenAnAssumption) {
  PhotoMetadata metadata = fc300s();
  metadata.model = "unheard of";
  EXPECT_NEAR(focal_prior(metadata, 1600).focal_px, 20.0 / 36.0 * 1600, 1e-9);
  EXPECT_DOUBLE_EQ(focal_prior(metadata, 1600).relative_sigma, 0.05);
  metadata.focal_length_35mm.reset();
  std::vector<std::string> warnings;
  EXPECT_GE(focal_prior(metadata, 1600, &warnings).relative_sigma, 0.2);
  EXPECT_EQ(warnings.size(), 1U);
}

TEST(PhotoAttitude, StraightDownHasItsUpperEdgeAtTheYaw) {
  const double yaw = 0.7;
  const Eigen::Matrix3d r = map_from_camera_rotation({yaw, -M_PI / 2, 0.0});
  const Eigen::Vector3d up = r * Eigen::Vector3d(0.0, -1.0, 0.0);
  EXPECT_NEAR(up.x(), std::cos(yaw), 1e-12);
  EXPECT_NEAR(up.y(), std::sin(yaw), 1e-12);
  EXPECT_NEAR(r(2, 2), -1.0, 1e-12);
  EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
  EXPECT_NEAR(yaw_of_camera(r), yaw, 1e-12);
}

TEST(PhotoAttitude, PitchLooksAheadAndRollTurnsAboutTheAxis) {
  const Eigen::Matrix3d r = map_from_camera_rotation({0.3, -0.4, 0.0});
  EXPECT_NEAR(r(2, 2), std::sin(-0.4), 1e-12);
  EXPECT_NEAR(yaw_of_camera(r), 0.3, 1e-12);
  const Eigen::Matrix3d rolled = map_from_camera_rotation({0.3, -0.4, 0.2});
  EXPECT_NEAR(rolled(2, 2), r(2, 2), 1e-12);
  // Roll to the right, as seen from behind the camera: the right-hand side goes down.
  EXPECT_LT(rolled(2, 0), 0.0);
}

}  // namespace
}  // namespace nadir
