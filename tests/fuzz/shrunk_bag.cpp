// SPDX-License-Identifier: Apache-2.0
#include "fuzz/shrunk_bag.hpp"

#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>

// http://wiki.ros.org/Bags/Format/2.0: records of a header (fields `name=value`) and data, each
// after its length.
namespace nadir::fuzz {
namespace {

constexpr char kIndex = 4;
constexpr char kChunk = 5;
constexpr char kChunkInfo = 6;
constexpr char kConnection = 7;

template <class T>
T number_in(std::string_view bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

std::string sized(const std::string& bytes) {
  return bytes_of(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

/// Takes a piece with its length off the front.
std::string taken(std::string_view& bytes) {
  const auto size = number_in<std::uint32_t>(bytes);
  std::string piece(bytes.substr(4, size));
  bytes.remove_prefix(4 + piece.size());
  return piece;
}

using Fields = std::map<std::string, std::string>;

Fields fields_of(std::string_view header) {
  Fields fields;
  while (!header.empty()) {
    const std::string field = taken(header);
    const std::size_t equals = field.find('=');
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

struct Record {
  Fields fields;
  std::string data;

  char kind() const { return fields.at("op").front(); }
  std::string bytes() const {
    std::string header;
    for (const auto& [name, value] : fields) header += sized(name + "=" + value);
    return sized(header) + sized(data);
  }
};

Record next_record(std::string_view& bytes) {
  const std::string header = taken(bytes);
  return {fields_of(header), taken(bytes)};
}

void drop_definition(Record& connection) {
  std::string data;
  for (const auto& [name, value] : fields_of(connection.data)) {
    data += sized(name + "=" + (name == "message_definition" ? "" : value));
  }
  connection.data = data;
}

/// The records of a chunk without definitions; `moved` says where each of them went.
std::string shrunk_chunk(std::string_view chunk, std::map<std::uint32_t, std::uint32_t>& moved) {
  const std::size_t all = chunk.size();
  std::string shrunk;
  while (!chunk.empty()) {
    moved[static_cast<std::uint32_t>(all - chunk.size())] =
        static_cast<std::uint32_t>(shrunk.size());
    Record record = next_record(chunk);
    if (record.kind() == kConnection) drop_definition(record);
    shrunk += record.bytes();
  }
  return shrunk;
}

}  // namespace

std::string shrunk_bag(const std::string& bag) {
  const std::size_t version_end = bag.find('\n') + 1;
  std::string shrunk = bag.substr(0, version_end);
  std::string_view rest = std::string_view(bag).substr(version_end);
  Record header = next_record(rest);
  header.data.clear();
  const std::size_t chunk_position = shrunk.size() + header.bytes().size();
  std::string records;
  std::map<std::uint32_t, std::uint32_t> moved;
  std::size_t index_position = 0;
  while (!rest.empty()) {
    Record record = next_record(rest);
    if (record.kind() == kChunk) {
      record.data = shrunk_chunk(record.data, moved);
      record.fields["size"] = bytes_of(static_cast<std::uint32_t>(record.data.size()));
    }
    constexpr std::size_t kEntry = 12;  // time, and an offset in the chunk
    for (std::size_t i = 8; record.kind() == kIndex && i < record.data.size(); i += kEntry) {
      const auto old = number_in<std::uint32_t>(std::string_view(record.data).substr(i));
      record.data.replace(i, 4, bytes_of(moved.at(old)));
    }
    if (record.kind() == kConnection) {
      drop_definition(record);
      if (index_position == 0) index_position = chunk_position + records.size();
    }
    if (record.kind() == kChunkInfo) {
      record.fields["chunk_pos"] = bytes_of(static_cast<std::uint64_t>(chunk_position));
    }
    records += record.bytes();
  }
  header.fields["index_pos"] = bytes_of(static_cast<std::uint64_t>(index_position));
  return shrunk + header.bytes() + records;
}

}  // namespace nadir::fuzz
