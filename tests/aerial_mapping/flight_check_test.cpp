// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/flight.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/expect_error.hpp"

namespace nadir {
namespace {

using test::expect_error;

/// Six photos, 10 m apart, as a drone takes them.
std::vector<PhotoMetadata> flight() {
  std::vector<PhotoMetadata> photos;
  for (int i = 0; i < 6; ++i) {
    PhotoMetadata photo;
    photo.name = std::string(1, static_cast<char>('a' + i)) + ".jpg";
    photo.width = 4000;
    photo.height = 3000;
    photo.make = "DJI";
    photo.model = "FC6310";
    photo.focal_length_mm = 8.8;
    photo.position = GeodeticPosition{46.0 + i * 9e-5, 8.0, 100.0 + 0.01 * i};
    photo.relative_altitude_m = 50.0;
    photo.gimbal = GimbalAttitude{45.0, -90.0, 0.0};
    photos.push_back(photo);
  }
  return photos;
}

bool says(const std::vector<std::string>& warnings, const std::string& a, const std::string& b) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& text) {
    return text.find(a) != std::string::npos && text.find(b) != std::string::npos;
  });
}

TEST(Flight, AGoodOneGivesNoWarning) {
  auto photos = flight();
  const FlightCheck check = check_flight(photos);
  EXPECT_EQ(check.used.size(), 6U);
  EXPECT_TRUE(check.warnings.empty()) << check.warnings.front();
}

TEST(Flight, PositionsThatCannotBeBelievedAreUnknown) {
  auto photos = flight();
  photos[1].position = photos[0].position;  // the receiver repeats itself
  photos[4].position->latitude_deg += 0.5;  // 55 km away
  photos[2].position.reset();
  photos[5].position->altitude_known = false;
  const FlightCheck check = check_flight(photos);
  EXPECT_TRUE(photos[0].position.has_value());
  EXPECT_FALSE(photos[1].position.has_value());
  EXPECT_FALSE(photos[4].position.has_value());
  EXPECT_TRUE(says(check.warnings, "b.jpg", "the very position of another"));
  EXPECT_TRUE(says(check.warnings, "e.jpg", "from every other photo"));
  EXPECT_TRUE(says(check.warnings, "c.jpg", "no position"));
  EXPECT_TRUE(says(check.warnings, "f.jpg", "no altitude"));
  EXPECT_EQ(check.used.size(), 6U) << "photos without a position still take part";
}

TEST(Flight, ObliquePhotosAreLeftOutWhereOthersLookDown) {
  auto photos = flight();
  photos[3].gimbal->pitch_deg = -30.0;
  const FlightCheck check = check_flight(photos);
  EXPECT_EQ(check.used.size(), 5U);
  ASSERT_EQ(check.left_out.size(), 1U);
  EXPECT_EQ(check.left_out[0], "d.jpg");
  for (PhotoMetadata& photo : photos) photo.gimbal->pitch_deg = -45.0;
  const FlightCheck all = check_flight(photos);
  EXPECT_EQ(all.used.size(), 6U);
  EXPECT_TRUE(says(all.warnings, "6 of 6", "look to the side"));
}

TEST(Flight, OrientationTagsDaysAndCamerasAreTold) {
  auto photos = flight();
  photos[0].orientation = 6;
  photos[1].taken_at = Stamp{0};
  photos[2].taken_at = Stamp{3 * 86'400'000'000'000};
  photos[3].serial = "other";
  const FlightCheck check = check_flight(photos);
  EXPECT_TRUE(says(check.warnings, "a.jpg", "orientation tag"));
  EXPECT_TRUE(says(check.warnings, "2 days", "differ"));
  EXPECT_TRUE(says(check.warnings, "2 cameras", "clock"));
}

TEST(Flight, CamerasShareIntrinsicsBySizeAndZoom) {
  auto photos = flight();
  photos[1].width = 2000;
  photos[1].height = 1500;
  photos[1].exif_width = 4000;
  photos[2].focal_length_mm = 24.0;
  const FlightCameras cameras = cameras_of(photos, 1000);
  ASSERT_EQ(cameras.cameras.size(), 3U);
  EXPECT_EQ(cameras.camera_of, (std::vector<std::size_t>{0, 1, 2, 0, 0, 0}));
  EXPECT_EQ(cameras.cameras[0].width, 1000);
  EXPECT_EQ(cameras.cameras[0].height, 750);
  EXPECT_NEAR(cameras.cameras[0].focal.focal_px, 8.8 / 13.2 * 1000.0, 1e-9);
  EXPECT_NEAR(cameras.cameras[1].focal.focal_px, cameras.cameras[0].focal.focal_px, 1e-9)
      << "resized photos have the same field of view";
  EXPECT_TRUE(says(cameras.warnings, "EXIF says 4000 px", "2000 px"));
}

TEST(Flight, CroppedPhotosOfAnUnknownCameraAreRefused) {
  auto photos = flight();
  for (PhotoMetadata& photo : photos) photo.model = "Kite 1";
  photos[2].height = 2250;
  expect_error(ErrorKind::kUsage, {"a.jpg is 4000 x 3000", "c.jpg is 4000 x 2250", "cropped"},
               [&] { cameras_of(photos, 2000); });
  photos[2].height = 4000;  // held upright
  photos[2].width = 3000;
  EXPECT_EQ(cameras_of(photos, 2000).cameras.size(), 2U);
}

TEST(Flight, EstimatesPixelAndExtent) {
  const FlightEstimate estimate = estimate_flight(flight());
  EXPECT_NEAR(estimate.photo_pixel_m, 50.0 / (8.8 / 13.2 * 4000.0), 1e-9);
  EXPECT_NEAR(estimate.width_m, 75.0, 0.1);
  EXPECT_NEAR(estimate.height_m, 75.0 + 5 * 9e-5 * 111320.0, 0.1);
}

TEST(Flight, LongListsAreCut) {
  EXPECT_EQ(listed({"a", "b"}), "a, b");
  EXPECT_NE(listed(std::vector<std::string>(20, "x")).find("and 8 more"), std::string::npos);
}

}  // namespace
}  // namespace nadir
