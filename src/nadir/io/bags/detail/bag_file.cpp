// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/bags/detail/bag_file.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "nadir/io/bags/detail/bag_chunk.hpp"
#include "nadir/io/detail/file_pieces.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir::ros1 {
namespace {

constexpr std::string_view kVersion = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMostHeaderBytes = 1U << 20U;
constexpr std::uint32_t kMostChunkBytes = 1U << 28U;
/// Writers note a message's own place, rosbag reads on behind topics. Without a bound every entry
/// of an index could go through all of a chunk.
constexpr int kMostTopicsBefore = 64;

/// op of a record.
enum class Op : char {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

using Fields = std::map<std::string, std::string>;

template <class T>
std::optional<T> number_at(std::string_view bytes, std::size_t position) {
  if (bytes.size() < sizeof(T) || position > bytes.size() - sizeof(T)) return std::nullopt;
  T value{};
  std::memcpy(&value, bytes.data() + position, sizeof(T));
  return value;
}

/// The fields `name=value` of a header, each after its length; nothing where they are none, or one
/// is there twice, so that readers might differ in which they take.
std::optional<Fields> fields_of(std::string_view header) {
  Fields fields;
  while (!header.empty()) {
    const auto size = number_at<std::uint32_t>(header, 0);
    if (!size || *size > header.size() - 4) return std::nullopt;
    const std::string_view field = header.substr(4, *size);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    if (!fields.emplace(field.substr(0, equals), field.substr(equals + 1)).second) {
      return std::nullopt;
    }
    header.remove_prefix(4 + field.size());
  }
  return fields;
}

}  // namespace

class BagFile::Walk {
  struct Record {
    Fields fields;
    std::uint64_t begin = 0;  ///< of the record
    std::uint64_t data = 0;   ///< of its data
    std::uint32_t size = 0;   ///< of its data
    std::uint64_t end() const { return data + size; }
  };

  struct Chunk {
    std::uint64_t begin = 0;  ///< of its record
    std::uint64_t data = 0;
    std::uint32_t packed = 0;
    std::uint32_t size = 0;  ///< unpacked
    std::string compression;
    bool is_compressed() const { return compression != "none"; }
  };

  /// Where records are taken from: the file, or a chunk that was unpacked.
  struct Stretch {
    std::function<std::string(std::uint64_t position, std::size_t count)> read;
    std::uint64_t end = 0;
    std::optional<std::uint64_t> chunk;  ///< of an unpacked one: where it lies in the file
  };

 public:
  explicit Walk(const std::filesystem::path& file) : path_(file), pieces_(file) {}

  void walk() {
    if (pieces_.at(0, kVersion.size()) != kVersion) {
      throw input_error(path_, "is no bag of version 2.0", "run `rosbag fix` on it");
    }
    const Stretch file = whole();
    for (std::uint64_t position = kVersion.size(); position < pieces_.size();) {
      const Record record = record_at(file, position);
      look_at(record);
      position = record.end();
    }
    check_index();
    std::stable_sort(
        messages_.begin(), messages_.end(),
        [](const BagMessage& a, const BagMessage& b) { return a.recorded_ns < b.recorded_ns; });
  }

  const std::vector<BagMessage>& messages() const { return messages_; }
  const BagConnection& connection(std::uint32_t number) const { return connections_.at(number); }

  std::string bytes_of(const BagMessage& message) {
    const Chunk& chunk = chunks_.at(message.chunk);
    if (!chunk.is_compressed()) {
      const Record record = message_at(within(chunk), chunk.data + message.offset);
      return pieces_.at(record.data, record.size);
    }
    if (unpacked_ != message.chunk) {
      auto bytes = unpacked(chunk.compression, pieces_.at(chunk.data, chunk.packed), chunk.size);
      if (!bytes) fail(chunk.begin, "the chunk there cannot be unpacked");
      unpacked_bytes_ = *std::move(bytes);
      unpacked_ = message.chunk;
    }
    const auto read_unpacked = [this](std::uint64_t position, std::size_t count) {
      return unpacked_bytes_.substr(static_cast<std::size_t>(position), count);
    };
    const Stretch stretch{read_unpacked, unpacked_bytes_.size(), chunk.begin};
    const Record record = message_at(stretch, message.offset);
    return read_unpacked(record.data, record.size);
  }

 private:
  [[noreturn]] void fail(std::uint64_t position, const std::string& problem) const {
    throw input_error(path_, "is damaged at byte " + std::to_string(position) + ": " + problem,
                      "copy the bag again, or run `rosbag fix` or `rosbag reindex` on it");
  }
  [[noreturn]] void fail(const Stretch& stretch, std::uint64_t position,
                         const std::string& problem) const {
    if (stretch.chunk) fail(*stretch.chunk, "in the chunk there " + problem);
    fail(position, problem);
  }

  Stretch whole() {
    return {[this](std::uint64_t at, std::size_t count) { return pieces_.at(at, count); },
            pieces_.size(),
            {}};
  }
  Stretch within(const Chunk& chunk) {
    Stretch stretch = whole();
    stretch.end = chunk.data + chunk.size;
    return stretch;
  }

  std::uint32_t length_at(const Stretch& stretch, std::uint64_t position) const {
    if (position + 4 > stretch.end) fail(stretch, position, "a record is cut off");
    return number_at<std::uint32_t>(stretch.read(position, 4), 0).value_or(0);
  }

  /// The record at a place, all of it within the stretch.
  Record record_at(const Stretch& stretch, std::uint64_t position) const {
    Record record;
    record.begin = position;
    const std::uint32_t header_size = length_at(stretch, position);
    if (header_size > kMostHeaderBytes || position + 4 + header_size > stretch.end) {
      fail(stretch, position,
           "the header of a record has " + std::to_string(header_size) + " bytes");
    }
    auto fields = fields_of(stretch.read(position + 4, header_size));
    if (!fields) fail(stretch, position, "the header of a record is no list of fields");
    record.fields = *std::move(fields);
    record.data = position + 4 + header_size + 4;
    record.size = length_at(stretch, record.data - 4);
    if (record.end() > stretch.end) {
      fail(stretch, position,
           "a record has " + std::to_string(record.size) + " bytes, more than follow");
    }
    return record;
  }

  /// The message at a place of a chunk, behind the topics that may stand before it.
  Record message_at(const Stretch& stretch, std::uint64_t position) const {
    Record record = record_at(stretch, position);
    for (int topics = 0; op_of(record) == Op::kConnection; ++topics) {
      if (topics == kMostTopicsBefore) fail(stretch, position, "the index points to no message");
      record = record_at(stretch, record.end());
    }
    if (op_of(record) != Op::kMessage) {
      fail(stretch, position, "the index points to no message");
    }
    return record;
  }

  const std::string& text_in(const Fields& fields, const char* name, std::uint64_t place) const {
    const auto field = fields.find(name);
    if (field == fields.end()) fail(place, std::string("a record has no '") + name + "'");
    return field->second;
  }

  template <class T>
  T number_in(const Record& record, const char* name) const {
    const std::string& bytes = text_in(record.fields, name, record.begin);
    if (bytes.size() != sizeof(T))
      fail(record.begin, std::string("a record has no '") + name + "'");
    return *number_at<T>(bytes, 0);
  }

  Op op_of(const Record& record) const { return static_cast<Op>(number_in<char>(record, "op")); }

  void look_at(const Record& record) {
    switch (op_of(record)) {
      case Op::kBagHeader:
        take_header(record);
        break;
      case Op::kChunk:
        take_chunk(record);
        break;
      case Op::kIndex:
        take_entries(record);
        break;
      case Op::kConnection:
        take_connection(record);
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

  void take_header(const Record& record) {
    index_position_ = number_in<std::uint64_t>(record, "index_pos");
    const auto encryptor = record.fields.find("encryptor");
    if (encryptor != record.fields.end() && !encryptor->second.empty()) {
      throw input_error(path_, "is encrypted", "run `rosbag decrypt` on it");
    }
  }

  void take_chunk(const Record& record) {
    const std::string& compression = text_in(record.fields, "compression", record.begin);
    if (compression != "none" && compression != "bz2" && compression != "lz4") {
      fail(record.begin, "the compression of a chunk is '" + compression + "'");
    }
    const Chunk chunk{record.begin, record.data, record.size,
                      number_in<std::uint32_t>(record, "size"), compression};
    if (chunk.size > kMostChunkBytes || (!chunk.is_compressed() && chunk.size != chunk.packed)) {
      fail(record.begin, "a chunk declares " + std::to_string(chunk.size) + " bytes and has " +
                             std::to_string(chunk.packed));
    }
    chunks_.push_back(chunk);
    chunk_starts_.insert(record.begin);
  }

  /// The data of a topic's record is a list of fields too.
  void take_connection(const Record& record) {
    const auto about = record.size > kMostHeaderBytes
                           ? std::nullopt
                           : fields_of(pieces_.at(record.data, record.size));
    if (!about) fail(record.begin, "what it says of a topic is no list of fields");
    connections_.emplace(number_in<std::uint32_t>(record, "conn"),
                         BagConnection{text_in(record.fields, "topic", record.begin),
                                       text_in(*about, "type", record.begin),
                                       text_in(*about, "md5sum", record.begin)});
  }

  /// The entries of an index, 12 bytes each: a time, and an offset in the chunk before it.
  void take_entries(const Record& record) {
    constexpr std::size_t kEntry = 12;
    if (record.size != kEntry * std::uint64_t{number_in<std::uint32_t>(record, "count")}) {
      fail(record.begin, "an index is of another length than it says");
    }
    if (chunks_.empty()) fail(record.begin, "an index is of no chunk");
    const Chunk& chunk = chunks_.back();
    const auto connection = number_in<std::uint32_t>(record, "conn");
    indexed_.emplace(connection, record.begin);
    const std::string entries = pieces_.at(record.data, record.size);
    for (std::size_t i = 0; i + kEntry <= entries.size(); i += kEntry) {
      const auto number = [&](std::size_t at) {
        return number_at<std::uint32_t>(entries, i + at).value_or(0);
      };
      const BagMessage message{std::int64_t{number(0)} * 1'000'000'000 + number(4), connection,
                               number(8), chunks_.size() - 1};
      if (message.offset >= chunk.size) fail(record.begin, "an index points beyond its chunk");
      if (!chunk.is_compressed()) message_at(within(chunk), chunk.data + message.offset);
      messages_.push_back(message);
    }
  }

  void check_index() const {
    if (index_position_ == 0) {
      throw input_error(path_, "has no index: the recording was cut off",
                        "run `rosbag reindex` on it");
    }
    if (index_position_ != pieces_.size() && !starts_.contains(index_position_)) {
      fail(index_position_, "there is no index, though the file's first record says so");
    }
    for (const std::uint64_t position : listed_chunks_) {
      if (!chunk_starts_.contains(position)) {
        fail(position, "there is no chunk, though one is listed");
      }
    }
    for (const auto& [connection, place] : indexed_) {
      if (!connections_.contains(connection))
        fail(place, "an index is of a topic that is not listed");
    }
  }

  std::filesystem::path path_;
  FilePieces pieces_;
  std::uint64_t index_position_ = 0;
  std::vector<Chunk> chunks_;
  std::set<std::uint64_t> chunk_starts_;
  std::set<std::uint64_t> listed_chunks_;
  std::set<std::uint64_t> starts_;
  std::map<std::uint32_t, std::uint64_t> indexed_;  ///< connections, and where their index is
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<BagMessage> messages_;
  std::optional<std::size_t> unpacked_;  ///< the chunk that was unpacked last
  std::string unpacked_bytes_;
};

BagFile::BagFile(const std::filesystem::path& file) : walk_(std::make_unique<Walk>(file)) {
  walk_->walk();
}

BagFile::~BagFile() = default;

const std::vector<BagMessage>& BagFile::messages() const { return walk_->messages(); }

const BagConnection& BagFile::connection_of(const BagMessage& message) const {
  return walk_->connection(message.connection);
}

std::string BagFile::bytes_of(const BagMessage& message) const { return walk_->bytes_of(message); }

}  // namespace nadir::ros1
