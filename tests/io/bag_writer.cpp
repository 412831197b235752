// SPDX-License-Identifier: Apache-2.0
// Compiled as C++17: nadir/io/detail/ros1.hpp says why.
#include "io/bag_writer.hpp"

#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

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

}  // namespace

struct BagWriter::Contents {
  rosbag::Bag bag;
};

BagWriter::BagWriter(const std::filesystem::path& file, bool chunk_compression)
    : contents_(std::make_unique<Contents>()) {
  contents_->bag.open(file.string(), rosbag::bagmode::Write);
  if (chunk_compression) contents_->bag.setCompression(rosbag::compression::LZ4);
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
