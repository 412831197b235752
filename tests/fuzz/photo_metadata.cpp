// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/photos/photo_file.hpp"

NADIR_FUZZ_TARGET(photo_metadata) {
  using nadir::fuzz::require;
  const nadir::PhotoMetadata photo =
      nadir::read_photo_metadata(nadir::fuzz::as_file("photo.jpg", input));
  require(photo.width > 0 && photo.height > 0, "a photo without a size");
  const auto finite = [](const auto& value) { return !value || std::isfinite(*value); };
  require(finite(photo.relative_altitude_m) && finite(photo.focal_length_mm) &&
              finite(photo.focal_length_35mm) && finite(photo.focal_plane_pixels_per_mm) &&
              finite(photo.exposure_s) && finite(photo.iso) && finite(photo.f_number),
          "a tag is not finite");
  if (!photo.position) return;
  const nadir::GeodeticPosition& place = *photo.position;
  require(std::abs(place.latitude_deg) <= 90.0 && std::abs(place.longitude_deg) <= 180.0,
          "an impossible position");
  require(std::isfinite(place.altitude_m) && finite(place.horizontal_sigma_m) &&
              finite(place.vertical_sigma_m),
          "a position is not finite");
}
