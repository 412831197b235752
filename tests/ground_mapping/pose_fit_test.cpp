// SPDX-License-Identifier: Apache-2.0
// Poses that fit the images are left in peace; those that do not are named, with the cure.

#include "nadir/ground_mapping/pose_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ground_mapping/scene.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/ground_mapping/mapper.hpp"

namespace nadir::test {
namespace {

using PoseOf = std::function<OdomPose3(int)>;

Scene street() {
  Scene scene;
  scene.kerb_y = 2.0;
  scene.kerb_height = 0.12;
  scene.boxes = {{6.0, 8.0, -4.0, -2.5, 1.0}};
  return scene;
}

Stamp stamp_of(int frame) { return Stamp{100'000'000LL * frame}; }

/// A bend to the left.
OdomPose3 driven(int frame) {
  constexpr double kRadiusM = 12.0;
  const double yaw = 0.25 * frame / kRadiusM;
  return pose_at(kRadiusM * std::sin(yaw), kRadiusM * (1.0 - std::cos(yaw)), yaw);
}

OdomPose3 parked(int /*frame*/) { return pose_at(1.0, 0.5, 0.1); }

PoseFit fit_of(const PoseOf& true_pose, const PoseOf& claimed, int frames,
               const GroundMappingOptions& options = {}) {
  GroundMapper mapper(small_rig(), options);
  for (int i = 0; i < frames; ++i) {
    mapper.integrate(photograph(street(), small_rig(), true_pose(i), stamp_of(i)), claimed(i));
  }
  return mapper.pose_fit();
}

void expect_gross(const PoseOf& true_pose, const PoseOf& claimed,
                  std::initializer_list<std::string> parts) {
  const PoseFit fit = fit_of(true_pose, claimed, 16);
  EXPECT_TRUE(is_gross(fit)) << fit.gross << " of " << fit.pairs << ", " << fit.offset_px << " px";
  const std::string said = pose_misfit(fit).value_or("nothing");
  for (const std::string& part : parts) {
    EXPECT_NE(said.find(part), std::string::npos) << part << " in " << said;
  }
}

PoseOf scaled_by(double factor) {
  return [factor](int frame) {
    OdomPose3 pose = driven(frame);
    pose.translation *= factor;
    return pose;
  };
}

TEST(PosesThatFit, AreFarBelowTheLimit) {
  const PoseFit fit = fit_of(driven, driven, 16);
  EXPECT_GE(fit.pairs, 5);
  EXPECT_EQ(fit.misfits, 0);
  EXPECT_LT(fit.offset_px, 0.5);
  EXPECT_NEAR(fit.step_m, 0.25, 0.01);
  EXPECT_FALSE(pose_misfit(fit).has_value());
}

TEST(PosesThatFit, OfARobotThatStandsAreNotJudged) {
  const PoseFit fit = fit_of(parked, parked, 12);
  EXPECT_EQ(fit.pairs, 0);
  EXPECT_TRUE(std::isnan(fit.offset_px));
  EXPECT_FALSE(pose_misfit(fit).has_value());
}

TEST(PosesThatFit, OfImagesWithoutTextureAreNotJudged) {
  GroundMapper mapper(small_rig(), {});
  for (int i = 0; i < 8; ++i) {
    const Raster<std::uint8_t> plain(320, 160, 90);
    mapper.integrate(StereoFrame{stamp_of(i), plain, plain}, driven(i));
  }
  EXPECT_EQ(mapper.pose_fit().pairs, 0);
  EXPECT_EQ(mapper.pose_fit().steps, 7);
}

TEST(PosesThatDoNotFit, OfAnotherDriveAreGross) {
  const auto other = [](int frame) { return pose_at(0.8 * frame, 0.0, -0.06 * frame); };
  expect_gross(driven, other,
               {"the poses do not fit the images", "px from where", "checked pairs",
                "--poses belongs to this drive"});
}

TEST(PosesThatDoNotFit, AreMappedWhereThatIsAskedFor) {
  GroundMappingOptions options;
  options.check_poses = false;
  const PoseFit fit = fit_of(driven, scaled_by(4.0), 12, options);
  EXPECT_EQ(fit.pairs, 0);
  EXPECT_EQ(fit.steps, 0);
}

TEST(PosesThatDoNotFit, SayWhatWouldFit) {
  expect_gross(driven, scaled_by(1000.0), {"m/s", "millimetres", "Give metres"});
  expect_gross(driven,
               [](int frame) {
                 const auto back = driven(frame).inverse();
                 return OdomPose3{back.rotation, back.translation};
               },
               {"their inverses fit", "not robot_from_odom"});
  expect_gross(driven, [](int frame) { return pose_at(0.25 * frame, 0, -yaw_of(driven(frame))); },
               {"mirrored they fit", "yaw counter-clockwise"});
  expect_gross(driven, parked, {"the poses stand still while the images move"});
  expect_gross(parked, driven, {"the images stand still while the poses move"});
}

TEST(PosesThatDoNotFit, AFewWrongOnesAreNoAlarm) {
  const auto slipped = [](int frame) { return frame == 2 ? driven(4) : driven(frame); };
  const PoseFit fit = fit_of(driven, slipped, 16);
  EXPECT_GE(fit.misfits, 1);
  EXPECT_FALSE(pose_misfit(fit).has_value());
}

TEST(PoseFit, IsJudgedByTheMajority) {
  PoseFit fit{.pairs = 10, .misfits = 5, .gross = 5, .offset_px = 9.0};
  EXPECT_FALSE(pose_misfit(fit).has_value());
  fit.misfits = 6;
  EXPECT_TRUE(pose_misfit(fit).has_value());
  EXPECT_FALSE(is_gross(fit));
  fit.misfits = fit.gross = 8;
  EXPECT_TRUE(is_gross(fit));
  fit = {.pairs = 2, .misfits = 2, .gross = 2, .offset_px = 90.0};
  EXPECT_FALSE(pose_misfit(fit).has_value());
  EXPECT_FALSE(is_gross(fit));
}

TEST(PoseFit, SpeedsThatNoRobotHasAreNamed) {
  const PoseFit fit{.steps = 5, .step_m = 996.04, .speed_m_per_s = 9960.4};
  EXPECT_TRUE(is_gross(fit));
  EXPECT_EQ(pose_misfit(fit).value(),
            "the poses move by 996 m from frame to frame, 9960 m/s: are they in millimetres? Give "
            "metres, and stamps in seconds");
}

}  // namespace
}  // namespace nadir::test
