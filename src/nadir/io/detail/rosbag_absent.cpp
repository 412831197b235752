// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/error.hpp"
#include "nadir/io/detail/drive_layout.hpp"

namespace nadir {

OpenedLayout open_rosbag(const std::filesystem::path& file, const Mounting& /*mounting*/,
                         const DriveReadOptions& /*options*/) {
  throw Error(ErrorKind::kUsage, "this build reads no ROS bags", file.string(),
              "install librosbag-storage-dev and build with -DNADIR_WITH_ROSBAG=ON");
}

}  // namespace nadir
