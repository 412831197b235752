// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/detail/cloud_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

template <class T>
double as(std::array<char, 8> bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof(T));
  return static_cast<double>(value);
}

double number_at(std::string_view bytes, std::size_t position, const CloudField& field,
                 ByteOrder order) {
  std::array<char, 8> raw{};
  std::memcpy(raw.data(), bytes.data() + position, field.size);
  const bool native = (order == ByteOrder::kLittle) == (std::endian::native == std::endian::little);
  if (!native) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(field.size));
  if (field.kind == 'F') return field.size == 8 ? as<double>(raw) : as<float>(raw);
  if (field.kind == 'I') {
    switch (field.size) {
      case 1:
        return as<std::int8_t>(raw);
      case 2:
        return as<std::int16_t>(raw);
      case 4:
        return as<std::int32_t>(raw);
      default:
        return as<std::int64_t>(raw);
    }
  }
  switch (field.size) {
    case 1:
      return as<std::uint8_t>(raw);
    case 2:
      return as<std::uint16_t>(raw);
    case 4:
      return as<std::uint32_t>(raw);
    default:
      return as<std::uint64_t>(raw);
  }
}

/// The member of a point that a field fills, by the names that are in use.
float LidarPoint::*member_of(const std::string& name) {
  if (name == "x") return &LidarPoint::x;
  if (name == "y") return &LidarPoint::y;
  if (name == "z") return &LidarPoint::z;
  if (name == "intensity" || name == "scalar_intensity" || name == "reflectance") {
    return &LidarPoint::intensity;
  }
  return name == "time" ? &LidarPoint::time_offset_s : nullptr;
}

void require_xyz(const std::filesystem::path& path, const std::vector<CloudField>& fields) {
  for (const char* name : {"x", "y", "z"}) {
    const auto found = std::ranges::find(fields, name, &CloudField::name);
    if (found == fields.end()) {
      throw input_error(path, fmt::format("its points have no field '{}'", name),
                        "give a cloud of x, y, z");
    }
  }
}

/// A beam without an echo is written as the origin by most drivers.
bool is_valid(const LidarPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z) &&
         (point.x != 0.0F || point.y != 0.0F || point.z != 0.0F);
}

/// PCL writes what it does not know as "nan".
double text_number(std::string_view text, const std::string& where) {
  if (text == "nan" || text == "-nan" || text == "NaN") {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return number_in_file(text, "a field", where);
}

}  // namespace

void check_fields(const std::filesystem::path& path, const std::vector<CloudField>& fields) {
  const auto is_sound = [](const CloudField& field) {
    const bool floating = field.size == 4 || field.size == 8;
    const bool whole = floating || field.size == 1 || field.size == 2;
    return (field.kind == 'F' ? floating : whole && (field.kind == 'I' || field.kind == 'U')) &&
           field.count >= 1 && field.count <= kMostValuesOfPoint;
  };
  const bool sound = fields.size() <= kMostFields && std::ranges::all_of(fields, is_sound);
  std::size_t values = 0;
  if (sound) {
    for (const CloudField& field : fields) values += field.count;
  }
  if (sound && values <= kMostValuesOfPoint) return;
  throw input_error(path,
                    fmt::format("its header declares more than {} fields or {} values a point, or "
                                "values of a type and size that do not exist",
                                kMostFields, kMostValuesOfPoint),
                    "the header is damaged: copy the file again");
}

std::size_t point_size(const std::vector<CloudField>& fields) {
  std::size_t size = 0;
  for (const CloudField& field : fields) size += field.size * field.count;
  return size;
}

std::vector<CloudColumn> interleaved(const std::vector<CloudField>& fields) {
  std::vector<CloudColumn> columns;
  std::size_t begin = 0;
  const std::size_t stride = point_size(fields);
  for (const CloudField& field : fields) {
    columns.push_back({field, begin, stride});
    begin += field.size * field.count;
  }
  return columns;
}

std::vector<LidarPoint> points_of_columns(const std::filesystem::path& path, std::string_view bytes,
                                          const std::vector<CloudColumn>& columns,
                                          std::size_t count, ByteOrder order) {
  std::vector<CloudField> fields;
  for (const CloudColumn& column : columns) fields.push_back(column.field);
  require_xyz(path, fields);
  std::vector<LidarPoint> points(count);
  for (const CloudColumn& column : columns) {
    const auto member = member_of(column.field.name);
    if (member == nullptr) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t position = column.begin + i * column.stride;
      points[i].*member = static_cast<float>(number_at(bytes, position, column.field, order));
    }
  }
  return points;
}

std::vector<LidarPoint> points_of_text(const std::filesystem::path& path, std::string_view text,
                                       const std::vector<CloudField>& fields, std::size_t count) {
  require_xyz(path, fields);
  std::size_t columns = 0;
  for (const CloudField& field : fields) columns += field.count;
  std::vector<LidarPoint> points;
  for_each_line(path, text, [&](const std::string& where, const auto& words) {
    if (points.size() == count) return;
    if (words.size() < columns) {
      throw Error(ErrorKind::kInput, fmt::format("{} values instead of {}", words.size(), columns),
                  where, "copy the file again");
    }
    LidarPoint point;
    std::size_t column = 0;
    for (const CloudField& field : fields) {
      const auto member = member_of(field.name);
      if (member != nullptr) point.*member = static_cast<float>(text_number(words[column], where));
      column += field.count;
    }
    points.push_back(point);
  });
  if (points.size() < count) {
    throw input_error(path,
                      fmt::format("holds {} points, its header says {}", points.size(), count),
                      "the file is cut off: copy it again");
  }
  return points;
}

void drop_invalid(const std::filesystem::path& path, PointCloud& cloud) {
  const std::size_t all = cloud.points.size();
  std::erase_if(cloud.points, [](const LidarPoint& point) { return !is_valid(point); });
  cloud.invalid = all - cloud.points.size();
  if (cloud.points.empty()) {
    throw input_error(path, fmt::format("none of its {} points is valid", all),
                      "all are NaN, infinite or zero: check the recording");
  }
}

}  // namespace nadir
