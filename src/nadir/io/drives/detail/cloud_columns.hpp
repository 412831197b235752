// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the readers of point clouds share: values of one field, one a point.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "nadir/io/drives/point_cloud.hpp"

namespace nadir {

/// A field of a point as a header declares it.
struct CloudField {
  std::string name;
  char kind = 'F';       ///< F floating point, I signed, U unsigned
  std::size_t size = 4;  ///< bytes
  std::size_t count = 1;
};

/// Where the values of a field lie: the first one, and the step to the next point's.
struct CloudColumn {
  CloudField field;
  std::size_t begin = 0;
  std::size_t stride = 0;
};

enum class ByteOrder { kLittle, kBig };

/// Points out of binary columns; `bytes` must hold `count` of them. Throws Error (input) where x, y
/// or z is missing.
std::vector<LidarPoint> points_of_columns(const std::filesystem::path& path, std::string_view bytes,
                                          const std::vector<CloudColumn>& columns,
                                          std::size_t count, ByteOrder order);

/// Points out of lines of text that start at `text`, one a point. Throws Error (input) for a line
/// that is too short, a value that is no number, or fewer lines than `count`.
std::vector<LidarPoint> points_of_text(const std::filesystem::path& path, std::string_view text,
                                       const std::vector<CloudField>& fields, std::size_t count);

/// Points one after another, each of all fields in turn.
std::vector<CloudColumn> interleaved(const std::vector<CloudField>& fields);

/// What a header may declare of one point. Real ones have some tens of fields; PCL's longest, a
/// feature histogram, has 640 numbers.
inline constexpr std::size_t kMostFields = 1024;
inline constexpr std::size_t kMostValuesOfPoint = 65'536;

/// Throws Error (input) where the fields are more than that, or one of them has no values or a type
/// and size that do not exist. What passes has a point_size() that cannot overflow.
void check_fields(const std::filesystem::path& path, const std::vector<CloudField>& fields);

/// Bytes of one point.
std::size_t point_size(const std::vector<CloudField>& fields);

/// Whether `bytes` hold `count` points of `size` bytes; the product is never formed.
inline bool holds_points(std::size_t bytes, std::size_t size, std::size_t count) {
  return size > 0 && bytes / size >= count;
}

/// Drops and counts the points that are not finite or lie in the sensor. Throws Error (input) where
/// none is left.
void drop_invalid(const std::filesystem::path& path, PointCloud& cloud);

std::vector<LidarPoint> read_pcd(const std::filesystem::path& path, std::string_view bytes);
std::vector<LidarPoint> read_ply(const std::filesystem::path& path, std::string_view bytes);

}  // namespace nadir
