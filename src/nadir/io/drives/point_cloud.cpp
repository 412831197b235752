// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/point_cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/drives/detail/cloud_columns.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

static_assert(std::endian::native == std::endian::little, "clouds are written as they lie");

const std::vector<CloudField> kVelodyneFields{
    {"x", 'F', 4, 1}, {"y", 'F', 4, 1}, {"z", 'F', 4, 1}, {"intensity", 'F', 4, 1}};

std::string packed(const std::vector<LidarPoint>& points) {
  std::string bytes(points.size() * 4 * sizeof(float), '\0');
  char* out = bytes.data();
  for (const LidarPoint& point : points) {
    for (const float value : {point.x, point.y, point.z, point.intensity}) {
      std::memcpy(out, &value, sizeof(value));
      out += sizeof(value);
    }
  }
  return bytes;
}

}  // namespace

PointCloud read_point_cloud(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const std::string extension = path.extension().string();
  PointCloud cloud;
  if (extension == ".bin") {
    const std::size_t size = point_size(kVelodyneFields);
    cloud.leftover_bytes = bytes.size() % size;
    cloud.points = points_of_columns(path, bytes, interleaved(kVelodyneFields), bytes.size() / size,
                                     ByteOrder::kLittle);
  } else if (extension == ".pcd") {
    cloud.points = read_pcd(path, bytes);
  } else if (extension == ".ply") {
    cloud.points = read_ply(path, bytes);
  } else {
    throw input_error(path, "'" + extension + "' is no format of a point cloud",
                      "give .bin (float32 x y z intensity), .pcd or .ply");
  }
  drop_invalid(path, cloud);
  return cloud;
}

void write_velodyne(const std::filesystem::path& path, const std::vector<LidarPoint>& points) {
  write_file(path, packed(points));
}

void write_ply(const std::filesystem::path& path, const std::vector<LidarPoint>& points) {
  std::string text =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points.size());
  for (const CloudField& field : kVelodyneFields) text += "property float " + field.name + "\n";
  write_file(path, text + "end_header\n" + packed(points));
}

}  // namespace nadir
