// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/geo_reference.hpp"

#include <gtest/gtest.h>

namespace nadir {
namespace {

TEST(GeoReference, PixelCentresAreAtOneHalf) {
  const GeoReference geo{100.0, 50.0, 0.1, {}};
  EXPECT_DOUBLE_EQ(geo.x_at(0.5), 100.05);
  EXPECT_DOUBLE_EQ(geo.y_at(0.5), 49.95);  // rows go south
}

TEST(GeoReference, PixelAtIsTheInverseAtUtmScale) {
  const GeoReference geo{512345.6, 5267890.1, 0.1, {}};
  for (const double column : {0.0, 0.5, 17.25, 99999.5}) {
    const PixelCoordinate pixel = geo.pixel_at(geo.x_at(column), geo.y_at(2.0 * column));
    EXPECT_NEAR(pixel.column, column, 1e-7);
    EXPECT_NEAR(pixel.row, 2.0 * column, 1e-7);
  }
}

}  // namespace
}  // namespace nadir
