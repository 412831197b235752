// SPDX-License-Identifier: Apache-2.0
#pragma once

// Writes ROS 1 bags with rosbag's own writer, out of the plain types that the reader gives.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "nadir/io/detail/ros1.hpp"

namespace nadir::test {

class BagWriter {
 public:
  /// `chunk_compression`: none, or rosbag's lz4.
  explicit BagWriter(const std::filesystem::path& file, bool chunk_compression = false);
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
