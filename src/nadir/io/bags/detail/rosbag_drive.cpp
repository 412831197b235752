// SPDX-License-Identifier: Apache-2.0
// ROS 1 bags as drives. nadir/io/bags/detail/rosbag_absent.cpp stands in where they are not built.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "nadir/io/bags/bag_topics.hpp"
#include "nadir/io/bags/detail/rosbag_images.hpp"
#include "nadir/io/bags/detail/rosbag_motion.hpp"
#include "nadir/io/bags/detail/rosbag_topics.hpp"
#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;
using BagPointer = std::shared_ptr<const ros1::Bag>;

/// Two messages that belong together, by their numbers.
struct Pair {
  std::int64_t stamp_ns = 0;  ///< of the first
  std::size_t first = 0;
  std::size_t second = 0;
};

struct StampedNumber {
  std::int64_t stamp_ns = 0;
  std::size_t number = 0;
};

std::vector<StampedNumber> by_stamp(const ros1::Bag& bag, const std::string& topic) {
  std::vector<StampedNumber> numbers;
  for (const ros1::Header& header : bag.headers(topic)) {
    numbers.push_back({header.stamp_ns, numbers.size()});
  }
  std::ranges::stable_sort(numbers, {}, &StampedNumber::stamp_ns);
  const auto same_time = [](const StampedNumber& a, const StampedNumber& b) {
    return a.stamp_ns == b.stamp_ns;
  };
  numbers.erase(std::unique(numbers.begin(), numbers.end(), same_time), numbers.end());
  return numbers;
}

/// Each of the first topic with the nearest of the second that is at most so far away in time.
std::vector<Pair> paired_by_stamp(const ros1::Bag& bag, const std::string& first_topic,
                                  const std::string& second_topic, std::int64_t farthest_ns,
                                  std::vector<std::string>& notes) {
  const std::vector<StampedNumber> first = by_stamp(bag, first_topic);
  const std::vector<StampedNumber> second = by_stamp(bag, second_topic);
  std::vector<Pair> pairs;
  for (const StampedNumber& one : first) {
    const auto away = [&](const StampedNumber& other) {
      return std::abs(other.stamp_ns - one.stamp_ns);
    };
    auto nearest = std::ranges::lower_bound(second, one.stamp_ns, {}, &StampedNumber::stamp_ns);
    if (nearest == second.end() ||
        (nearest != second.begin() && away(*std::prev(nearest)) <= away(*nearest))) {
      --nearest;
    }
    if (away(*nearest) <= farthest_ns) pairs.push_back({one.stamp_ns, one.number, nearest->number});
  }
  if (pairs.empty()) {
    throw input_error(
        bag.file(),
        fmt::format("no message of {} is within {} s of one of {}: the first are of {} and {} s",
                    first_topic, to_string(Stamp{farthest_ns}), second_topic,
                    to_string(Stamp{first.front().stamp_ns}),
                    to_string(Stamp{second.front().stamp_ns})),
        "give topics whose headers share one clock");
  }
  const std::size_t messages =
      std::ranges::find(bag.topics(), first_topic, &ros1::Topic::name)->messages;
  if (const std::size_t alone = messages - pairs.size(); alone > 0) {
    notes.push_back(fmt::format("{} of {} messages of {} have no partner in {} and are left out",
                                alone, messages, first_topic, second_topic));
  }
  return pairs;
}

void take_frames(const std::vector<Pair>& pairs, Drive& drive) {
  for (const Pair& pair : pairs) {
    drive.frames.push_back({static_cast<int>(drive.frames.size()), {pair.stamp_ns}, {}});
  }
}

std::string place_in_bag(const ros1::Bag& bag, const std::string& topic, std::size_t number) {
  return fmt::format("{}: {}[{}]", bag.file().string(), topic, number);
}

Raster<std::uint8_t> read_pixels(const ros1::Bag& bag, const std::string& topic,
                                 std::size_t number) {
  return pixels_of(bag.image(topic, number), place_in_bag(bag, topic, number));
}

/// What is not said about the mounting, tf may know.
Mounting completed(Mounting mounting, const ros1::Bag& bag, const std::string& robot,
                   const std::string& camera, const std::string& lidar) {
  const FixedFrames fixed(bag);
  if (!mounting.robot_from_camera) {
    mounting.robot_from_camera = fixed.between<frames::Robot, frames::Camera>(robot, camera);
  }
  if (!mounting.robot_from_lidar && !lidar.empty()) {
    mounting.robot_from_lidar = fixed.between<frames::Robot, frames::Lidar>(robot, lidar);
  }
  return mounting;
}

/// Sizes that camera_info leaves open.
void take_size(CameraModel& model, const Raster<std::uint8_t>& image) {
  if (model.width > 0 && model.height > 0) return;
  model.width = image.width();
  model.height = image.height();
}

OpenedLayout stereo_of(const BagPointer& bag, const BagTopics& asked, const std::string& robot,
                       const Mounting& given) {
  constexpr std::int64_t kFarthestNs = 2'000'000;  // cameras that are triggered together
  const StereoTopics topics = stereo_topics(*bag, asked);
  StereoRig rig = stereo_rig_of(topics, bag->file().string());
  OpenedLayout layout;
  const std::string& camera = topics.left.info.header.frame;
  const Mounting mounting = completed(given, *bag, robot, camera, {});
  if (!mounting.robot_from_camera) {
    layout.drive.notes.push_back(
        fmt::format("tf does not say where '{}' stands on '{}', and no mounting is given: it is "
                    "taken as level, looking ahead, at the origin of the robot",
                    camera, robot));
  }
  rig.robot_from_left = mounting.robot_from_camera.value_or(default_robot_from_camera());
  layout.robot_from_pose_camera = rig.robot_from_left;
  const std::vector<Pair> pairs =
      paired_by_stamp(*bag, topics.left.name, topics.right.name, kFarthestNs, layout.drive.notes);
  take_frames(pairs, layout.drive);
  const Raster<std::uint8_t> image = read_pixels(*bag, topics.left.name, pairs.front().first);
  take_size(rig.left, image);
  take_size(rig.right, image);
  layout.drive.read_stereo = [=, left = topics.left.name,
                              right = topics.right.name](const DriveFrame& frame) {
    const Pair& pair = pairs.at(static_cast<std::size_t>(frame.number));
    StereoFrame stereo{frame.stamp, read_pixels(*bag, left, pair.first),
                       read_pixels(*bag, right, pair.second)};
    check_pair(stereo, rig, place_in_bag(*bag, left, pair.first),
               place_in_bag(*bag, right, pair.second));
    return stereo;
  };
  layout.drive.rig = std::move(rig);
  return layout;
}

LidarFrame read_sweep(const ros1::Bag& bag, const LidarTopics& topics, const CameraModel& model,
                      const Pair& pair, std::vector<std::string>& notes) {
  const std::string sweep = place_in_bag(bag, topics.points, pair.first);
  PointCloud cloud = points_of(bag.cloud(topics.points, pair.first), sweep);
  if (2 * cloud.invalid > cloud.points.size()) {
    notes.push_back(fmt::format("{}: {} points are NaN, infinite or zero, {} are left", sweep,
                                cloud.invalid, cloud.points.size()));
  }
  LidarFrame lidar{{pair.stamp_ns}, std::move(cloud.points), {}};
  lidar.images.push_back(read_pixels(bag, topics.image.name, pair.second));
  const auto& image = lidar.images.back();
  if (image.width() == model.width && image.height() == model.height) return lidar;
  throw Error(ErrorKind::kInput,
              fmt::format("is {} x {} pixels, the calibration says {} x {}", image.width(),
                          image.height(), model.width, model.height),
              place_in_bag(bag, topics.image.name, pair.second),
              "give the calibration of these images");
}

OpenedLayout lidar_of(const BagPointer& bag, const BagTopics& asked, const std::string& robot,
                      const Mounting& given) {
  constexpr std::int64_t kFarthestNs = 50'000'000;  // half a turn of a lidar at 10 Hz
  const LidarTopics topics = lidar_topics(*bag, asked);
  const std::string& camera = topics.image.info.header.frame;
  const std::string lidar = bag->cloud(topics.points, 0).header.frame;
  const Mounting mounting = completed(given, *bag, robot, camera, lidar);
  if (!mounting.robot_from_camera || !mounting.robot_from_lidar) {
    throw input_error(bag->file(),
                      fmt::format("neither tf nor a mounting says where '{}' stands on '{}'",
                                  mounting.robot_from_lidar ? camera : lidar, robot),
                      "give --mounting FILE with robot_from_lidar and robot_from_camera, or record "
                      "tf_static");
  }
  OpenedLayout layout;
  layout.robot_from_pose_camera = *mounting.robot_from_camera;
  CameraModel model = camera_of(topics.image, bag->file().string());
  const std::vector<Pair> pairs =
      paired_by_stamp(*bag, topics.points, topics.image.name, kFarthestNs, layout.drive.notes);
  take_frames(pairs, layout.drive);
  take_size(model, read_pixels(*bag, topics.image.name, pairs.front().second));
  layout.drive.rig = LidarRig{*mounting.robot_from_lidar, {{model, *mounting.robot_from_camera}}};
  layout.drive.read_lidar = [=](const DriveFrame& frame, std::vector<std::string>& notes) {
    return read_sweep(*bag, topics, model, pairs.at(static_cast<std::size_t>(frame.number)), notes);
  };
  return layout;
}

}  // namespace

OpenedLayout open_rosbag(const path& file, const Mounting& mounting,
                         const DriveReadOptions& options) {
  const auto bag = std::make_shared<const ros1::Bag>(file);
  const bool other_poses = !options.poses.empty();
  std::optional<BagMotion> motion;
  if (!other_poses || !options.topics.odometry.empty()) {
    motion = motion_of(*bag, options.topics.odometry);
  }
  const std::string robot = motion ? motion->robot : "base_link";
  OpenedLayout layout = takes_stereo(*bag, options)
                            ? stereo_of(bag, options.topics, robot, mounting)
                            : lidar_of(bag, options.topics, robot, mounting);
  layout.drive.inputs.push_back(file);
  if (motion) {
    std::ranges::move(motion->notes, std::back_inserter(layout.drive.notes));
    layout.recorded_poses = std::move(motion->poses);
  }
  return layout;
}

std::vector<BagTopic> list_bag(const path& file) {
  const ros1::Bag bag(file);
  std::vector<BagTopic> topics;
  for (const ros1::Topic& topic : bag.topics()) {
    topics.push_back({topic.name, topic.type, topic.messages, {topic.first_ns}, {topic.last_ns}});
  }
  return topics;
}

}  // namespace nadir
