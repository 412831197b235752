// SPDX-License-Identifier: Apache-2.0
// Compiled as C++17: ros1.hpp says why.
#include "nadir/io/detail/ros1.hpp"

#include <console_bridge/console.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <fstream>
#include <map>
#include <string_view>

#include "nadir/io/detail/bag_check.hpp"
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

/// rosbag's own words for other files are of little help.
void check_is_bag(const std::filesystem::path& file) {
  constexpr std::string_view kBegin = "#ROSBAG V";
  std::string begin(kBegin.size(), '\0');
  std::ifstream(file, std::ios::binary)
      .read(begin.data(), static_cast<std::streamsize>(kBegin.size()));
  if (begin != kBegin) {
    throw input_error(file, "is no ROS 1 bag", "convert a bag of ROS 2 with `rosbags-convert`");
  }
}

/// What rosbag throws, as the Error of a bad file.
template <class Action>
auto reading(const std::filesystem::path& file, const Action& action) {
  const char* const copy_again =
      "copy the bag again, or run `rosbag fix` or `rosbag reindex` on it";
  try {
    return action();
  } catch (const rosbag::BagUnindexedException&) {
    throw input_error(file, "has no index: the recording was cut off",
                      "run `rosbag reindex` on it");
  } catch (const rosbag::BagFormatException& exception) {
    throw input_error(file, std::string("is damaged: ") + exception.what(), copy_again);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& exception) {  // of rosbag, of the messages, of boost
    throw input_error(file, std::string("cannot be read: ") + exception.what(), copy_again);
  }
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

std::vector<std::uint8_t> bytes_of(const rosbag::MessageInstance& message) {
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream out(bytes.data(), message.size());
  message.write(out);
  return bytes;
}

}  // namespace

struct Bag::Contents {
  std::filesystem::path file;
  rosbag::Bag bag;
  std::vector<Topic> topics;
  std::map<std::string, std::vector<rosbag::MessageInstance>> messages;

  void open();
  const std::vector<rosbag::MessageInstance>& of(const std::string& topic) const;

  template <class Message>
  boost::shared_ptr<Message> instance(const rosbag::MessageInstance& message) const;
  template <class Message>
  boost::shared_ptr<Message> instance(const std::string& topic, std::size_t number) const;
};

void Bag::Contents::open() {
  bag.open(file.string(), rosbag::bagmode::Read);
  rosbag::View view(bag);
  std::map<std::string, Topic> by_name;
  for (const rosbag::MessageInstance& message : view) {
    const std::int64_t recorded = nanoseconds(message.getTime());
    Topic& topic = by_name[message.getTopic()];
    if (topic.messages == 0) {
      topic = {message.getTopic(), message.getDataType(), 0, recorded, recorded};
    }
    ++topic.messages;
    topic.last_ns = recorded;
    messages[topic.name].push_back(message);
  }
  for (const auto& entry : by_name) topics.push_back(entry.second);
}

const std::vector<rosbag::MessageInstance>& Bag::Contents::of(const std::string& topic) const {
  const auto found = messages.find(topic);
  if (found == messages.end()) throw input_error(file, "has no topic " + topic);
  return found->second;
}

/// As MessageInstance::instantiate does, once the message is known to hold what it declares: the
/// lists of a message are made as long as they say before they are read.
template <class Message>
boost::shared_ptr<Message> Bag::Contents::instance(const rosbag::MessageInstance& message) const {
  if (!message.isType<Message>()) {
    throw input_error(file, message.getTopic() + " is of type " + message.getDataType() + ", not " +
                                ros::message_traits::DataType<Message>::value());
  }
  std::vector<std::uint8_t> bytes = bytes_of(message);
  if (!has_layout({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                  layout_of<Message>())) {
    throw input_error(file, "a message of " + message.getTopic() + " is damaged",
                      "leave it out with --first and --count");
  }
  boost::shared_ptr<Message> result(new Message);
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, *result);
  return result;
}

template <class Message>
boost::shared_ptr<Message> Bag::Contents::instance(const std::string& topic,
                                                   std::size_t number) const {
  return instance<Message>(of(topic).at(number));
}

Bag::Bag(const std::filesystem::path& file) : contents_(std::make_unique<Contents>()) {
  console_bridge::noOutputHandler();  // rosbag's own words on the terminal
  check_input_file(file);
  check_is_bag(file);
  check_bag_structure(file);
  contents_->file = file;
  reading(file, [&] { contents_->open(); });
}

Bag::~Bag() = default;

const std::filesystem::path& Bag::file() const { return contents_->file; }

const std::vector<Topic>& Bag::topics() const { return contents_->topics; }

std::vector<Header> Bag::headers(const std::string& topic) const {
  return reading(file(), [&] {
    std::vector<Header> headers;
    for (const rosbag::MessageInstance& message : contents_->of(topic)) {
      std::vector<std::uint8_t> bytes = bytes_of(message);
      if (!has_layout({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, kHeaderLayout)) {
        throw input_error(file(), "a message of " + topic + " begins with no header");
      }
      ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      std_msgs::Header header;
      ros::serialization::deserialize(in, header);
      headers.push_back(header_of(header));
    }
    return headers;
  });
}

Image Bag::image(const std::string& topic, std::size_t number) const {
  return reading(file(), [&]() -> Image {
    const rosbag::MessageInstance& message = contents_->of(topic).at(number);
    if (message.isType<sensor_msgs::CompressedImage>()) {
      const auto compressed = contents_->instance<sensor_msgs::CompressedImage>(message);
      return {header_of(compressed->header), 0, 0, 0, compressed->format, true,
              text_of(compressed->data)};
    }
    const auto image = contents_->instance<sensor_msgs::Image>(message);
    return {header_of(image->header), image->width, image->height,       image->step,
            image->encoding,          false,        text_of(image->data)};
  });
}

CameraInfo Bag::camera_info(const std::string& topic) const {
  return reading(file(), [&]() -> CameraInfo {
    const auto info = contents_->instance<sensor_msgs::CameraInfo>(topic, 0);
    return {header_of(info->header),
            info->width,
            info->height,
            info->distortion_model,
            info->D,
            array_of<9>(info->K),
            array_of<9>(info->R),
            array_of<12>(info->P)};
  });
}

PointCloud Bag::cloud(const std::string& topic, std::size_t number) const {
  return reading(file(), [&] {
    const auto message = contents_->instance<sensor_msgs::PointCloud2>(topic, number);
    PointCloud cloud{header_of(message->header),
                     message->width,
                     message->height,
                     message->point_step,
                     message->row_step,
                     message->is_bigendian != 0,
                     {},
                     text_of(message->data)};
    for (const auto& field : message->fields) {
      cloud.fields.push_back({field.name, field.offset, field.datatype, field.count});
    }
    return cloud;
  });
}

std::vector<Transform> Bag::odometry(const std::string& topic) const {
  return reading(file(), [&] {
    std::vector<Transform> poses;
    for (const rosbag::MessageInstance& message : contents_->of(topic)) {
      const auto odometry = contents_->instance<nav_msgs::Odometry>(message);
      const auto& pose = odometry->pose.pose;
      poses.push_back({header_of(odometry->header), odometry->child_frame_id, xyz(pose.position),
                       xyzw(pose.orientation)});
    }
    return poses;
  });
}

std::vector<Transform> Bag::transforms(const std::string& topic) const {
  return reading(file(), [&] {
    std::vector<Transform> transforms;
    for (const rosbag::MessageInstance& message : contents_->of(topic)) {
      const auto several = contents_->instance<tf2_msgs::TFMessage>(message);
      for (const auto& one : several->transforms) {
        transforms.push_back({header_of(one.header), one.child_frame_id,
                              xyz(one.transform.translation), xyzw(one.transform.rotation)});
      }
    }
    return transforms;
  });
}

}  // namespace nadir::ros1
