// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "nadir/core/stamp.hpp"

namespace nadir {

/// A topic of a ROS 1 bag.
struct BagTopic {
  std::string name;
  std::string type;  ///< "sensor_msgs/Image"
  std::size_t messages = 0;
  Stamp first;  ///< when it was recorded
  Stamp last;
};

/// By name. Throws Error (input) for a file that is missing or no bag, (usage) where this build
/// reads no bags.
std::vector<BagTopic> list_bag(const std::filesystem::path& file);

}  // namespace nadir
