// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/bags/detail/rosbag_images.hpp"

// sensor_msgs/Image: which encoding, 12 bytes of header, then the data.
NADIR_FUZZ_TARGET(ros_image) {
  using nadir::fuzz::taken;
  static constexpr std::array<const char*, 14> kEncodings{
      "mono8",       "rgb8",        "bgr8",        "rgba8",       "bgra8",  "8UC1", "8UC3",
      "bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8", "mono16", "8UC4", "yuv422"};
  nadir::ros1::Image message;
  message.encoding = kEncodings.at(taken<std::uint8_t>(input) % kEncodings.size());
  message.width = taken<std::uint32_t>(input);
  message.height = taken<std::uint32_t>(input);
  message.step = taken<std::uint32_t>(input);
  message.bytes = input;
  const auto pixels = nadir::pixels_of(std::move(message), "fuzz.bag");
  nadir::fuzz::require(!pixels.empty(), "an image without pixels");
  nadir::fuzz::require(pixels.values().size() <= 3 * input.size(), "more pixels than bytes");
}
