// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/bags/detail/rosbag_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "nadir/io/bags/detail/rosbag_topics.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using ros1::Bag;
using ros1::Topic;
using ros1::Transform;
using FramePair = std::pair<std::string, std::string>;  // parent, child

/// tf wrote "/base_link", tf2 writes "base_link".
std::string plain(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

bool is_static(const Topic& topic) { return topic.name.ends_with("tf_static"); }

bool same_place(const Transform& a, const Transform& b) {
  return a.translation == b.translation && a.rotation_xyzw == b.rotation_xyzw;
}

bool stands_still(const std::vector<Transform>& transforms) {
  return std::ranges::all_of(
      transforms, [&](const Transform& one) { return same_place(one, transforms.front()); });
}

std::map<FramePair, std::vector<Transform>> by_pair(const std::vector<Transform>& transforms) {
  std::map<FramePair, std::vector<Transform>> pairs;
  for (const Transform& one : transforms) {
    pairs[{plain(one.header.frame), plain(one.child)}].push_back(one);
  }
  return pairs;
}

template <class To, class From>
Transform3<To, From> rigid_of(const Transform& transform) {
  const auto& q = transform.rotation_xyzw;
  const auto& t = transform.translation;
  return {Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(), {t[0], t[1], t[2]}};
}

/// Of numbers that a robot can be at, and a rotation.
bool is_pose(const Transform& transform) {
  constexpr double kLengthOff = 1e-2;
  const auto& q = transform.rotation_xyzw;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const auto finite = [](double value) { return std::abs(value) <= kLargestNumber; };
  return std::abs(length - 1.0) < kLengthOff && std::ranges::all_of(transform.translation, finite);
}

/// Sorted by stamp, each stamp once; messages may arrive late or twice.
BagMotion motion_from(std::vector<Transform> transforms, const std::string& where) {
  BagMotion motion;
  motion.robot = plain(transforms.front().child);
  const std::size_t all = transforms.size();
  std::erase_if(transforms, [](const Transform& one) { return !is_pose(one); });
  if (transforms.empty()) {
    throw Error(ErrorKind::kInput, "none of its poses is finite with a rotation", where,
                "give --poses FILE");
  }
  const auto stamp_of = [](const Transform& one) { return one.header.stamp_ns; };
  std::ranges::stable_sort(transforms, {}, stamp_of);
  const auto same_time = [&](const Transform& a, const Transform& b) {
    return stamp_of(a) == stamp_of(b);
  };
  transforms.erase(std::unique(transforms.begin(), transforms.end(), same_time), transforms.end());
  if (const std::size_t lost = all - transforms.size(); lost > 0) {
    motion.notes.push_back(
        fmt::format("{}: {} of {} poses have the stamp of another, or are none, and are left out",
                    where, lost, all));
  }
  for (const Transform& one : transforms) {
    motion.poses.poses.push_back(
        {Stamp{stamp_of(one)}, rigid_of<frames::PoseWorld, frames::PoseSensor>(one), where});
  }
  return motion;
}

std::optional<BagMotion> motion_of_tf(const Bag& bag, const std::vector<Topic>& topics) {
  std::vector<Transform> transforms;
  for (const Topic& topic : topics) {
    if (is_static(topic)) continue;
    std::ranges::move(bag.transforms(topic.name), std::back_inserter(transforms));
  }
  auto pairs = by_pair(transforms);
  const auto of_odom = [](const auto& entry) { return entry.first.first == "odom"; };
  const bool odom = std::ranges::any_of(pairs, of_odom);
  std::erase_if(pairs, [&](const auto& entry) {
    return odom ? !of_odom(entry) : stands_still(entry.second);
  });
  if (pairs.empty()) return std::nullopt;
  std::string names;
  for (const auto& [pair, unused] : pairs) {
    names += fmt::format("{}{} -> {}", names.empty() ? "" : ", ", pair.first, pair.second);
  }
  if (pairs.size() > 1) {
    throw input_error(bag.file(), fmt::format("tf moves several frames: {}", names),
                      "record Odometry, or give --poses FILE");
  }
  BagMotion motion =
      motion_from(std::move(pairs.begin()->second), bag.file().string() + ": tf " + names);
  if (!odom) motion.notes.push_back("no odometry in the bag: poses are those of tf, " + names);
  return motion;
}

}  // namespace

std::optional<BagMotion> motion_of(const Bag& bag, const std::string& asked) {
  std::vector<Topic> odometry;
  std::vector<Topic> tf;
  std::ranges::copy_if(bag.topics(), std::back_inserter(odometry), is_odometry);
  std::ranges::copy_if(bag.topics(), std::back_inserter(tf), is_transforms);
  if (!asked.empty()) {
    std::erase_if(odometry, [&](const Topic& topic) { return topic.name != asked; });
    std::erase_if(tf, [&](const Topic& topic) { return topic.name != asked; });
    if (odometry.empty() && tf.empty()) {
      throw input_error(bag.file(), "has no odometry " + asked,
                        "--odometry-topic may be an Odometry or tf of: " + list_of(bag.topics()));
    }
  }
  if (odometry.size() > 1) {
    throw input_error(bag.file(), fmt::format("{} topics may be the odometry", odometry.size()),
                      "give --odometry-topic, one of: " + list_of(odometry));
  }
  if (odometry.empty()) return motion_of_tf(bag, tf);
  const std::string& name = odometry.front().name;
  return motion_from(bag.odometry(name), bag.file().string() + ": " + name);
}

FixedFrames::FixedFrames(const Bag& bag) {
  for (const Topic& topic : bag.topics()) {
    if (!is_transforms(topic)) continue;
    for (const auto& [pair, transforms] : by_pair(bag.transforms(topic.name))) {
      if (!is_pose(transforms.back()) || (!is_static(topic) && !stands_still(transforms))) continue;
      parents_[pair.second] = {pair.first, rigid_of<Anywhere, Anywhere>(transforms.back())};
    }
  }
}

std::vector<FixedFrames::Ancestor> FixedFrames::ancestors(const std::string& frame) const {
  std::vector<Ancestor> found{{plain(frame), {}}};
  // A ring of frames would lead round for ever.
  while (found.size() <= parents_.size()) {
    const auto parent = parents_.find(found.back().frame);
    if (parent == parents_.end()) break;
    found.push_back({parent->second.frame,
                     parent->second.parent_from_child * found.back().ancestor_from_start});
  }
  return found;
}

std::optional<FixedFrames::Step> FixedFrames::chain(const std::string& target,
                                                    const std::string& source) const {
  const std::vector<Ancestor> of_target = ancestors(target);
  for (const Ancestor& ancestor : ancestors(source)) {
    const auto shared = std::ranges::find(of_target, ancestor.frame, &Ancestor::frame);
    if (shared == of_target.end()) continue;
    return shared->ancestor_from_start.inverse() * ancestor.ancestor_from_start;
  }
  return std::nullopt;
}

}  // namespace nadir
