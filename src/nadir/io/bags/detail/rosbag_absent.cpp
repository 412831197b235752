// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/error.hpp"
#include "nadir/io/bags/bag_topics.hpp"
#include "nadir/io/drives/detail/drive_layout.hpp"

namespace nadir {
namespace {

Error absent(const std::filesystem::path& file) {
  return {
      ErrorKind::kUsage, "this build reads no ROS bags", file.string(),
      "install libroscpp-core-dev libsensor-msgs-dev libnav-msgs-dev libtf2-msgs-dev libbz2-dev "
      "liblz4-dev and build with -DNADIR_WITH_ROSBAG=ON"};
}

}  // namespace

OpenedLayout open_rosbag(const std::filesystem::path& file, const Mounting& /*mounting*/,
                         const DriveReadOptions& /*options*/) {
  throw absent(file);
}

std::vector<BagTopic> list_bag(const std::filesystem::path& file) { throw absent(file); }

}  // namespace nadir
