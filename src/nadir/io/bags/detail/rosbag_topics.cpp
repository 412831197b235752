// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/bags/detail/rosbag_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using ros1::Bag;
using ros1::Topic;
using Fits = std::function<bool(const Topic&)>;

bool is_image(const Topic& topic) {
  return topic.type == "sensor_msgs/Image" || topic.type == "sensor_msgs/CompressedImage";
}

bool is_cloud(const Topic& topic) { return topic.type == "sensor_msgs/PointCloud2"; }

bool is_side(const Topic& topic, const char* side, const char* number) {
  return is_image(topic) && (topic.name.find(side) != std::string::npos ||
                             topic.name.find(number) != std::string::npos);
}

bool is_left(const Topic& topic) { return is_side(topic, "left", "cam0"); }
bool is_right(const Topic& topic) { return is_side(topic, "right", "cam1"); }

std::vector<Topic> those(const Bag& bag, const Fits& fits) {
  std::vector<Topic> found;
  std::ranges::copy_if(bag.topics(), std::back_inserter(found), fits);
  return found;
}

/// What a topic is for and how to name it.
struct Purpose {
  const char* what;
  const char* flag;
  Fits is_of_type;  ///< what a topic that was asked for must be
  Fits fits;        ///< what one is looked for by
};

std::string found_topic(const Bag& bag, const std::string& asked, const Purpose& purpose) {
  const std::vector<Topic> of_type = those(bag, purpose.is_of_type);
  if (!asked.empty()) {
    if (std::ranges::find(of_type, asked, &Topic::name) != of_type.end()) return asked;
    throw input_error(bag.file(), fmt::format("has no {} {}", purpose.what, asked),
                      fmt::format("{} may be: {}", purpose.flag, list_of(of_type)));
  }
  const std::vector<Topic> fitting = those(bag, purpose.fits);
  if (fitting.size() == 1) return fitting.front().name;
  if (fitting.empty()) {
    throw input_error(bag.file(), fmt::format("no topic looks like {}", purpose.what),
                      fmt::format("give {}, one of: {}", purpose.flag, list_of(of_type)));
  }
  throw input_error(bag.file(), fmt::format("{} topics may be {}", fitting.size(), purpose.what),
                    fmt::format("give {}, one of: {}", purpose.flag, list_of(fitting)));
}

/// /stereo/left/image_raw/compressed -> image_raw, /stereo/left
std::pair<std::string, std::string> image_and_camera(std::string topic) {
  const auto cut_last = [&topic] {
    const std::size_t slash = topic.rfind('/');
    std::string last = topic.substr(slash == std::string::npos ? 0 : slash + 1);
    topic.resize(slash == std::string::npos ? 0 : slash);
    return last;
  };
  std::string image = cut_last();
  if (image == "compressed") image = cut_last();
  return {image, topic};
}

ImageTopic with_calibration(const Bag& bag, const std::string& topic) {
  const std::string info = image_and_camera(topic).second + "/camera_info";
  const auto is_info = [](const Topic& one) { return one.type == "sensor_msgs/CameraInfo"; };
  const std::vector<Topic> infos = those(bag, is_info);
  if (std::ranges::find(infos, info, &Topic::name) == infos.end()) {
    throw input_error(
        bag.file(), fmt::format("{} has no calibration: {} is missing", topic, info),
        fmt::format("record it with the images; camera_info there is: {}", list_of(infos)));
  }
  return {topic, bag.camera_info(info), info};
}

}  // namespace

bool ImageTopic::says_rectified() const {
  return image_and_camera(name).first.find("rect") != std::string::npos;
}

bool takes_stereo(const Bag& bag, const DriveReadOptions& options) {
  if (options.sensor != DriveSensor::kAuto) return options.sensor == DriveSensor::kStereo;
  const BagTopics& asked = options.topics;
  if (!asked.left.empty() || !asked.right.empty()) return true;
  if (!asked.points.empty()) return false;
  const bool pair = !those(bag, is_left).empty() && !those(bag, is_right).empty();
  return pair || those(bag, is_cloud).empty();
}

StereoTopics stereo_topics(const Bag& bag, const BagTopics& asked) {
  const std::string left = found_topic(
      bag, asked.left, {"the images of the left camera", "--left-topic", is_image, is_left});
  const std::string right = found_topic(
      bag, asked.right, {"the images of the right camera", "--right-topic", is_image, is_right});
  return {with_calibration(bag, left), with_calibration(bag, right)};
}

LidarTopics lidar_topics(const Bag& bag, const BagTopics& asked) {
  const std::string points = found_topic(
      bag, asked.points, {"the points of a lidar", "--points-topic", is_cloud, is_cloud});
  const std::string image = found_topic(
      bag, asked.image, {"the images that colour the points", "--image-topic", is_image, is_image});
  return {points, with_calibration(bag, image)};
}

bool is_odometry(const Topic& topic) { return topic.type == "nav_msgs/Odometry"; }

bool is_transforms(const Topic& topic) {
  return topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage";
}

std::string list_of(const std::vector<Topic>& topics) {
  std::string text;
  for (const Topic& topic : topics) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", topic.name, topic.type);
  }
  return text.empty() ? "none" : text;
}

}  // namespace nadir
