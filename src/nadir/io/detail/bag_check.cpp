// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/bag_check.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "nadir/io/input_file.hpp"

namespace nadir::ros1 {
namespace {

constexpr std::string_view kVersion = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMostHeaderBytes = 1U << 20U;
constexpr std::uint32_t kMostChunkBytes = 1U << 28U;

/// op of a record (http://wiki.ros.org/Bags/Format/2.0).
enum class Op : char {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

template <class T>
std::optional<T> number_at(std::string_view bytes, std::size_t position) {
  if (bytes.size() < sizeof(T) || position > bytes.size() - sizeof(T)) return std::nullopt;
  T value{};
  std::memcpy(&value, bytes.data() + position, sizeof(T));
  return value;
}

/// The fields `name=value` of a header, each after its length; nothing where they are none.
std::optional<std::map<std::string, std::string>> fields_of(std::string_view header) {
  std::map<std::string, std::string> fields;
  while (!header.empty()) {
    const auto size = number_at<std::uint32_t>(header, 0);
    if (!size || *size > header.size() - 4) return std::nullopt;
    const std::string_view field = header.substr(4, *size);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    fields.emplace(field.substr(0, equals), field.substr(equals + 1));
    header.remove_prefix(4 + field.size());
  }
  return fields;
}

struct BagRecord {
  std::map<std::string, std::string> fields;
  std::uint64_t begin = 0;  ///< of the record, bytes from the start of the file
  std::uint64_t data = 0;   ///< of its data
  std::uint32_t size = 0;   ///< of its data
  std::uint64_t end() const { return data + size; }
};

struct BagChunk {
  std::uint64_t data = 0;
  std::uint32_t size = 0;  ///< unpacked
  bool compressed = false;
};

class BagWalk {
 public:
  explicit BagWalk(const std::filesystem::path& file)
      : path_(file), stream_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {}

  void walk() {
    if (bytes_at(0, kVersion.size()) != kVersion) {
      throw input_error(path_, "is no bag of version 2.0", "run `rosbag fix` on it");
    }
    for (std::uint64_t position = kVersion.size(); position < size_;) {
      const BagRecord record = record_at(position, size_);
      look_at(record);
      position = record.end();
    }
    check_index();
  }

 private:
  [[noreturn]] void fail(std::uint64_t position, const std::string& problem) const {
    throw input_error(path_, "is damaged at byte " + std::to_string(position) + ": " + problem,
                      "copy the bag again, or run `rosbag fix` or `rosbag reindex` on it");
  }

  std::string bytes_at(std::uint64_t position, std::size_t count) {
    std::string bytes(count, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(position));
    stream_.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(stream_.gcount()));
    return bytes;
  }

  std::uint32_t length_at(std::uint64_t position, std::uint64_t end) {
    if (position + 4 > end) fail(position, "a record is cut off");
    return number_at<std::uint32_t>(bytes_at(position, 4), 0).value_or(0);
  }

  /// The record at a place that lies before `end`, all of it.
  BagRecord record_at(std::uint64_t position, std::uint64_t end) {
    BagRecord record;
    record.begin = position;
    const std::uint32_t header_size = length_at(position, end);
    if (header_size > kMostHeaderBytes || position + 4 + header_size > end) {
      fail(position, "the header of a record has " + std::to_string(header_size) + " bytes");
    }
    auto fields = fields_of(bytes_at(position + 4, header_size));
    if (!fields) fail(position, "the header of a record is no list of fields");
    record.fields = *std::move(fields);
    record.data = position + 4 + header_size + 4;
    record.size = length_at(record.data - 4, end);
    if (record.end() > end) {
      fail(position, "a record has " + std::to_string(record.size) + " bytes, more than follow");
    }
    return record;
  }

  template <class T>
  T number_in(const BagRecord& record, const char* name) const {
    const auto field = record.fields.find(name);
    if (field == record.fields.end() || field->second.size() != sizeof(T)) {
      fail(record.begin, std::string("a record has no '") + name + "'");
    }
    return *number_at<T>(field->second, 0);
  }

  Op op_of(const BagRecord& record) const { return static_cast<Op>(number_in<char>(record, "op")); }

  void look_at(const BagRecord& record) {
    switch (op_of(record)) {
      case Op::kBagHeader:
        index_position_ = number_in<std::uint64_t>(record, "index_pos");
        break;
      case Op::kChunk:
        take_chunk(record);
        break;
      case Op::kIndex:
        check_entries(record);
        break;
      case Op::kChunkInfo:
        listed_chunks_.insert(number_in<std::uint64_t>(record, "chunk_pos"));
        if (record.size != 8ULL * number_in<std::uint32_t>(record, "count")) {
          fail(record.begin, "the list of a chunk's topics is of another length than it says");
        }
        break;
      default:
        break;
    }
    starts_.insert(record.begin);
  }

  void take_chunk(const BagRecord& record) {
    const auto compression = record.fields.find("compression");
    if (compression == record.fields.end()) fail(record.begin, "a chunk has no compression");
    chunk_ = {record.data, number_in<std::uint32_t>(record, "size"), compression->second != "none"};
    chunks_.insert(record.begin);
    if (chunk_->size > kMostChunkBytes || (!chunk_->compressed && chunk_->size != record.size)) {
      fail(record.begin, "a chunk declares " + std::to_string(chunk_->size) + " bytes and has " +
                             std::to_string(record.size));
    }
  }

  /// The entries of an index, 12 bytes each: a time, and an offset in the chunk before it.
  void check_entries(const BagRecord& record) {
    constexpr std::size_t kEntry = 12;
    if (record.size != kEntry * std::uint64_t{number_in<std::uint32_t>(record, "count")}) {
      fail(record.begin, "an index is of another length than it says");
    }
    if (!chunk_) fail(record.begin, "an index is of no chunk");
    const std::string entries = bytes_at(record.data, record.size);
    for (std::size_t i = 0; i < entries.size(); i += kEntry) {
      const std::uint32_t offset = number_at<std::uint32_t>(entries, i + 8).value_or(0);
      if (offset >= chunk_->size) fail(record.begin, "an index points beyond its chunk");
      if (!chunk_->compressed) check_message(record, chunk_->data + offset);
    }
  }

  /// rosbag skips connections on the way to the message.
  void check_message(const BagRecord& index, std::uint64_t position) {
    const std::uint64_t end = chunk_->data + chunk_->size;
    BagRecord record = record_at(position, end);
    while (op_of(record) == Op::kConnection) record = record_at(record.end(), end);
    if (op_of(record) != Op::kMessage) fail(index.begin, "an index points to no message");
  }

  /// Without an index rosbag says so itself.
  void check_index() const {
    if (index_position_ == 0) return;
    if (index_position_ != size_ && !starts_.contains(index_position_)) {
      fail(index_position_, "there is no index, though the file's first record says so");
    }
    for (const std::uint64_t position : listed_chunks_) {
      if (!chunks_.contains(position)) fail(position, "there is no chunk, though one is listed");
    }
  }

  const std::filesystem::path& path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t index_position_ = 0;
  std::optional<BagChunk> chunk_;  ///< the last one
  std::set<std::uint64_t> chunks_;
  std::set<std::uint64_t> listed_chunks_;
  std::set<std::uint64_t> starts_;
};

/// One reading of a message along its layout.
class LayoutWalk {
 public:
  explicit LayoutWalk(std::string_view bytes) : bytes_(bytes) {}

  bool take(std::string_view layout) {
    while (!layout.empty()) {
      if (layout.front() == '(') {
        const std::size_t close = layout.find(')');
        if (!take_list_of(layout.substr(1, close - 1))) return false;
        layout.remove_prefix(close + 1);
      } else if (layout.front() == 'v') {
        const auto count = number();
        if (!count || !skip(std::uint64_t{*count} * size_of(layout[1]))) return false;
        layout.remove_prefix(2);
      } else {
        if (!skip(size_of(layout.front()))) return false;
        layout.remove_prefix(1);
      }
    }
    return true;
  }

 private:
  static std::uint64_t size_of(char digit) { return static_cast<std::uint64_t>(digit - '0'); }

  bool skip(std::uint64_t size) {
    if (size > bytes_.size()) return false;
    bytes_.remove_prefix(static_cast<std::size_t>(size));
    return true;
  }

  std::optional<std::uint32_t> number() {
    const auto value = number_at<std::uint32_t>(bytes_, 0);
    if (value) bytes_.remove_prefix(4);
    return value;
  }

  bool take_list_of(std::string_view layout) {
    const auto count = number();
    if (!count) return false;
    for (std::uint32_t i = 0; i < *count; ++i) {
      if (!take(layout)) return false;
    }
    return true;
  }

  std::string_view bytes_;
};

}  // namespace

void check_bag_structure(const std::filesystem::path& file) { BagWalk(file).walk(); }

bool has_layout(std::string_view bytes, std::string_view layout) {
  return LayoutWalk(bytes).take(layout);
}

}  // namespace nadir::ros1
