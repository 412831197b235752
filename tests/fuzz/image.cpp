// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/image.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/detail/image_bytes.hpp"
#include "nadir/io/image_file_check.hpp"

// Images whose sizes lie among them; what is decoded is no larger than the file can hold.
NADIR_FUZZ_TARGET(image) {
  nadir::check_image_is_whole("image", input);
  const auto image = nadir::decode_image("image", std::string(input));
  nadir::fuzz::require(!image.empty() && (image.channels() == 1 || image.channels() == 3),
                       "an image without pixels");
}
