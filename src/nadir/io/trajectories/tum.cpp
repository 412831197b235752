// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/trajectories/tum.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/trajectories/detail/nine_decimals.hpp"

namespace nadir {
namespace {

constexpr const char* kHeader = "# timestamp tx ty tz qx qy qz qw\n";
constexpr std::array<const char*, 8> kFields{"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// The heading of the turned x axis in the plane; the quaternion need not be normalised.
double yaw_of(double x, double y, double z, double w, const std::string& where) {
  constexpr double kSmallest = 1e-6;
  const double squared_length = x * x + y * y + z * z + w * w;
  if (squared_length < kSmallest) {
    throw Error(ErrorKind::kInput, "the quaternion is zero, which is no orientation", where,
                "correct the line");
  }
  const double sine = 2.0 * (w * z + x * y);
  const double cosine = w * w + x * x - y * y - z * z;
  if (std::hypot(sine, cosine) < kSmallest * squared_length) {
    throw Error(ErrorKind::kInput, "the x axis points straight up or down and has no heading",
                where, "give poses of the robot (x forward, z up), not of a camera");
  }
  return wrap_angle(std::atan2(sine, cosine));
}

template <class In>
StampedPose<In> parse_line(const std::string& where, const std::vector<std::string_view>& words) {
  if (words.size() != kFields.size()) {
    throw Error(ErrorKind::kInput, fmt::format("{} values instead of 8", words.size()), where,
                "a line is `t tx ty tz qx qy qz qw`, separated by spaces");
  }
  const auto stamp = parse_stamp(words[0]);
  if (!stamp) {
    throw Error(ErrorKind::kInput,
                fmt::format("timestamp is '{}', which is not a number of seconds", words[0]), where,
                "correct the line");
  }
  std::array<double, 8> values{};
  for (std::size_t i = 1; i < values.size(); ++i) {
    values[i] = number_in_file(words[i], kFields[i], where);
  }
  return {*stamp,
          {values[1], values[2], yaw_of(values[4], values[5], values[6], values[7], where)}};
}

template <class In>
TrajectoryIn<In> read(const std::filesystem::path& path) {
  TrajectoryIn<In> trajectory;
  for_each_line(path, read_file(path), [&](const std::string& where, const auto& words) {
    trajectory.push_back(parse_line<In>(where, words));
    const std::size_t count = trajectory.size();
    if (count > 1 && trajectory[count - 1].stamp <= trajectory[count - 2].stamp) {
      throw Error(ErrorKind::kInput,
                  fmt::format("timestamp {} does not follow {}", words[0],
                              to_string(trajectory[count - 2].stamp)),
                  where, "sort the lines by time and remove duplicates");
    }
  });
  return trajectory;
}

/// Nine decimals; a number that rounds to zero carries no sign.
template <class In>
void write(const std::filesystem::path& path, const TrajectoryIn<In>& trajectory) {
  std::string text = kHeader;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto& [stamp, pose] = trajectory[i];
    if (!pose.is_finite() || (i > 0 && stamp <= trajectory[i - 1].stamp)) {
      throw Error(ErrorKind::kProcessing,
                  fmt::format("the pose at {} s is not finite or not later than the one before",
                              to_string(stamp)),
                  path.string());
    }
    const double half = wrap_angle(pose.yaw) / 2.0;
    text += fmt::format("{} {} {} 0 0 0 {} {}\n", to_string(stamp), nine_decimals(pose.x),
                        nine_decimals(pose.y), nine_decimals(std::sin(half)),
                        nine_decimals(std::cos(half)));
  }
  write_file(path, text);
}

}  // namespace

Trajectory read_tum(const std::filesystem::path& path) { return read<frames::Map>(path); }

Odometry read_tum_odometry(const std::filesystem::path& path) { return read<frames::Odom>(path); }

void write_tum(const std::filesystem::path& path, const Trajectory& trajectory) {
  write<frames::Map>(path, trajectory);
}

void write_tum(const std::filesystem::path& path, const Odometry& odometry) {
  write<frames::Odom>(path, odometry);
}

}  // namespace nadir
