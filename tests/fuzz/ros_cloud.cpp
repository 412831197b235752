// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_cloud.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/bags/detail/rosbag_images.hpp"

// sensor_msgs/PointCloud2: 18 bytes of header, ten a field, then the data.
NADIR_FUZZ_TARGET(ros_cloud) {
  using nadir::fuzz::taken;
  static constexpr std::array<const char*, 6> kNames{"x", "y", "z", "intensity", "time", "ring"};
  nadir::ros1::PointCloud message;
  message.width = taken<std::uint32_t>(input);
  message.height = taken<std::uint32_t>(input);
  message.point_step = taken<std::uint32_t>(input);
  message.row_step = taken<std::uint32_t>(input);
  message.big_endian = taken<std::uint8_t>(input) % 2 == 1;
  const int fields = taken<std::uint8_t>(input) % 16;
  for (int i = 0; i < fields; ++i) {
    nadir::ros1::PointField field;
    field.name = kNames.at(taken<std::uint8_t>(input) % kNames.size());
    field.datatype = taken<std::uint8_t>(input);
    field.offset = taken<std::uint32_t>(input);
    field.count = taken<std::uint32_t>(input);
    message.fields.push_back(std::move(field));
  }
  message.bytes = input;
  nadir::fuzz::require_cloud(nadir::points_of(message, "fuzz.bag"), input.size());
}
