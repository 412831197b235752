// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "nadir/io/bags/detail/ros1.hpp"
#include "nadir/io/drives/drive_reader.hpp"

namespace nadir {

/// A topic of images and the calibration beside it.
struct ImageTopic {
  std::string name;
  ros1::CameraInfo info;
  std::string info_name;

  /// Whether its name says that the images are rectified: image_rect, image_rect_color.
  bool says_rectified() const;
};

struct StereoTopics {
  ImageTopic left;
  ImageTopic right;
};
struct LidarTopics {
  std::string points;
  ImageTopic image;
};

// Of a bag, as asked for or the only ones that fit. All throw Error (input) that lists the topics
// there are, for one that is not there or is of another type, or where several fit.

/// Whether to take the pair of cameras: where it is there and the lidar is not asked for.
bool takes_stereo(const ros1::Bag& bag, const DriveReadOptions& options);
StereoTopics stereo_topics(const ros1::Bag& bag, const BagTopics& asked);
LidarTopics lidar_topics(const ros1::Bag& bag, const BagTopics& asked);

bool is_odometry(const ros1::Topic& topic);
bool is_transforms(const ros1::Topic& topic);

/// The topics that hold, "name (type), name (type)"; "none" where none does.
std::string list_of(const std::vector<ros1::Topic>& topics);

}  // namespace nadir
