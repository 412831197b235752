// SPDX-License-Identifier: Apache-2.0
#pragma once

// What a ROS 1 bag holds, in plain types. The headers of ROS do not compile as C++20 (their
// messages rebind std::allocator<void>): ros1.cpp includes them, as C++17, and this header is both.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace nadir::ros1 {

struct Topic {
  std::string name;
  std::string type;  ///< "sensor_msgs/Image"
  std::size_t messages = 0;
  std::int64_t first_ns = 0;  ///< when it was recorded
  std::int64_t last_ns = 0;
};

struct Header {
  std::int64_t stamp_ns = 0;
  std::string frame;
};

/// sensor_msgs/Image, or sensor_msgs/CompressedImage, whose size is in its bytes.
struct Image {
  Header header;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t step = 0;  ///< bytes of a row
  std::string encoding;    ///< of a compressed one: its format
  bool compressed = false;
  std::string bytes;
};

/// sensor_msgs/CameraInfo, whose letters these are.
struct CameraInfo {
  Header header;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
};

struct PointField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 7;  ///< 1 to 8: int8, uint8, int16, ..., float32, float64
  std::uint32_t count = 1;
};

/// sensor_msgs/PointCloud2.
struct PointCloud {
  Header header;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  bool big_endian = false;
  std::vector<PointField> fields;
  std::string bytes;
};

/// Of tf, or the pose of nav_msgs/Odometry: coordinates in `child` to coordinates in header.frame.
struct Transform {
  Header header;
  std::string child;
  std::array<double, 3> translation{};
  std::array<double, 4> rotation_xyzw{0.0, 0.0, 0.0, 1.0};
};

/// An opened bag. Messages are counted from 0 in the order of their recording and read when asked
/// for, by one thread at a time. All throw Error (input) that names the file: for a file that is
/// missing, no bag, not indexed, cut off or encrypted, and for a message of another type than asked
/// for.
class Bag {
 public:
  explicit Bag(const std::filesystem::path& file);
  ~Bag();
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;
  Bag(Bag&&) = delete;
  Bag& operator=(Bag&&) = delete;

  const std::filesystem::path& file() const;
  const std::vector<Topic>& topics() const;  ///< by name

  /// Of every message of a topic whose type begins with a header.
  std::vector<Header> headers(const std::string& topic) const;
  Image image(const std::string& topic, std::size_t number) const;
  CameraInfo camera_info(const std::string& topic) const;  ///< the first one
  PointCloud cloud(const std::string& topic, std::size_t number) const;
  std::vector<Transform> odometry(const std::string& topic) const;
  std::vector<Transform> transforms(const std::string& topic) const;

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace nadir::ros1
