// SPDX-License-Identifier: Apache-2.0
#pragma once

// Writes ROS 1 bags with rosbag's own writer, out of the plain types that the reader gives.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "nadir/io/bags/detail/ros1.hpp"

namespace nadir::test {

enum class BagCompression { kNone, kLz4, kBz2 };

/// As the chunks of a bag are compressed.
std::string packed_bz2(std::string bytes);
std::string packed_lz4(const std::string& bytes);

/// What the only chunk of a bag holds, and the bag with another one in its place; `unpacked` is the
/// size that it declares.
std::string chunk_of(const std::string& bag);
std::string with_chunk(const std::string& bag, const std::string& compression,
                       const std::string& packed, std::size_t unpacked);

class BagWriter {
 public:
  explicit BagWriter(const std::filesystem::path& file,
                     BagCompression compression = BagCompression::kNone);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  // Recorded at the stamps of their headers.
  void write(const std::string& topic, const ros1::Image& image);
  void write(const std::string& topic, const ros1::CameraInfo& info);
  void write(const std::string& topic, const ros1::PointCloud& cloud);
  /// nav_msgs/Odometry.
  void write_odometry(const std::string& topic, const ros1::Transform& pose);
  /// tf2_msgs/TFMessage of one transform.
  void write_transform(const std::string& topic, const ros1::Transform& transform);
  /// std_msgs/Header stands for what nadir does not know.
  void write_header(const std::string& topic, const ros1::Header& header);
  void close();

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace nadir::test
