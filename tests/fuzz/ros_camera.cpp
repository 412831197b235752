// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/bags/detail/rosbag_images.hpp"

// Two sensor_msgs/CameraInfo as they lie, with what their topics and lenses are called.
NADIR_FUZZ_TARGET(ros_camera) {
  using nadir::fuzz::taken;
  static constexpr std::array<const char*, 4> kTopics{"/left/image_raw", "/left/image_rect",
                                                      "/left/image_rect/compressed", "image"};
  static constexpr std::array<const char*, 4> kLenses{"plumb_bob", "", "rational_polynomial",
                                                      "equidistant"};
  const auto camera = [&] {
    nadir::ImageTopic topic;
    topic.name = kTopics.at(taken<std::uint8_t>(input) % kTopics.size());
    topic.info_name = "camera_info";
    nadir::ros1::CameraInfo& info = topic.info;
    info.distortion_model = kLenses.at(taken<std::uint8_t>(input) % kLenses.size());
    info.width = taken<std::uint32_t>(input);
    info.height = taken<std::uint32_t>(input);
    info.d.resize(taken<std::uint8_t>(input) % 15U);
    for (double& value : info.d) value = taken<float>(input);
    for (double& value : info.k) value = taken<float>(input);
    for (double& value : info.r) value = taken<float>(input);
    for (double& value : info.p) value = taken<float>(input);
    return topic;
  };
  nadir::StereoTopics topics;
  topics.left = camera();
  topics.right = camera();
  const nadir::StereoRig rig = nadir::stereo_rig_of(topics, "fuzz.bag");
  nadir::fuzz::require_pose(rig.right_from_left);
  nadir::fuzz::require(rig.left.width >= 0 && rig.left.height >= 0, "a size below 0");
}
