// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "aerial_mapping/flight.hpp"
#include "nadir/aerial_mapping/incremental_mapper.hpp"

namespace nadir {
namespace {

TEST(IncrementalMapper, GrowsOnOneGridAndEndsAsTheBatchMap) {
  if (!can_solve_poses()) GTEST_SKIP() << "built without NADIR_WITH_SFM";
  test::FlightErrors errors;
  errors.gps_bias = {500040.0, 5200060.0, 180.0};  // as far from the origin as UTM is
  const test::Flight flight =
      test::fly(std::make_shared<const test::Terrain>(), {.strips = 2, .photos = 4}, errors);
  AerialMappingOptions options;
  options.features_per_photo = 1500;
  options.gps_sigma_m = 0.5;
  PhotoSet frame = flight.set;
  frame.photos.clear();
  IncrementalMapper mapper(frame, options);

  int photos = 0;
  GeoReference first;
  for (const MappingPhoto& photo : flight.set.photos) {
    const MapUpdate update = mapper.add(photo);
    ++photos;
    EXPECT_EQ(update.version, photos);
    EXPECT_FALSE(update.changed_tiles.empty()) << photo.name;
    const Orthomosaic& ortho = mapper.current().ortho;
    ASSERT_FALSE(ortho.image.empty());
    if (photos == 1) {
      EXPECT_TRUE(update.provisional);
      first = ortho.geo;
      const auto& quality = mapper.current().quality.values();
      EXPECT_LE(*std::max_element(quality.begin(), quality.end()), kProvisionalQuality);
    } else {
      EXPECT_TRUE(update.registered) << photo.name;
    }
    // Pixels of all versions lie on one grid.
    const double columns = (ortho.geo.west - first.west) / first.resolution;
    const double rows = (ortho.geo.north - first.north) / first.resolution;
    EXPECT_NEAR(columns, std::round(columns), 1e-4);
    EXPECT_NEAR(rows, std::round(rows), 1e-4);
  }
  EXPECT_EQ(mapper.current().poses.size(), 8U);

  const AerialMap batch = map_photos(flight.set, options);
  // The preview is the same place as the final map: camera positions to a map pixel or two.
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_LT((mapper.current().poses[i].map_from_camera.translation -
               batch.poses[i].map_from_camera.translation)
                  .norm(),
              0.5);
  const AerialMap last = mapper.finish();
  EXPECT_EQ(last.ortho.image, batch.ortho.image);
  EXPECT_EQ(last.ortho.valid, batch.ortho.valid);
  EXPECT_EQ(last.ortho.geo, batch.ortho.geo);
}

}  // namespace
}  // namespace nadir
