// SPDX-License-Identifier: Apache-2.0
#pragma once

// The records of a ROS 1 bag (http://wiki.ros.org/Bags/Format/2.0), with every length and offset
// checked: rosbag takes them for granted. C++17, as ros1.hpp is.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace nadir::ros1 {

/// What the index says of a topic.
struct BagConnection {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Image"
  std::string md5;   ///< of its definition; "*" = any
};

/// An entry of the index.
struct BagMessage {
  std::int64_t recorded_ns = 0;
  std::uint32_t connection = 0;
  std::uint32_t offset = 0;  ///< in the chunk, unpacked
  std::size_t chunk = 0;
};

/// A bag of version 2.0. One thread at a time.
class BagFile {
 public:
  /// Walks the records; data is skipped, and of an uncompressed chunk each message that the index
  /// names is looked at. Throws Error (input) that names the byte where
  ///   a record is longer than the file, or its header than 1 MiB or no list of fields;
  ///   a chunk declares more than 256 MiB, or is of another size than its data where it is not
  ///   compressed;
  ///   an index points beyond its chunk, to no message, or is of a topic that is not listed;
  ///   the index of the file, or a chunk that it lists, is not where it is said to be;
  /// and for a bag without an index, and one that is encrypted.
  explicit BagFile(const std::filesystem::path& file);
  ~BagFile();
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;
  BagFile(BagFile&&) = delete;
  BagFile& operator=(BagFile&&) = delete;

  /// In the order of their recording.
  const std::vector<BagMessage>& messages() const;
  const BagConnection& connection_of(const BagMessage& message) const;

  /// The bytes of a message; the chunk that was unpacked last is kept. Throws Error (input) where a
  /// chunk cannot be unpacked, and where no message lies in it at that place.
  std::string bytes_of(const BagMessage& message) const;

 private:
  class Walk;
  std::unique_ptr<Walk> walk_;
};

}  // namespace nadir::ros1
