// SPDX-License-Identifier: Apache-2.0
#include "cli/drive_options.hpp"

#include <CLI/CLI.hpp>
#include <map>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"

namespace nadir::cli {
namespace {

template <class Enum, std::size_t N>
void add_choice(CLI::App& verb, const std::string& flag, Enum& value,
                const std::array<std::pair<Enum, const char*>, N>& names,
                const std::string& description) {
  std::vector<std::string> allowed;
  for (const auto& [unused, name] : names) allowed.emplace_back(name);
  verb.add_option_function<std::string>(
          flag,
          [&value, &names](const std::string& text) {
            for (const auto& [candidate, name] : names) {
              if (text == name) value = candidate;
            }
          },
          description)
      ->check(CLI::IsMember(allowed));
}

void add_topics(CLI::App& verb, BagTopics& topics) {
  const auto add = [&](const char* flag, std::string& topic, const char* description) {
    verb.add_option(flag, topic, description)->type_name("TOPIC");
  };
  add("--left-topic", topics.left, "Bag: images of the left camera");
  add("--right-topic", topics.right, "Bag: images of the right camera");
  add("--points-topic", topics.points, "Bag: PointCloud2 of the lidar");
  add("--image-topic", topics.image, "Bag: images that colour the points");
  add("--odometry-topic", topics.odometry, "Bag: Odometry, or tf");
}

}  // namespace

void add_drive_options(CLI::App& verb, DriveOptionsOfVerb& options) {
  DriveReadOptions& reading = options.reading;
  verb.add_option("input", options.input, "Folder of a recorded drive, or a ROS 1 bag")
      ->type_name("INPUT")
      ->required();
  verb.add_option("--poses", reading.poses,
                  "Poses of the drive: TUM, KITTI (12 numbers) or EuRoC CSV (default: those in it)")
      ->type_name("FILE");
  add_choice(verb, "--pose-frame", reading.pose_frame, kPoseFrameNames,
             "Whose poses they are (default: KITTI camera, TUM robot, EuRoC body)");
  verb.add_option("--mounting", reading.mounting,
                  "Where the sensors stand on the robot (default: INPUT/mounting.yaml)")
      ->type_name("FILE");
  add_choice(verb, "--format", reading.format, kDriveFormatNames,
             "Layout of INPUT (default: told by what it holds)");
  add_choice(verb, "--sensor", reading.sensor, kDriveSensorNames,
             "Which sensor, where there are both (default: stereo)");
  verb.add_option("--first", reading.first, "First frame, from 0")->check(CLI::NonNegativeNumber);
  verb.add_option("--count", reading.count, "Frames to take (default: all)")
      ->check(CLI::PositiveNumber);
  verb.add_option("--every", options.every,
                  "A local map every so many metres driven (1m), seconds (0.5s) or frames (3f)")
      ->type_name("STEP")
      ->capture_default_str();
  verb.add_option("--size", options.size_m,
                  "Side of a local map, metres (local_map.size_x_m and size_y_m)")
      ->check(CLI::PositiveNumber);
  add_topics(verb, reading.topics);
}

Spacing parse_spacing(const std::string& text) {
  static const std::map<char, Spacing::Unit> units{
      {'m', Spacing::Unit::kMetres}, {'s', Spacing::Unit::kSeconds}, {'f', Spacing::Unit::kFrames}};
  Spacing spacing{0.0, Spacing::Unit::kFrames};
  std::string number = text;
  if (const auto unit = text.empty() ? units.end() : units.find(text.back()); unit != units.end()) {
    spacing.unit = unit->second;
    number.pop_back();
  }
  spacing.amount = parse_number(number, "--every");
  if (!(spacing.amount > 0.0)) {
    throw Error(ErrorKind::kUsage, "'" + text + "' is not above 0", "--every",
                "write 1m, 0.5s or 3f");
  }
  return spacing;
}

}  // namespace nadir::cli
