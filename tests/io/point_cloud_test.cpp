// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/point_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using test::TemporaryFolder;
using test::write_text;

const std::vector<LidarPoint> kPoints{
    {1.5F, -2.25F, 3.0F, 0.5F, 0}, {1e3F, 0.0F, -1.0F, 0.0F, 0}, {0.0F, 0.0F, 0.125F, 1.0F, 0}};

template <class T>
void append(std::string& bytes, T value, bool swapped = false) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes += swapped ? std::string(raw.rbegin(), raw.rend()) : raw;
}

void expect_points(const PointCloud& cloud) {
  ASSERT_EQ(cloud.points.size(), kPoints.size());
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    EXPECT_EQ(cloud.points[i].x, kPoints[i].x);
    EXPECT_EQ(cloud.points[i].y, kPoints[i].y);
    EXPECT_EQ(cloud.points[i].z, kPoints[i].z);
    EXPECT_EQ(cloud.points[i].intensity, kPoints[i].intensity);
  }
}

TEST(PointCloud, RoundTripsVelodyneAndPly) {
  const TemporaryFolder folder;
  write_velodyne(folder / "a.bin", kPoints);
  EXPECT_EQ(fs::file_size(folder / "a.bin"), 48U);
  expect_points(read_point_cloud(folder / "a.bin"));
  write_ply(folder / "a.ply", kPoints);
  expect_points(read_point_cloud(folder / "a.ply"));
}

TEST(PointCloud, CountsWhatIsNoPoint) {
  const TemporaryFolder folder;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  write_velodyne(folder / "a.bin",
                 {{1, 2, 3, 0, 0}, {kNan, 0, 0, 0, 0}, {1, kInfinity, 0, 0, 0}, {0, 0, 0, 7, 0}});
  const std::string whole = test::read_text(folder / "a.bin");
  write_text(folder / "a.bin", whole + "12345");
  const PointCloud cloud = read_point_cloud(folder / "a.bin");
  EXPECT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.invalid, 3U);
  EXPECT_EQ(cloud.leftover_bytes, 5U);
}

TEST(PointCloud, RefusesWhatHasNoPoint) {
  const TemporaryFolder folder;
  write_velodyne(folder / "a.bin", {{0, 0, 0, 1, 0}});
  expect_error(ErrorKind::kInput, {"a.bin", "none of its 1 points"},
               [&] { read_point_cloud(folder / "a.bin"); });
  write_text(folder / "b.bin", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  expect_error(ErrorKind::kInput, {"b.bin", "git lfs pull"},
               [&] { read_point_cloud(folder / "b.bin"); });
  write_text(folder / "c.xyz", "1 2 3\n");
  expect_error(ErrorKind::kInput, {"c.xyz", ".pcd or .ply"},
               [&] { read_point_cloud(folder / "c.xyz"); });
}

TEST(PointCloud, ReadsAsciiAndForeignFields) {
  const TemporaryFolder folder;
  write_text(folder / "a.pcd",
             "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb normal intensity\nSIZE 4 4 4 4 4 4\n"
             "TYPE F F F U F F\nCOUNT 1 1 1 1 2 1\nWIDTH 4\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
             "POINTS 4\nDATA ascii\n1.5 -2.25 3 77 8 9 0.5\n1000 0 -1 0 0 0 0\n"
             "nan nan nan 0 0 0 0\n0 0 0.125 0 0 0 1\n");
  const PointCloud cloud = read_point_cloud(folder / "a.pcd");
  expect_points(cloud);
  EXPECT_EQ(cloud.invalid, 1U);
  write_text(folder / "a.ply",
             "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty double x\n"
             "property float y\nproperty float z\nproperty uchar red\nproperty float "
             "scalar_intensity\nelement face 0\nproperty list uchar int vertex_indices\n"
             "end_header\n1.5 -2.25 3 255 0.5\n1000 0 -1 0 0\n0 0 0.125 0 1\n");
  expect_points(read_point_cloud(folder / "a.ply"));
}

/// A point whose declared size is more than the file, or more than a number can say.
TEST(PointCloud, RefusesAPcdWhoseCountsLie) {
  const TemporaryFolder folder;
  const auto pcd = [&](const std::string& counts, const std::string& points,
                       const std::string& data) {
    write_text(folder / "a.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT " + counts +
                                     "\nPOINTS " + points + "\nDATA " + data);
    return folder / "a.pcd";
  };
  const std::string body(64, 'x');
  // The sizes of these add up to 0, and to 8, where they overflow.
  for (const char* counts : {"1152921504606846976 1152921504606846976 2305843009213693952",
                             "1 1099511627776 4611684918915760129", "65536 1 1", "1 0 1"}) {
    for (const std::string data : {"binary\n", "binary_compressed\n", "ascii\n"}) {
      expect_error(ErrorKind::kInput, {"a.pcd", "declares more than"},
                   [&] { read_point_cloud(pcd(counts, "3", data + body)); });
    }
  }
  // 12 bytes a point: the product of size and number is 0.
  expect_error(ErrorKind::kInput, {"a.pcd", "ends before the 4611686018427387904 points"}, [&] {
    read_point_cloud(pcd("1 1 1", "4611686018427387904", "binary_compressed\n" + body));
  });
  std::string unpacked = "binary_compressed\n";
  append(unpacked, std::uint32_t{25});
  append(unpacked, std::uint32_t{0xfffffff0});
  expect_error(ErrorKind::kInput, {"a.pcd", "4294967280 bytes out of 25 compressed ones"},
               [&] { read_point_cloud(pcd("1 1 1", "2", unpacked + body)); });
  expect_error(ErrorKind::kInput, {"a.pcd", "type and size that do not exist"}, [&] {
    write_text(folder / "a.pcd",
               "FIELDS x y z\nSIZE 2 4 4\nTYPE F F F\nPOINTS 1\nDATA binary\n" + body);
    read_point_cloud(folder / "a.pcd");
  });
}

TEST(PointCloud, ReadsBinaryOfEitherOrderAndType) {
  const TemporaryFolder folder;
  std::string pcd =
      "VERSION 0.7\nFIELDS ring x y z intensity\nSIZE 2 8 4 4 4\nTYPE U F F F F\nCOUNT 1 1 1 1 1\n"
      "WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA binary\n";
  std::string ply =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
      "property float z\nproperty ushort ring\nproperty float intensity\nend_header\n";
  for (const LidarPoint& p : kPoints) {
    append(pcd, std::uint16_t{9});
    append(pcd, static_cast<double>(p.x));
    append(ply, static_cast<double>(p.x), true);
    for (const float value : {p.y, p.z}) {
      append(pcd, value);
      append(ply, value, true);
    }
    append(ply, std::uint16_t{9}, true);
    append(pcd, p.intensity);
    append(ply, p.intensity, true);
  }
  write_text(folder / "a.pcd", pcd);
  expect_points(read_point_cloud(folder / "a.pcd"));
  write_text(folder / "a.ply", ply);
  expect_points(read_point_cloud(folder / "a.ply"));
  write_text(folder / "cut.pcd", pcd.substr(0, pcd.size() - 3));
  expect_error(ErrorKind::kInput, {"cut.pcd", "ends before the 3 points"},
               [&] { read_point_cloud(folder / "cut.pcd"); });
}

/// liblzf's form, with literal runs, a short and a long reference back.
TEST(PointCloud, ReadsCompressedPcd) {
  const TemporaryFolder folder;
  const std::string header =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 20\nHEIGHT 1\n"
      "POINTS 20\nDATA binary_compressed\n";
  // x: 20 times 1.5; y: 20 times -2; z: 20 times 0.25. Each run of 80 bytes: four as they are, then
  // 76 copied from four bytes back (length 76 = 2 + 7 + 67).
  std::string packed;
  for (const float value : {1.5F, -2.0F, 0.25F}) {
    packed += '\x03';
    append(packed, value);
    packed += static_cast<char>(7U << 5U);
    packed += static_cast<char>(67);
    packed += '\x03';
  }
  std::string body;
  append(body, static_cast<std::uint32_t>(packed.size()));
  append(body, std::uint32_t{240});
  write_text(folder / "a.pcd", header + body + packed);
  const PointCloud cloud = read_point_cloud(folder / "a.pcd");
  ASSERT_EQ(cloud.points.size(), 20U);
  for (const LidarPoint& point : cloud.points) {
    EXPECT_EQ(point.x, 1.5F);
    EXPECT_EQ(point.y, -2.0F);
    EXPECT_EQ(point.z, 0.25F);
  }
  packed[5] = static_cast<char>(1U << 5U);  // the first reference is too short now
  write_text(folder / "b.pcd", header + body + packed);
  expect_error(ErrorKind::kInput, {"b.pcd", "damaged"},
               [&] { read_point_cloud(folder / "b.pcd"); });
}

}  // namespace
}  // namespace nadir
