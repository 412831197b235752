// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "nadir/core/sensors.hpp"
#include "nadir/io/bags/detail/ros1.hpp"
#include "nadir/io/bags/detail/rosbag_topics.hpp"
#include "nadir/io/drives/point_cloud.hpp"

namespace nadir {

/// The camera that took the images: of rectified ones the projection P, else K and D. Throws Error
/// (input) for a lens that is no pinhole with radial-tangential distortion. `where` names the bag.
CameraModel camera_of(const ImageTopic& topic, const std::string& where);

/// The rig of two cameras, robot_from_left aside; the right one's P says how far apart they are.
/// Images are taken as rectified where both topics say so, or where there is nothing to rectify.
/// Throws Error (input) as check_rig does.
StereoRig stereo_rig_of(const StereoTopics& topics, const std::string& where);

/// The pixels as grey or RGB. Throw Error (input) for an encoding that has none of 8 bits or is not
/// known, and for a message that is cut off. `where` names bag, topic and message.
Raster<std::uint8_t> pixels_of(ros1::Image image, const std::string& where);
PointCloud points_of(const ros1::PointCloud& message, const std::string& where);

}  // namespace nadir
