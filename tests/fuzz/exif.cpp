// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/detail/exif.hpp"
#include "fuzz/fuzz_target.hpp"

// The head of a JPEG, and times as EXIF writes them.
NADIR_FUZZ_TARGET(exif) {
  nadir::gps_rationals(input);
  const auto parts = nadir::fuzz::parts_of(input, 2);
  if (const auto stamp = nadir::parse_exif_time(std::string(parts[0]), std::string(parts[1]))) {
    nadir::exif_time(*stamp);
  }
}
