// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <utility>

#include "nadir/io/drives/detail/cloud_columns.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

struct PlyHeader {
  std::string format;
  std::vector<CloudField> fields;  ///< of the vertices
  std::size_t points = 0;
  std::size_t end = 0;  ///< first byte after it
};

struct PlyType {
  std::string_view name;
  char kind;
  std::size_t size;
};
constexpr std::array<PlyType, 16> kPlyTypes{{{"char", 'I', 1},
                                             {"int8", 'I', 1},
                                             {"uchar", 'U', 1},
                                             {"uint8", 'U', 1},
                                             {"short", 'I', 2},
                                             {"int16", 'I', 2},
                                             {"ushort", 'U', 2},
                                             {"uint16", 'U', 2},
                                             {"int", 'I', 4},
                                             {"int32", 'I', 4},
                                             {"uint", 'U', 4},
                                             {"uint32", 'U', 4},
                                             {"float", 'F', 4},
                                             {"float32", 'F', 4},
                                             {"double", 'F', 8},
                                             {"float64", 'F', 8}}};

CloudField field_of(const std::filesystem::path& path, const std::vector<std::string_view>& words) {
  if (words.size() == 3) {
    for (const PlyType& type : kPlyTypes) {
      if (type.name == words[1]) return {std::string(words[2]), type.kind, type.size, 1};
    }
  }
  throw input_error(path, "a property of its vertices is a list or of an unknown type",
                    "give plain numbers a vertex");
}

class PlyHeaderReader {
 public:
  explicit PlyHeaderReader(const std::filesystem::path& path) : path_(path) {}

  void take(const std::vector<std::string_view>& words) {
    if (words[0] == "format" && words.size() > 1) header_.format = words[1];
    if (words[0] == "element" && words.size() == 3) {
      in_vertices_ = words[1] == "vertex";
      if (!in_vertices_ && header_.points == 0) {
        throw input_error(path_, "its vertices are not its first element",
                          "write the vertices first");
      }
      if (in_vertices_) take_count(words[2]);
    }
    if (words[0] == "property" && in_vertices_) header_.fields.push_back(field_of(path_, words));
  }

  PlyHeader& header() { return header_; }

 private:
  void take_count(std::string_view text) {
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), header_.points);
    if (error != std::errc{} || end != text.data() + text.size() || header_.points == 0) {
      throw input_error(path_, fmt::format("has '{}' vertices", text), "give a cloud of points");
    }
  }

  const std::filesystem::path& path_;
  PlyHeader header_;
  bool in_vertices_ = false;
};

PlyHeader read_ply_header(const std::filesystem::path& path, std::string_view bytes) {
  PlyHeaderReader reader(path);
  std::size_t begin = 0;
  bool ended = false;
  while (!ended && begin < bytes.size()) {
    const std::size_t end = bytes.find('\n', begin);
    if (end == std::string_view::npos) break;
    for_each_line(path, bytes.substr(begin, end - begin),
                  [&](const std::string&, const auto& words) {
                    ended = words[0] == "end_header";
                    reader.take(words);
                  });
    begin = end + 1;
  }
  if (!bytes.starts_with("ply") || !ended || reader.header().fields.empty()) {
    throw input_error(path, "has no complete PLY header with vertices", "copy it again");
  }
  check_fields(path, reader.header().fields);
  reader.header().end = begin;
  return std::move(reader.header());
}

}  // namespace

std::vector<LidarPoint> read_ply(const std::filesystem::path& path, std::string_view bytes) {
  const PlyHeader header = read_ply_header(path, bytes);
  const std::string_view body = bytes.substr(header.end);
  if (header.format == "ascii") return points_of_text(path, body, header.fields, header.points);
  const bool big = header.format == "binary_big_endian";
  if (!big && header.format != "binary_little_endian") {
    throw input_error(path, "its format is '" + header.format + "'",
                      "give ascii, binary_little_endian or binary_big_endian");
  }
  if (!holds_points(body.size(), point_size(header.fields), header.points)) {
    throw input_error(path, fmt::format("ends before the {} points of its header", header.points),
                      "copy it again");
  }
  return points_of_columns(path, body, interleaved(header.fields), header.points,
                           big ? ByteOrder::kBig : ByteOrder::kLittle);
}

}  // namespace nadir
