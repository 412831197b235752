// SPDX-License-Identifier: Apache-2.0
// Compiled as C++17: nadir/io/bags/detail/ros1.hpp says why.
#include "io/bag_writer.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace nadir::test {
namespace {

ros::Time time_of(const ros1::Header& header) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(header.stamp_ns));
  return time;
}

std_msgs::Header header_of(const ros1::Header& header) {
  std_msgs::Header result;
  result.stamp = time_of(header);
  result.frame_id = header.frame;
  return result;
}

template <class Rotation>
void fill(Rotation& q, const std::array<double, 4>& xyzw) {
  q.x = xyzw[0];
  q.y = xyzw[1];
  q.z = xyzw[2];
  q.w = xyzw[3];
}

template <class Vector>
void fill_vector(Vector& v, const std::array<double, 3>& xyz) {
  v.x = xyz[0];
  v.y = xyz[1];
  v.z = xyz[2];
}

template <class T>
T number_at(const std::string& bytes, std::size_t position) {
  T value{};
  std::memcpy(&value, bytes.data() + position, sizeof(T));
  return value;
}

std::string bytes_of(std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

std::string sized(const std::string& text) { return bytes_of(text.size()) + text; }

/// Where the record of the chunk begins, its data, and what follows it.
struct ChunkPlace {
  explicit ChunkPlace(const std::string& bag) {
    begin = bag.find("compression=") - 8;
    data = begin + 8 + number_at<std::uint32_t>(bag, begin);
    end = data + number_at<std::uint32_t>(bag, data - 4);
  }
  std::size_t begin = 0;
  std::size_t data = 0;
  std::size_t end = 0;
};

}  // namespace

std::string packed_lz4(const std::string& bytes) {
  std::string packed(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

std::string chunk_of(const std::string& bag) {
  const ChunkPlace place(bag);
  return bag.substr(place.data, place.end - place.data);
}

std::string with_chunk(const std::string& bag, const std::string& compression,
                       const std::string& packed, std::size_t unpacked) {
  const ChunkPlace place(bag);
  const std::string header =
      sized("compression=" + compression) + sized("op=\x05") + sized("size=" + bytes_of(unpacked));
  std::string result =
      bag.substr(0, place.begin) + sized(header) + sized(packed) + bag.substr(place.end);
  const std::size_t index = result.find("index_pos=") + 10;
  const std::uint64_t moved = number_at<std::uint64_t>(result, index) + result.size() - bag.size();
  std::memcpy(result.data() + index, &moved, sizeof(moved));
  return result;
}

std::string packed_bz2(std::string bytes) {
  std::string packed(bytes.size() + bytes.size() / 50 + 1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  if (BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(),
                               static_cast<unsigned>(bytes.size()), 9, 0, 0) != BZ_OK) {
    throw std::runtime_error("the test cannot compress its chunk");
  }
  packed.resize(size);
  return packed;
}

struct BagWriter::Contents {
  rosbag::Bag bag;
};

BagWriter::BagWriter(const std::filesystem::path& file, BagCompression compression)
    : contents_(std::make_unique<Contents>()) {
  contents_->bag.open(file.string(), rosbag::bagmode::Write);
  if (compression == BagCompression::kLz4) {
    contents_->bag.setCompression(rosbag::compression::LZ4);
  } else if (compression == BagCompression::kBz2) {
    contents_->bag.setCompression(rosbag::compression::BZ2);
  }
}

BagWriter::~BagWriter() = default;

void BagWriter::close() { contents_->bag.close(); }

void BagWriter::write(const std::string& topic, const ros1::Image& image) {
  if (image.compressed) {
    sensor_msgs::CompressedImage message;
    message.header = header_of(image.header);
    message.format = image.encoding;
    message.data.assign(image.bytes.begin(), image.bytes.end());
    contents_->bag.write(topic, time_of(image.header), message);
    return;
  }
  sensor_msgs::Image message;
  message.header = header_of(image.header);
  message.width = image.width;
  message.height = image.height;
  message.step = image.step;
  message.encoding = image.encoding;
  message.data.assign(image.bytes.begin(), image.bytes.end());
  contents_->bag.write(topic, time_of(image.header), message);
}

void BagWriter::write(const std::string& topic, const ros1::CameraInfo& info) {
  sensor_msgs::CameraInfo message;
  message.header = header_of(info.header);
  message.width = info.width;
  message.height = info.height;
  message.distortion_model = info.distortion_model;
  message.D = info.d;
  std::copy(info.k.begin(), info.k.end(), message.K.begin());
  std::copy(info.r.begin(), info.r.end(), message.R.begin());
  std::copy(info.p.begin(), info.p.end(), message.P.begin());
  contents_->bag.write(topic, time_of(info.header), message);
}

void BagWriter::write(const std::string& topic, const ros1::PointCloud& cloud) {
  sensor_msgs::PointCloud2 message;
  message.header = header_of(cloud.header);
  message.width = cloud.width;
  message.height = cloud.height;
  message.point_step = cloud.point_step;
  message.row_step = cloud.row_step;
  message.is_bigendian = cloud.big_endian;
  for (const ros1::PointField& field : cloud.fields) {
    sensor_msgs::PointField one;
    one.name = field.name;
    one.offset = field.offset;
    one.datatype = field.datatype;
    one.count = field.count;
    message.fields.push_back(one);
  }
  message.data.assign(cloud.bytes.begin(), cloud.bytes.end());
  contents_->bag.write(topic, time_of(cloud.header), message);
}

void BagWriter::write_odometry(const std::string& topic, const ros1::Transform& pose) {
  nav_msgs::Odometry message;
  message.header = header_of(pose.header);
  message.child_frame_id = pose.child;
  fill_vector(message.pose.pose.position, pose.translation);
  fill(message.pose.pose.orientation, pose.rotation_xyzw);
  contents_->bag.write(topic, time_of(pose.header), message);
}

void BagWriter::write_transform(const std::string& topic, const ros1::Transform& transform) {
  geometry_msgs::TransformStamped one;
  one.header = header_of(transform.header);
  one.child_frame_id = transform.child;
  fill_vector(one.transform.translation, transform.translation);
  fill(one.transform.rotation, transform.rotation_xyzw);
  tf2_msgs::TFMessage message;
  message.transforms.push_back(one);
  contents_->bag.write(topic, time_of(transform.header), message);
}

void BagWriter::write_header(const std::string& topic, const ros1::Header& header) {
  contents_->bag.write(topic, time_of(header), header_of(header));
}

}  // namespace nadir::test
