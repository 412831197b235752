// SPDX-License-Identifier: Apache-2.0
#pragma once

// The parts of EXIF that GDAL has not: it prints rationals with six digits, which is 0.2 m for
// positions in decimal minutes and 11 m for decimal degrees, and it does not write GPS tags.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "nadir/core/photo.hpp"

namespace nadir {

/// The rational values of the GPS directory of a JPEG, by tag number (EXIF 2.32, table 15);
/// `head` is the beginning of the file. Empty where there is none, or where it is damaged.
std::map<int, std::array<double, 3>> gps_rationals(std::string_view head);

inline constexpr int kGpsLatitude = 2;
inline constexpr int kGpsLongitude = 4;
inline constexpr int kGpsAltitude = 6;
inline constexpr int kGpsHorizontalError = 31;

/// The APP1 segments that carry the metadata, to be put behind the start of a JPEG.
std::string exif_segment(const PhotoMetadata& metadata);
std::string xmp_segment(const PhotoMetadata& metadata);  ///< empty where it has nothing to say

/// The camera's local time as EXIF writes it, "2016:06:23 16:31:59", and the sub-second digits.
std::optional<Stamp> parse_exif_time(const std::string& text, const std::string& subseconds);
std::string exif_time(Stamp stamp);

}  // namespace nadir
