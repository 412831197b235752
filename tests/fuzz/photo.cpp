// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/photos/photo_file.hpp"

NADIR_FUZZ_TARGET(photo) {
  const std::filesystem::path file = nadir::fuzz::as_file("photo.jpg", input);
  const nadir::Photo photo = nadir::read_photo(file, 64);
  nadir::fuzz::require(photo.image.width() <= 64 && photo.image.height() <= 64, "not reduced");
  nadir::read_image(file);
}
