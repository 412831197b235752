// SPDX-License-Identifier: Apache-2.0
// Compiled as C++17: ros1.hpp says why.
#include "nadir/io/bags/detail/ros1.hpp"

#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <fstream>
#include <map>
#include <string_view>

#include "nadir/io/bags/detail/bag_file.hpp"
#include "nadir/io/bags/detail/message_layout.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir::ros1 {
namespace {

std::int64_t nanoseconds(const ros::Time& time) {
  return static_cast<std::int64_t>(time.sec) * 1'000'000'000 + time.nsec;
}

Header header_of(const std_msgs::Header& header) {
  return {nanoseconds(header.stamp), header.frame_id};
}

template <class Rotation>
std::array<double, 4> xyzw(const Rotation& q) {
  return {q.x, q.y, q.z, q.w};
}

template <class Vector>
std::array<double, 3> xyz(const Vector& v) {
  return {v.x, v.y, v.z};
}

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

template <std::size_t N, class Values>
std::array<double, N> array_of(const Values& values) {
  std::array<double, N> result{};
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

/// Other files are told apart before anything is looked for in them.
void check_is_bag(const std::filesystem::path& file) {
  constexpr std::string_view kBegin = "#ROSBAG V";
  std::string begin(kBegin.size(), '\0');
  std::ifstream(file, std::ios::binary)
      .read(begin.data(), static_cast<std::streamsize>(kBegin.size()));
  if (begin != kBegin) {
    throw input_error(file, "is no ROS 1 bag", "convert a bag of ROS 2 with `rosbags-convert`");
  }
}

/// What ROS throws where it takes a message apart, as the Error of a bad file.
template <class Action>
auto reading(const std::filesystem::path& file, const Action& action) {
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& exception) {
    throw input_error(file, std::string("cannot be read: ") + exception.what(),
                      "copy the bag again, or run `rosbag fix` or `rosbag reindex` on it");
  }
}

/// A message out of its bytes, which are known to hold what they declare.
template <class Message>
Message message_of(std::string& bytes) {
  Message message;
  ros::serialization::IStream in(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                 static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, message);
  return message;
}

constexpr const char* kHeaderLayout = "444v1";  // number, seconds, nanoseconds, frame

/// has_layout() of each type that is read.
template <class Message>
const char* layout_of();
template <>
const char* layout_of<sensor_msgs::Image>() {
  return "444v144v114v1";
}
template <>
const char* layout_of<sensor_msgs::CompressedImage>() {
  return "444v1v1v1";
}
template <>
const char* layout_of<sensor_msgs::CameraInfo>() {
  return "444v144v1v88888888888888888888888888888884444441";
}
template <>
const char* layout_of<sensor_msgs::PointCloud2>() {
  return "444v144(v1414)144v11";
}
template <>
const char* layout_of<nav_msgs::Odometry>() {
  return "444v1v1";  // and numbers, which deserialize() counts itself
}
template <>
const char* layout_of<tf2_msgs::TFMessage>() {
  return "(444v1v18888888)";
}

}  // namespace

struct Bag::Contents {
  explicit Contents(const std::filesystem::path& path);

  std::filesystem::path file;
  BagFile bag;
  std::vector<Topic> topics;
  std::map<std::string, std::vector<BagMessage>> messages;

  const std::vector<BagMessage>& of(const std::string& topic) const;

  template <class Message>
  bool is_of(const BagMessage& message) const;
  template <class Message>
  Message instance(const BagMessage& message) const;
  template <class Message>
  Message instance(const std::string& topic, std::size_t number) const;
};

Bag::Contents::Contents(const std::filesystem::path& path) : file(path), bag(path) {
  std::map<std::string, Topic> by_name;
  for (const BagMessage& message : bag.messages()) {
    const BagConnection& connection = bag.connection_of(message);
    Topic& topic = by_name[connection.topic];
    if (topic.messages == 0) {
      topic = {connection.topic, connection.type, 0, message.recorded_ns, message.recorded_ns};
    }
    ++topic.messages;
    topic.last_ns = message.recorded_ns;
    messages[topic.name].push_back(message);
  }
  for (const auto& entry : by_name) topics.push_back(entry.second);
}

const std::vector<BagMessage>& Bag::Contents::of(const std::string& topic) const {
  const auto found = messages.find(topic);
  if (found == messages.end()) throw input_error(file, "has no topic " + topic);
  return found->second;
}

/// By the checksum of its definition, as ROS does.
template <class Message>
bool Bag::Contents::is_of(const BagMessage& message) const {
  const std::string& md5 = bag.connection_of(message).md5;
  return md5 == "*" || md5 == ros::message_traits::MD5Sum<Message>::value();
}

/// Once the message is known to hold what it declares: its lists are made as long as they say
/// before they are read.
template <class Message>
Message Bag::Contents::instance(const BagMessage& message) const {
  const BagConnection& connection = bag.connection_of(message);
  if (!is_of<Message>(message)) {
    throw input_error(file, connection.topic + " is of type " + connection.type + ", not " +
                                ros::message_traits::DataType<Message>::value());
  }
  std::string bytes = bag.bytes_of(message);
  if (!has_layout(bytes, layout_of<Message>())) {
    throw input_error(file, "a message of " + connection.topic + " is damaged",
                      "leave it out with --first and --count");
  }
  return message_of<Message>(bytes);
}

template <class Message>
Message Bag::Contents::instance(const std::string& topic, std::size_t number) const {
  return instance<Message>(of(topic).at(number));
}

namespace {

const std::filesystem::path& checked(const std::filesystem::path& file) {
  check_input_file(file);
  check_is_bag(file);
  return file;
}

}  // namespace

Bag::Bag(const std::filesystem::path& file)
    : contents_(std::make_unique<Contents>(checked(file))) {}

Bag::~Bag() = default;

const std::filesystem::path& Bag::file() const { return contents_->file; }

const std::vector<Topic>& Bag::topics() const { return contents_->topics; }

std::vector<Header> Bag::headers(const std::string& topic) const {
  return reading(file(), [&] {
    std::vector<Header> headers;
    for (const BagMessage& message : contents_->of(topic)) {
      std::string bytes = contents_->bag.bytes_of(message);
      if (!has_layout(bytes, kHeaderLayout)) {
        throw input_error(file(), "a message of " + topic + " begins with no header");
      }
      headers.push_back(header_of(message_of<std_msgs::Header>(bytes)));
    }
    return headers;
  });
}

Image Bag::image(const std::string& topic, std::size_t number) const {
  return reading(file(), [&]() -> Image {
    const BagMessage& message = contents_->of(topic).at(number);
    if (contents_->is_of<sensor_msgs::CompressedImage>(message)) {
      const auto compressed = contents_->instance<sensor_msgs::CompressedImage>(message);
      return {header_of(compressed.header), 0, 0, 0, compressed.format, true,
              text_of(compressed.data)};
    }
    const auto image = contents_->instance<sensor_msgs::Image>(message);
    return {header_of(image.header), image.width, image.height,       image.step,
            image.encoding,          false,       text_of(image.data)};
  });
}

CameraInfo Bag::camera_info(const std::string& topic) const {
  return reading(file(), [&]() -> CameraInfo {
    const auto info = contents_->instance<sensor_msgs::CameraInfo>(topic, 0);
    return {header_of(info.header),
            info.width,
            info.height,
            info.distortion_model,
            info.D,
            array_of<9>(info.K),
            array_of<9>(info.R),
            array_of<12>(info.P)};
  });
}

PointCloud Bag::cloud(const std::string& topic, std::size_t number) const {
  return reading(file(), [&] {
    const auto message = contents_->instance<sensor_msgs::PointCloud2>(topic, number);
    PointCloud cloud{header_of(message.header),
                     message.width,
                     message.height,
                     message.point_step,
                     message.row_step,
                     message.is_bigendian != 0,
                     {},
                     text_of(message.data)};
    for (const auto& field : message.fields) {
      cloud.fields.push_back({field.name, field.offset, field.datatype, field.count});
    }
    return cloud;
  });
}

std::vector<Transform> Bag::odometry(const std::string& topic) const {
  return reading(file(), [&] {
    std::vector<Transform> poses;
    for (const BagMessage& message : contents_->of(topic)) {
      const auto odometry = contents_->instance<nav_msgs::Odometry>(message);
      const auto& pose = odometry.pose.pose;
      poses.push_back({header_of(odometry.header), odometry.child_frame_id, xyz(pose.position),
                       xyzw(pose.orientation)});
    }
    return poses;
  });
}

std::vector<Transform> Bag::transforms(const std::string& topic) const {
  return reading(file(), [&] {
    std::vector<Transform> transforms;
    for (const BagMessage& message : contents_->of(topic)) {
      const auto several = contents_->instance<tf2_msgs::TFMessage>(message);
      for (const auto& one : several.transforms) {
        transforms.push_back({header_of(one.header), one.child_frame_id,
                              xyz(one.transform.translation), xyzw(one.transform.rotation)});
      }
    }
    return transforms;
  });
}

}  // namespace nadir::ros1
