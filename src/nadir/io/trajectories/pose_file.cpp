// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/trajectories/pose_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/trajectories/detail/nine_decimals.hpp"

namespace nadir {
namespace {

using Words = std::vector<std::string_view>;
using WorldPose = Transform3<frames::PoseWorld, frames::PoseSensor>;

constexpr std::size_t kTumWords = 8;
constexpr std::size_t kKittiWords = 12;
constexpr std::size_t kEurocWords = 8;  ///< and velocities and biases after them

Error line_error(const std::string& where, const std::string& problem, const std::string& remedy) {
  return {ErrorKind::kInput, problem, where, remedy};
}

std::vector<double> numbers_of(const Words& words, std::size_t first, std::size_t count,
                               const std::string& where) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < first + count; ++i) {
    numbers.push_back(number_in_file(words[i], fmt::format("value {}", i + 1), where));
  }
  return numbers;
}

Eigen::Quaterniond unit_quaternion(double x, double y, double z, double w,
                                   const std::string& where) {
  constexpr double kAllowed = 1e-2;
  const Eigen::Quaterniond q(w, x, y, z);
  if (std::abs(q.norm() - 1.0) > kAllowed) {
    throw line_error(
        where,
        fmt::format("the quaternion has the length {:.6g}, not 1, and is no rotation", q.norm()),
        "give qx qy qz qw of unit length");
  }
  return q.normalized();
}

FilePose tum_pose(const std::string& where, const Words& words) {
  const auto stamp = parse_stamp(words[0]);
  if (!stamp) {
    throw line_error(where,
                     fmt::format("timestamp is '{}', which is not a number of seconds", words[0]),
                     "correct the line");
  }
  const std::vector<double> v = numbers_of(words, 1, 7, where);
  return {*stamp, {unit_quaternion(v[3], v[4], v[5], v[6], where), {v[0], v[1], v[2]}}, where};
}

FilePose euroc_pose(const std::string& where, const Words& words) {
  Stamp stamp;
  const auto [end, error] =
      std::from_chars(words[0].data(), words[0].data() + words[0].size(), stamp.nanoseconds);
  if (error != std::errc{} || end != words[0].data() + words[0].size() || !is_near_epoch(stamp)) {
    throw line_error(
        where,
        fmt::format("timestamp is '{}', which is not whole nanoseconds of this age", words[0]),
        "correct the line");
  }
  const std::vector<double> v = numbers_of(words, 1, 7, where);
  return {stamp, {unit_quaternion(v[4], v[5], v[6], v[3], where), {v[0], v[1], v[2]}}, where};
}

FilePose kitti_pose(const std::string& where, const Words& words) {
  const std::vector<double> v = numbers_of(words, 0, kKittiWords, where);
  Eigen::Matrix3d rotation;
  rotation << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  constexpr double kAllowed = 1e-3;
  const double skew =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (std::abs(rotation.determinant() - 1.0) > kAllowed || skew > kAllowed) {
    throw line_error(where,
                     fmt::format("its 3x3 part is no rotation: det {:.6g}, |R R^T - I| {:.3g}",
                                 rotation.determinant(), skew),
                     "a line is a 3x4 matrix by rows, R and t in turn");
  }
  return {std::nullopt, {Eigen::Quaterniond(rotation).normalized(), {v[3], v[7], v[11]}}, where};
}

PoseFileKind kind_of(const std::string& where, const Words& words, bool commas) {
  if (commas && words.size() >= kEurocWords) return PoseFileKind::kEuroc;
  if (!commas && words.size() == kTumWords) return PoseFileKind::kTum;
  if (!commas && words.size() == kKittiWords) return PoseFileKind::kKitti;
  throw line_error(where, fmt::format("{} values are no pose", words.size()),
                   "give TUM (t tx ty tz qx qy qz qw), KITTI (12 numbers) or EuRoC CSV");
}

FilePose parse(PoseFileKind kind, const std::string& where, const Words& words) {
  const bool fits = kind == PoseFileKind::kEuroc
                        ? words.size() >= kEurocWords
                        : words.size() == (kind == PoseFileKind::kTum ? kTumWords : kKittiWords);
  if (!fits) {
    throw line_error(where, fmt::format("{} values, unlike the lines before", words.size()),
                     "every line must have the same form");
  }
  if (kind == PoseFileKind::kTum) return tum_pose(where, words);
  return kind == PoseFileKind::kEuroc ? euroc_pose(where, words) : kitti_pose(where, words);
}

/// Nine decimals; a number that rounds to zero carries no sign.
}  // namespace

PoseFile read_pose_file(const std::filesystem::path& path) {
  std::string text = read_file(path);
  const bool commas = text.find(',') != std::string::npos;
  std::replace(text.begin(), text.end(), ',', ' ');
  PoseFile file;
  for_each_line(path, text, [&](const std::string& where, const Words& words) {
    if (file.poses.empty()) file.kind = kind_of(where, words, commas);
    file.poses.push_back(parse(file.kind, where, words));
    if (!file.poses.back().stamp || file.poses.size() < 2) return;
    const Stamp before = *file.poses[file.poses.size() - 2].stamp;
    if (*file.poses.back().stamp <= before) {
      throw line_error(where,
                       fmt::format("timestamp {} does not follow {}", words[0], to_string(before)),
                       "sort the lines by time and remove duplicates");
    }
  });
  if (file.poses.empty()) throw input_error(path, "holds no pose", "give a file of poses");
  return file;
}

void write_tum(const std::filesystem::path& path, const std::vector<StampedOdomPose3>& poses) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto& [stamp, pose] = poses[i];
    if (!pose.is_finite() || (i > 0 && stamp <= poses[i - 1].stamp)) {
      throw Error(ErrorKind::kProcessing,
                  fmt::format("the pose at {} s is not finite or not later than the one before",
                              to_string(stamp)),
                  path.string());
    }
    Eigen::Quaterniond q = pose.rotation;
    if (q.w() < 0.0) q.coeffs() *= -1.0;
    text += to_string(stamp);
    for (const double value : {pose.translation.x(), pose.translation.y(), pose.translation.z(),
                               q.x(), q.y(), q.z(), q.w()}) {
      text += " " + nine_decimals(value);
    }
    text += "\n";
  }
  write_file(path, text);
}

void write_kitti_poses(const std::filesystem::path& path, const std::vector<WorldPose>& poses) {
  std::string text;
  for (const WorldPose& pose : poses) {
    const Eigen::Matrix3d r = pose.rotation.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      text += fmt::format("{}{:.12e} {:.12e} {:.12e} {:.12e}", row == 0 ? "" : " ", r(row, 0),
                          r(row, 1), r(row, 2), pose.translation(row));
    }
    text += "\n";
  }
  write_file(path, text);
}

}  // namespace nadir
