// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/camera.hpp"

#include <gtest/gtest.h>

namespace nadir {
namespace {

TEST(CameraModel, RayUndoesProjectOverTheWholeImage) {
  const CameraModel camera{1600, 900, 936, 940, 801.5, 447.25, -0.12, 0.03, 4e-4, -3e-4, 0.002};
  for (int v = 0; v < camera.height; v += 50) {
    for (int u = 0; u < camera.width; u += 50) {
      const Eigen::Vector2d pixel{u, v};
      const auto again = camera.project(camera.ray(pixel) * 7.5);
      ASSERT_TRUE(again);
      EXPECT_LT((*again - pixel).norm(), 1e-5);
    }
  }
}

TEST(CameraModel, TheCentreOfTheFirstPixelIsZero) {
  const CameraModel camera{2, 2, 1.0, 1.0, 0.5, 0.5};
  const auto pixel = camera.project({-0.5, -0.5, 1.0});
  ASSERT_TRUE(pixel);
  EXPECT_DOUBLE_EQ(pixel->x(), 0.0);
  EXPECT_DOUBLE_EQ(pixel->y(), 0.0);
}

TEST(CameraModel, APointBehindTheCameraHasNoPixel) {
  const CameraModel camera{2, 2, 1.0, 1.0, 0.5, 0.5};
  EXPECT_FALSE(camera.project({0.0, 0.0, 0.0}));
  EXPECT_FALSE(camera.project({0.0, 0.0, -1.0}));
}

}  // namespace
}  // namespace nadir
