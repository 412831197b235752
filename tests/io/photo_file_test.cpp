// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/photo_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "io/random_raster.hpp"
#include "support/data.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

Photo smooth_photo(int width, int height, int channels) {
  Photo photo;
  photo.image = Raster<std::uint8_t>(width, height, 0, channels);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      for (int channel = 0; channel < channels; ++channel) {
        photo.image.at(column, row, channel) =
            static_cast<std::uint8_t>(column * 120 / width + row * 100 / height + 10 * channel);
      }
    }
  }
  return photo;
}

Photo full_photo() {
  Photo photo = smooth_photo(64, 48, 3);
  PhotoMetadata& m = photo.metadata;
  m.make = "DJI";
  m.model = "FC300S";
  m.serial = "SN 0042";
  m.taken_at = parse_stamp("1466699519.25");
  m.position = GeodeticPosition{46.84260708, -91.994559912, 198.309};
  m.relative_altitude_m = 39.8;
  m.gimbal = GimbalAttitude{-135.25, -89.9, 0.5};
  m.focal_length_mm = 3.61;
  m.focal_length_35mm = 20.0;
  m.focal_plane_pixels_per_mm = 648.3;
  m.exposure_s = 1.0 / 370.0;
  m.iso = 100.0;
  m.f_number = 2.8;
  return photo;
}

void expect_near(const std::optional<double>& a, const std::optional<double>& b, double within) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (a) {
    EXPECT_NEAR(*a, *b, within);
  }
}

void expect_same_position(const GeodeticPosition& a, const GeodeticPosition& b) {
  EXPECT_NEAR(a.latitude_deg, b.latitude_deg, 1e-9);
  EXPECT_NEAR(a.longitude_deg, b.longitude_deg, 1e-9);
  EXPECT_NEAR(a.altitude_m, b.altitude_m, 5e-4);
  EXPECT_EQ(a.ellipsoidal, b.ellipsoidal);
  EXPECT_EQ(a.altitude_known, b.altitude_known);
  expect_near(a.horizontal_sigma_m, b.horizontal_sigma_m, 1e-5);
  expect_near(a.vertical_sigma_m, b.vertical_sigma_m, 1e-5);
}

TEST(PhotoFile, MetadataRoundTrips) {
  const TemporaryFolder folder;
  const Photo written = full_photo();
  write_photo(folder / "DJI_0001.JPG", written);
  const PhotoMetadata m = read_photo_metadata(folder / "DJI_0001.JPG");
  EXPECT_EQ(m.name, "DJI_0001.JPG");
  EXPECT_EQ(m.width, 64);
  EXPECT_EQ(m.height, 48);
  EXPECT_EQ(m.exif_width, 64);
  EXPECT_EQ(m.exif_height, 48);
  EXPECT_EQ(m.orientation, 1);
  EXPECT_EQ(m.make, "DJI");
  EXPECT_EQ(m.model, "FC300S");
  EXPECT_EQ(m.serial, "SN 0042");
  EXPECT_EQ(m.taken_at, written.metadata.taken_at);
  expect_same_position(*m.position, *written.metadata.position);
  expect_near(m.relative_altitude_m, 39.8, 1e-3);
  ASSERT_TRUE(m.gimbal.has_value());
  EXPECT_DOUBLE_EQ(m.gimbal->yaw_deg, -135.25);
  EXPECT_DOUBLE_EQ(m.gimbal->pitch_deg, -89.9);
  EXPECT_DOUBLE_EQ(m.gimbal->roll_deg, 0.5);
  expect_near(m.focal_length_mm, 3.61, 1e-5);
  expect_near(m.focal_length_35mm, 20.0, 0.0);
  expect_near(m.focal_plane_pixels_per_mm, 648.3, 1e-2);
  expect_near(m.exposure_s, 1.0 / 370.0, 1e-8);
  expect_near(m.iso, 100.0, 0.0);
  expect_near(m.f_number, 2.8, 1e-6);
}

TEST(PhotoFile, EveryHemisphereAndAccuracyRoundTrips) {
  const TemporaryFolder folder;
  for (const double latitude : {-33.918861, 0.000001, 89.5}) {
    for (const double longitude : {-179.99999, -0.0000005, 151.2094}) {
      Photo photo = full_photo();
      photo.metadata.position = GeodeticPosition{latitude, longitude, -12.25, true, 0.014, 0.031};
      write_photo(folder / "a.jpg", photo);
      const auto position = read_photo_metadata(folder / "a.jpg").position;
      ASSERT_TRUE(position.has_value());
      expect_same_position(*position, *photo.metadata.position);
    }
  }
}

TEST(PhotoFile, WhatIsNotSaidStaysAbsent) {
  const TemporaryFolder folder;
  write_photo(folder / "bare.jpg", smooth_photo(20, 10, 1));
  const PhotoMetadata m = read_photo_metadata(folder / "bare.jpg");
  EXPECT_FALSE(m.position || m.gimbal || m.relative_altitude_m || m.taken_at || m.exposure_s ||
               m.focal_length_mm || m.focal_length_35mm || m.iso);
  EXPECT_EQ(m.make + m.model + m.serial, "");
  EXPECT_EQ(read_photo(folder / "bare.jpg").image.channels(), 1);
}

TEST(PhotoFile, ZeroPositionAndZeroAltitudeAreUnknown) {
  const TemporaryFolder folder;
  Photo photo = full_photo();
  photo.metadata.position = GeodeticPosition{0.0, 0.0, 100.0};
  write_photo(folder / "gulf.jpg", photo);
  EXPECT_FALSE(read_photo_metadata(folder / "gulf.jpg").position.has_value());
  photo.metadata.position = GeodeticPosition{46.0, 8.0, 0.0};
  write_photo(folder / "flat.jpg", photo);
  const auto position = read_photo_metadata(folder / "flat.jpg").position;
  ASSERT_TRUE(position.has_value());
  EXPECT_FALSE(position->altitude_known);
}

TEST(PhotoFile, PixelsComeBackAndAreReducedByArea) {
  const TemporaryFolder folder;
  const Photo photo = smooth_photo(200, 120, 3);
  write_photo(folder / "a.jpg", photo, 98);
  const Photo whole = read_photo(folder / "a.jpg");
  ASSERT_TRUE(whole.image.same_size(photo.image));
  const Photo half = read_photo(folder / "a.jpg", 100);
  ASSERT_EQ(half.image.width(), 100);
  ASSERT_EQ(half.image.height(), 60);
  EXPECT_EQ(half.metadata.width, 200) << "the metadata is that of the file";
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 100; ++column) {
      const double mean =
          (whole.image.at(2 * column, 2 * row, 1) + whole.image.at(2 * column + 1, 2 * row, 1) +
           whole.image.at(2 * column, 2 * row + 1, 1) +
           whole.image.at(2 * column + 1, 2 * row + 1, 1)) /
          4.0;
      ASSERT_NEAR(half.image.at(column, row, 1), mean, 0.51);
      ASSERT_NEAR(whole.image.at(2 * column, 2 * row, 0), photo.image.at(2 * column, 2 * row, 0),
                  4);
    }
  }
  EXPECT_EQ(read_photo(folder / "a.jpg", 4000).image.width(), 200) << "never enlarged";
}

TEST(PhotoFile, TheOrientationTagIsToldAndNotApplied) {
  const TemporaryFolder folder;
  Photo photo = full_photo();
  photo.metadata.orientation = 6;
  write_photo(folder / "turned.jpg", photo);
  ASSERT_EQ(cv::imread(folder / "turned.jpg").cols, 48) << "the file must ask for a turn";
  const Photo read = read_photo(folder / "turned.jpg");
  EXPECT_EQ(read.metadata.orientation, 6);
  EXPECT_EQ(read.image.width(), 64);
}

TEST(PhotoFile, TheSizeThatExifClaimsIsKeptApart) {
  const TemporaryFolder folder;
  Photo photo = full_photo();
  photo.metadata.exif_width = 4000;
  photo.metadata.exif_height = 3000;
  write_photo(folder / "resized.jpg", photo);
  const PhotoMetadata m = read_photo_metadata(folder / "resized.jpg");
  EXPECT_EQ(m.width, 64);
  EXPECT_EQ(m.exif_width, 4000);
  EXPECT_EQ(m.exif_height, 3000);
}

/// A JPEG with the EXIF and XMP of somebody else, byte for byte.
void write_foreign(const std::filesystem::path& path, const std::string& exif,
                   const std::string& xmp) {
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", cv::Mat(8, 8, CV_8UC3, cv::Scalar(80, 90, 100)), jpeg);
  std::string bytes(jpeg.begin(), jpeg.end());
  const auto segment = [](const std::string& content) {
    const std::size_t size = content.size() + 2;
    return std::string("\xff\xe1") + static_cast<char>(size / 256) + static_cast<char>(size % 256) +
           content;
  };
  if (!xmp.empty()) {
    bytes.insert(2, segment(std::string("http://ns.adobe.com/xap/1.0/\0", 29) + xmp));
  }
  if (!exif.empty()) bytes.insert(2, segment(std::string("Exif\0\0", 6) + exif));
  test::write_text(path, bytes);
}

TEST(PhotoFile, ReadsXmpElementsAndAttributes) {
  const TemporaryFolder folder;
  const std::string begin =
      "<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF "
      "xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'><rdf:Description rdf:about='' "
      "xmlns:drone-dji='http://www.dji.com/drone-dji/1.0/'";
  const std::string end = "</rdf:RDF></x:xmpmeta>";
  write_foreign(folder / "elements.jpg", "",
                begin +
                    "><drone-dji:RelativeAltitude>+39.80</drone-dji:RelativeAltitude>"
                    "<drone-dji:GimbalYawDegree>+45.00</drone-dji:GimbalYawDegree>"
                    "<drone-dji:GimbalPitchDegree>-89.90</drone-dji:GimbalPitchDegree>"
                    "<drone-dji:GimbalRollDegree>0</drone-dji:GimbalRollDegree>"
                    "<drone-dji:GpsLatitude>46.5</drone-dji:GpsLatitude>"
                    "<drone-dji:GpsLongtitude>-8.25</drone-dji:GpsLongtitude>"
                    "<drone-dji:AbsoluteAltitude>+510.5</drone-dji:AbsoluteAltitude>"
                    "</rdf:Description>" +
                    end);
  write_foreign(folder / "attributes.jpg", "",
                begin +
                    " drone-dji:RelativeAltitude='+39.80' drone-dji:GimbalYawDegree='+45.00' "
                    "drone-dji:GimbalPitchDegree='-89.90' drone-dji:GimbalRollDegree='0'/>" +
                    end);
  for (const char* name : {"elements.jpg", "attributes.jpg"}) {
    const PhotoMetadata m = read_photo_metadata(folder / name);
    expect_near(m.relative_altitude_m, 39.8, 1e-12);
    ASSERT_TRUE(m.gimbal.has_value()) << name;
    EXPECT_DOUBLE_EQ(m.gimbal->yaw_deg, 45.0);
    EXPECT_DOUBLE_EQ(m.gimbal->pitch_deg, -89.9);
  }
  const auto position = read_photo_metadata(folder / "elements.jpg").position;
  ASSERT_TRUE(position.has_value()) << "XMP has a position where EXIF has none";
  EXPECT_DOUBLE_EQ(position->longitude_deg, -8.25);
  EXPECT_DOUBLE_EQ(position->altitude_m, 510.5);
}

/// Big-endian EXIF with the position in decimal minutes, as phones write it: six digits of them
/// would be 0.2 m.
TEST(PhotoFile, DecimalMinutesKeepTheirDigits) {
  const TemporaryFolder folder;
  const auto be = [](std::uint32_t value, int size) {
    std::string bytes;
    for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<char>(value >> (8 * i)));
    return bytes;
  };
  const auto rational = [&](std::uint32_t n, std::uint32_t d) { return be(n, 4) + be(d, 4); };
  // IFD0 at 8 with one entry, GPS directory at 26 with four, values from 80 on.
  const std::string exif =
      std::string("MM\0\x2a", 4) + be(8, 4) + be(1, 2) + be(0x8825, 2) + be(4, 2) + be(1, 4) +
      be(26, 4) + be(0, 4) + be(4, 2) + be(1, 2) + be(2, 2) + be(2, 4) + std::string("S\0\0\0", 4) +
      be(2, 2) + be(5, 2) + be(3, 4) + be(80, 4) + be(3, 2) + be(2, 2) + be(2, 4) +
      std::string("E\0\0\0", 4) + be(4, 2) + be(5, 2) + be(3, 4) + be(104, 4) + be(0, 4) +
      rational(33, 1) + rational(551316789, 10000000) + rational(0, 1) + rational(18, 1) +
      rational(254321987, 10000000) + rational(0, 1);
  write_foreign(folder / "phone.jpg", exif, "");
  const auto position = read_photo_metadata(folder / "phone.jpg").position;
  ASSERT_TRUE(position.has_value());
  EXPECT_NEAR(position->latitude_deg, -(33.0 + 55.1316789 / 60.0), 1e-12);
  EXPECT_NEAR(position->longitude_deg, 18.0 + 25.4321987 / 60.0, 1e-12);
  EXPECT_FALSE(position->altitude_known);
  // Damage anywhere in the directories is no crash and no wild position.
  for (std::size_t i = 0; i < exif.size(); ++i) {
    std::string damaged = exif;
    damaged[i] = '\xff';
    write_foreign(folder / "damaged.jpg", damaged, "");
    const auto guess = read_photo_metadata(folder / "damaged.jpg").position;
    if (guess) {
      EXPECT_LE(std::abs(guess->latitude_deg), 90.0);
      EXPECT_LE(std::abs(guess->longitude_deg), 180.0);
    }
  }
}

TEST(PhotoFile, RefusesWhatIsNoPhoto) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kInput, {"none.jpg", "no such file"},
               [&] { read_photo_metadata(folder / "none.jpg"); });
  test::write_text(folder / "empty.jpg", "");
  expect_error(ErrorKind::kInput, {"empty.jpg", "is empty"},
               [&] { read_photo_metadata(folder / "empty.jpg"); });
  test::write_text(folder / "text.jpg", "hello");
  expect_error(ErrorKind::kInput, {"text.jpg", "not an image"},
               [&] { read_photo_metadata(folder / "text.jpg"); });
  test::write_text(folder / "pointer.jpg",
                   "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12\n");
  expect_error(ErrorKind::kInput, {"pointer.jpg", "git lfs pull"},
               [&] { read_photo_metadata(folder / "pointer.jpg"); });
  write_photo(folder / "whole.jpg", full_photo());
  const std::string bytes = test::read_text(folder / "whole.jpg");
  test::write_text(folder / "cut.jpg", bytes.substr(0, bytes.size() - 40));
  EXPECT_EQ(read_photo_metadata(folder / "cut.jpg").model, "FC300S");
  expect_error(ErrorKind::kInput, {"cut.jpg", "cut off"}, [&] { read_photo(folder / "cut.jpg"); });
  expect_error(ErrorKind::kUsage, {"write .jpg"},
               [&] { write_photo(folder / "a.png", full_photo()); });
  expect_error(ErrorKind::kProcessing, {"cannot be a JPEG"},
               [&] { write_photo(folder / "a.jpg", Photo{}); });
}

TEST(PhotoFile, ListsPhotosAndNothingElse) {
  const TemporaryFolder folder;
  for (const char* name : {"b.JPG", "a.jpeg", "map.tif", "notes.txt", ".hidden.jpg"}) {
    test::write_text(folder / name, "x");
  }
  const auto files = photo_files(folder.path());
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].filename(), "a.jpeg");
  EXPECT_EQ(files[1].filename(), "b.JPG");
  const TemporaryFolder nested;
  test::write_text(nested / "100MEDIA/c.png", "x");
  test::write_text(nested / ".map.tif.unfinished-0123456789abcdef/map.jpg", "x");
  const auto below = photo_files(nested.path());
  ASSERT_EQ(below.size(), 1U);
  EXPECT_EQ(below[0].filename(), "c.png");
  const TemporaryFolder empty;
  expect_error(ErrorKind::kInput, {"holds no photos"}, [&] { photo_files(empty.path()); });
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> buffer{};
  while (pipe && fgets(buffer.data(), static_cast<int>(buffer.size()), pipe.get()) != nullptr) {
    text += buffer.data();
  }
  return text;
}

/// An independent reader agrees with what was written.
TEST(PhotoFile, ExiftoolReadsWhatIsWritten) {
  if (output_of("exiftool -ver 2>/dev/null").empty()) GTEST_SKIP() << "exiftool is not installed";
  const TemporaryFolder folder;
  write_photo(folder / "a.jpg", full_photo());
  const std::string file = (folder / "a.jpg").string();
  EXPECT_NE(output_of("exiftool -validate -warning -a " + file).find(": OK"), std::string::npos)
      << output_of("exiftool -validate -warning -a " + file);
  const auto all = nlohmann::json::parse(output_of("exiftool -j -n -G1 " + file))[0];
  EXPECT_EQ(all["IFD0:Model"], "FC300S");
  EXPECT_EQ(all["ExifIFD:SerialNumber"], "SN 0042");
  EXPECT_EQ(all["ExifIFD:DateTimeOriginal"], "2016:06:23 16:31:59");
  EXPECT_EQ(all["ExifIFD:SubSecTimeOriginal"], 25);
  EXPECT_NEAR(all["ExifIFD:ExposureTime"].get<double>(), 1.0 / 370.0, 1e-8);
  EXPECT_NEAR(all["ExifIFD:FocalLength"].get<double>(), 3.61, 1e-6);
  EXPECT_EQ(all["ExifIFD:FocalLengthIn35mmFormat"], 20);
  EXPECT_EQ(all["ExifIFD:ISO"], 100);
  EXPECT_NEAR(all["GPS:GPSLatitude"].get<double>(), 46.84260708, 1e-9);
  EXPECT_EQ(all["GPS:GPSLongitudeRef"], "W");
  EXPECT_NEAR(all["GPS:GPSAltitude"].get<double>(), 198.309, 1e-6);
  EXPECT_EQ(all["XMP-drone-dji:RelativeAltitude"], "+39.800");
  EXPECT_EQ(all["XMP-drone-dji:GimbalYawDegree"], -135.25);
  EXPECT_EQ(all["XMP-drone-dji:GimbalPitchDegree"], -89.9);
}

TEST(PhotoFile, ReadsTheRealFlight) {
  const auto folder = test::find_data("brighton_beach/images");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const auto files = photo_files(*folder);
  ASSERT_EQ(files.size(), 18U);
  const PhotoMetadata first = read_photo_metadata(files.front());
  EXPECT_EQ(first.name, "DJI_0018.JPG");
  EXPECT_EQ(first.width, 1600);
  EXPECT_EQ(first.exif_width, 4000);
  EXPECT_EQ(first.model, "FC300S");
  ASSERT_TRUE(first.position.has_value());
  EXPECT_NEAR(first.position->latitude_deg, 46.0 + 50.0 / 60.0 + 33.3855 / 3600.0, 2e-8);
  EXPECT_NEAR(first.position->longitude_deg, -(91.0 + 59.0 / 60.0 + 40.4156 / 3600.0), 2e-8);
  EXPECT_NEAR(first.position->altitude_m, 198.309, 1e-3);
  expect_near(first.relative_altitude_m, 39.8, 1e-9);
  EXPECT_NEAR(first.gimbal.value().pitch_deg, -89.9, 1e-9);
  for (const auto& file : files) EXPECT_TRUE(read_photo_metadata(file).position) << file;
}

}  // namespace
}  // namespace nadir
