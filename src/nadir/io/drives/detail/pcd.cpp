// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstring>

#include "nadir/io/drives/detail/cloud_columns.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

struct PcdHeader {
  std::vector<CloudField> fields;
  std::size_t points = 0;
  std::string data;
  std::size_t end = 0;  ///< first byte after it
};

std::size_t whole_number(const std::filesystem::path& path, std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw input_error(path, fmt::format("'{}' in its header is no whole number", text),
                      "copy the file again");
  }
  return value;
}

void take_line(const std::filesystem::path& path, const std::vector<std::string_view>& words,
               PcdHeader& header) {
  const std::string_view key = words[0];
  if (key == "FIELDS") {
    for (std::size_t i = 1; i < words.size(); ++i) {
      header.fields.push_back({std::string(words[i]), 'F', 4, 1});
    }
  }
  for (std::size_t i = 0; i < header.fields.size() && i + 1 < words.size(); ++i) {
    CloudField& field = header.fields[i];
    if (key == "SIZE") field.size = whole_number(path, words[i + 1]);
    if (key == "TYPE") field.kind = words[i + 1].front();
    if (key == "COUNT") field.count = whole_number(path, words[i + 1]);
  }
  if (key == "POINTS" && words.size() > 1) header.points = whole_number(path, words[1]);
  if (key == "DATA" && words.size() > 1) header.data = words[1];
}

PcdHeader read_pcd_header(const std::filesystem::path& path, std::string_view bytes) {
  PcdHeader header;
  while (header.data.empty() && header.end < bytes.size()) {
    const std::size_t line_end = bytes.find('\n', header.end);
    if (line_end == std::string_view::npos) break;
    for_each_line(path, bytes.substr(header.end, line_end - header.end),
                  [&](const std::string&, const auto& words) { take_line(path, words, header); });
    header.end = line_end + 1;
  }
  if (header.data.empty() || header.points == 0 || header.fields.empty()) {
    throw input_error(path, "has no complete PCD header (FIELDS, SIZE, TYPE, POINTS, DATA)",
                      "give a PCD file of version 0.7");
  }
  check_fields(path, header.fields);
  return header;
}

/// LZF as in liblzf: a control byte below 32 is followed by that many + 1 bytes as they are;
/// otherwise it starts a reference back into what was written. Empty where the data is damaged.
std::string unpack_lzf(std::string_view packed, std::size_t size) {
  std::string out;
  out.reserve(size);
  std::size_t in = 0;
  const auto next = [&] { return static_cast<std::uint8_t>(packed[in++]); };
  while (in < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {
      const std::size_t run = control + 1;
      if (in + run > packed.size() || out.size() + run > size) return {};
      out.append(packed.substr(in, run));
      in += run;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7) {
      if (in >= packed.size()) return {};
      length += next();
    }
    length += 2;
    if (in >= packed.size()) return {};
    const std::size_t back = ((control & 31U) << 8U) + next() + 1;
    if (back > out.size() || out.size() + length > size) return {};
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - back]);
  }
  return out.size() == size ? out : std::string{};
}

std::uint32_t little_endian(std::string_view bytes, std::size_t position) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8U | static_cast<std::uint8_t>(bytes[position + i]);
  }
  return value;
}

Error cut_off(const std::filesystem::path& path, std::size_t points) {
  return input_error(path, fmt::format("ends before the {} points of its header", points),
                     "copy it again");
}

/// binary_compressed keeps the values of one field together.
std::vector<LidarPoint> compressed_points(const std::filesystem::path& path, std::string_view body,
                                          const PcdHeader& header) {
  constexpr std::size_t kSizes = 8;
  constexpr std::size_t kMostUnpacked = 88;  // bytes out of one: three give at most 264
  if (body.size() < kSizes) throw cut_off(path, header.points);
  const std::size_t packed = little_endian(body, 0);
  const std::size_t size = little_endian(body, 4);
  if (body.size() - kSizes < packed ||
      !holds_points(size, point_size(header.fields), header.points)) {
    throw cut_off(path, header.points);
  }
  if (size / kMostUnpacked > packed) {
    throw input_error(
        path,
        fmt::format("its header declares {} bytes out of {} compressed ones, which is "
                    "more than LZF can hold",
                    size, packed),
        "copy it again");
  }
  const std::string bytes = unpack_lzf(body.substr(kSizes, packed), size);
  if (bytes.empty()) throw input_error(path, "its compressed data is damaged", "copy it again");
  std::vector<CloudColumn> columns;
  std::size_t begin = 0;
  for (const CloudField& field : header.fields) {
    columns.push_back({field, begin, field.size * field.count});
    begin += field.size * field.count * header.points;
  }
  return points_of_columns(path, bytes, columns, header.points, ByteOrder::kLittle);
}

}  // namespace

std::vector<LidarPoint> read_pcd(const std::filesystem::path& path, std::string_view bytes) {
  const PcdHeader header = read_pcd_header(path, bytes);
  const std::string_view body = bytes.substr(header.end);
  if (header.data == "ascii") return points_of_text(path, body, header.fields, header.points);
  if (header.data == "binary_compressed") return compressed_points(path, body, header);
  if (header.data != "binary") {
    throw input_error(path, "its DATA is '" + header.data + "'",
                      "give ascii, binary or binary_compressed");
  }
  if (!holds_points(body.size(), point_size(header.fields), header.points)) {
    throw cut_off(path, header.points);
  }
  return points_of_columns(path, body, interleaved(header.fields), header.points,
                           ByteOrder::kLittle);
}

}  // namespace nadir
