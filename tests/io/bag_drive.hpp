// SPDX-License-Identifier: Apache-2.0
#pragma once

// Frames, rigs and poses of nadir as the messages of a bag.

#include "io/bag_writer.hpp"
#include "nadir/core/sensors.hpp"

namespace nadir::test {

inline ros1::Image image_message(const Raster<std::uint8_t>& pixels, Stamp stamp,
                                 const std::string& frame) {
  const auto channels = static_cast<std::uint32_t>(pixels.channels());
  const auto width = static_cast<std::uint32_t>(pixels.width());
  return {{stamp.nanoseconds, frame},
          width,
          static_cast<std::uint32_t>(pixels.height()),
          width * channels,
          channels == 1 ? "mono8" : "rgb8",
          false,
          {pixels.values().begin(), pixels.values().end()}};
}

/// Of a rectified camera that stands `x_m` to the right of the left one.
inline ros1::CameraInfo info_message(const CameraModel& model, double x_m, Stamp stamp,
                                     const std::string& frame) {
  ros1::CameraInfo info;
  info.header = {stamp.nanoseconds, frame};
  info.width = static_cast<std::uint32_t>(model.width);
  info.height = static_cast<std::uint32_t>(model.height);
  info.distortion_model = "plumb_bob";
  info.d = {model.k1, model.k2, model.p1, model.p2, model.k3};
  info.k = {model.fx, 0, model.cx, 0, model.fy, model.cy, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {model.fx, 0, model.cx, -model.fx * x_m, 0, model.fy, model.cy, 0, 0, 0, 1, 0};
  return info;
}

template <class To, class From>
ros1::Transform transform_message(const Transform3<To, From>& pose, Stamp stamp,
                                  const std::string& frame, const std::string& child) {
  const Eigen::Quaterniond& q = pose.rotation;
  const Eigen::Vector3d& t = pose.translation;
  return {{stamp.nanoseconds, frame}, child, {t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

}  // namespace nadir::test
