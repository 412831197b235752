// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/image.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "io/random_raster.hpp"
#include "io/tiff_bytes.hpp"
#include "nadir/io/image_file_check.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::random_raster;
using test::TemporaryFolder;

TEST(Image, PngRoundTripsGreyAndRgb) {
  const TemporaryFolder folder;
  std::uint64_t seed = 0;
  for (const int channels : {1, 3}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 1}, {1, 8}, {33, 20}, {64, 51}}) {
      const auto image = random_raster(width, height, channels, ++seed);
      write_png(folder / "image.png", image);
      EXPECT_EQ(read_image(folder / "image.png"), image) << width << " x " << height;
    }
  }
}

TEST(Image, ReadsRedFirst) {
  const TemporaryFolder folder;
  cv::imwrite(folder / "red.png", cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 250)));  // blue first
  const auto image = read_image(folder / "red.png");
  EXPECT_EQ(image.at(1, 1, 0), 250);
  EXPECT_EQ(image.at(1, 1, 1), 20);
  EXPECT_EQ(image.at(1, 1, 2), 10);
}

TEST(Image, DropsAlpha) {
  const TemporaryFolder folder;
  write_png(folder / "rgba.png", random_raster(5, 4, 4, 1));
  EXPECT_EQ(read_image(folder / "rgba.png").channels(), 3);
}

/// A 4 x 2 JPEG whose EXIF asks for a quarter turn.
void write_turned_jpeg(const std::filesystem::path& path) {
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", cv::Mat(2, 4, CV_8UC1, cv::Scalar(80)), jpeg);
  const std::string exif(
      "\xff\xe1\x00\x22"
      "Exif\0\0"
      "MM\0\x2a\0\0\0\x08"
      "\0\x01"
      "\x01\x12\0\x03\0\0\0\x01\0\x06\0\0"
      "\0\0\0\0",
      36);
  std::string bytes(jpeg.begin(), jpeg.end());
  bytes.insert(2, exif);
  test::write_text(path, bytes);
}

TEST(Image, IgnoresExifOrientation) {
  const TemporaryFolder folder;
  write_turned_jpeg(folder / "turned.jpg");
  ASSERT_EQ(cv::imread(folder / "turned.jpg").cols, 2) << "the file must ask for a turn";
  EXPECT_EQ(read_image(folder / "turned.jpg").width(), 4);
}

TEST(Image, RefusesWhatIsNoImage) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kInput, {"none.png", "no such file"},
               [&] { read_image(folder / "none.png"); });
  expect_error(ErrorKind::kInput, {"is a folder"}, [&] { read_image(folder.path()); });
  test::write_text(folder / "empty.png", "");
  expect_error(ErrorKind::kInput, {"empty.png", "is empty", "again"},
               [&] { read_image(folder / "empty.png"); });
  test::write_text(folder / "text.png", "hello");
  expect_error(ErrorKind::kInput, {"text.png", "not an image"},
               [&] { read_image(folder / "text.png"); });
  test::write_text(folder / "pointer.jpg",
                   "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12\n");
  expect_error(ErrorKind::kInput, {"pointer.jpg", "Git LFS pointer", "git lfs pull"},
               [&] { read_image(folder / "pointer.jpg"); });
}

TEST(Image, RefusesSixteenBits) {
  const TemporaryFolder folder;
  cv::imwrite(folder / "deep.png", cv::Mat(3, 3, CV_16UC1, cv::Scalar(40000)));
  expect_error(ErrorKind::kInput, {"deep.png", "more than 8 bits", "gdal_translate"},
               [&] { read_image(folder / "deep.png"); });
}

/// However much of the file is missing, the error says so; nothing is filled with grey.
TEST(Image, RefusesEveryTruncation) {
  const TemporaryFolder folder;
  const Raster<std::uint8_t> image = random_raster(40, 30, 1, 9);
  write_png(folder / "whole.png", image);
  const cv::Mat view(30, 40, CV_8UC1, const_cast<std::uint8_t*>(image.values().data()));
  cv::imwrite(folder / "whole.jpg", view);
  for (const char* name : {"whole.png", "whole.jpg"}) {
    const std::string bytes = test::read_text(folder / name);
    for (std::size_t size = 12; size < bytes.size(); size += 1 + bytes.size() / 50) {
      test::write_text(folder / "cut", bytes.substr(0, size));
      expect_error(ErrorKind::kInput, {"cut", "cut off"}, [&] { read_image(folder / "cut"); });
    }
    test::write_text(folder / "cut", bytes.substr(0, bytes.size() - 1));
    expect_error(ErrorKind::kInput, {"cut off"}, [&] { read_image(folder / "cut"); });
    test::write_text(folder / "longer", bytes + "trailing bytes of a camera");
    EXPECT_EQ(read_image(folder / "longer").width(), 40);
  }
}

TEST(Image, RefusesADamagedPng) {
  const TemporaryFolder folder;
  write_png(folder / "image.png", random_raster(40, 30, 1, 9));
  std::string bytes = test::read_text(folder / "image.png");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  test::write_text(folder / "image.png", bytes);
  expect_error(ErrorKind::kInput, {"image.png", "decoded", "damaged"},
               [&] { read_image(folder / "image.png"); });
}

/// No room is made for what the bytes cannot hold.
TEST(Image, RefusesASizeThatTheFileCannotHold) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] :
       {std::pair{"a.pgm", std::string("P5\n# a comment\n30000 30000\n255\nabc")},
        std::pair{"b.pgm", std::string("P5\n30000 99999999999\n255\nabc")}}) {
    test::write_text(folder / name, bytes);
    expect_error(ErrorKind::kInput, {name, "its header declares 30000 x"},
                 [&, &name = name] { read_image(folder / name); });
  }
  write_png(folder / "image.png", random_raster(40, 30, 1, 9));
  const std::string png = test::read_text(folder / "image.png");
  test::write_text(folder / "image.png",
                   png.substr(0, 16) + std::string("\0\0\x60\0\0\0\x60\0", 8) + png.substr(24));
  expect_error(ErrorKind::kInput, {"image.png", "24576 x 24576 pixels", "cannot hold"},
               [&] { read_image(folder / "image.png"); });
  cv::imwrite(folder / "image.jpg", cv::Mat(30, 40, CV_8UC1, cv::Scalar(9)));
  std::string jpeg = test::read_text(folder / "image.jpg");
  const std::size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  jpeg.replace(frame + 5, 4, "\x60\x01\x60\x01");
  test::write_text(folder / "image.jpg", jpeg);
  expect_error(ErrorKind::kInput, {"image.jpg", "24577 x 24577 pixels", "cannot hold"},
               [&] { read_image(folder / "image.jpg"); });
}

/// A decoder of OpenCV is chosen by bytes anywhere in the file ("DICM" at 128) where none knows the
/// first ones. So these must be those of a format whose header is checked, all of them.
TEST(Image, OtherSignaturesReachNoDecoder) {
  const std::string tiff =
      test::tiff_bytes({{test::tiff_tags::kWidth, 3, 1, 8}, {test::tiff_tags::kHeight, 3, 1, 8}});
  EXPECT_NO_THROW(check_image_size("a.tif", tiff));
  EXPECT_NO_THROW(check_image_size("a.pgm", "P5 8 8 255 "));
  for (std::string bytes :
       {std::string("II\0\0", 4) + tiff.substr(4), std::string("MM\x2a\0", 4) + tiff.substr(4),
        std::string("P58 8 255 "), std::string("P7\nWIDTH 8\nHEIGHT 8\n"),
        std::string("BM\x40\0\0\0", 6), std::string("RIFF\x40\0\0\0WEBP", 12)}) {
    bytes.resize(200);
    bytes.replace(128, 4, "DICM");
    expect_error(ErrorKind::kInput, {"a.tif", "not an image", "PNG, JPEG, TIFF"},
                 [&] { check_image_size("a.tif", bytes); });
  }
}

/// OpenCV makes room for a block of a TIFF before it reads one.
TEST(Image, ABlockOfATiffIsNoLargerThanTheFileCanHold) {
  namespace tag = test::tiff_tags;
  const std::string bytes = test::tiff_bytes({{tag::kWidth, 3, 1, 8},
                                              {tag::kHeight, 3, 1, 8},
                                              {tag::kBits, 3, 1, 8},
                                              {tag::kTileWidth, 4, 1, 32768},
                                              {tag::kTileHeight, 4, 1, 32768}});
  expect_error(ErrorKind::kInput, {"a.tif", "blocks of 32768 x 32768 pixels"},
               [&] { check_image_size("a.tif", bytes); });
}

TEST(Image, ReadsProgressiveJpeg) {
  const TemporaryFolder folder;
  cv::imwrite(folder / "image.jpg", cv::Mat(50, 60, CV_8UC3, cv::Scalar(1, 2, 3)),
              {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 2});
  EXPECT_EQ(read_image(folder / "image.jpg").height(), 50);
}

TEST(Image, WritesNothingThatIsNoPng) {
  const TemporaryFolder folder;
  for (const Raster<std::uint8_t>& image : {Raster<std::uint8_t>(), random_raster(3, 3, 2, 1)}) {
    expect_error(ErrorKind::kProcessing, {"image.png", "cannot be a PNG"},
                 [&] { write_png(folder / "image.png", image); });
  }
  expect_error(ErrorKind::kProcessing, {"cannot be written"},
               [&] { write_png(folder.path() / "none" / "a.png", random_raster(3, 3, 1, 1)); });
  EXPECT_EQ(test::count_entries(folder.path()), 0);
}

}  // namespace
}  // namespace nadir
