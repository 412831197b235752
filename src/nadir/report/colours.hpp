// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "nadir/core/raster.hpp"

namespace nadir::report {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Colour&) const = default;
};

inline constexpr Colour kPaper{255, 255, 255};
inline constexpr Colour kInk{33, 37, 41};
inline constexpr Colour kMuted{108, 117, 125};
inline constexpr Colour kGrid{226, 229, 233};
inline constexpr Colour kFrame{134, 142, 150};
inline constexpr Colour kNothing{236, 238, 240};   ///< where a map has no data
inline constexpr Colour kHatching{214, 218, 222};  ///< lines over kNothing

// Okabe and Ito, "Color universal design", 2008.
inline constexpr Colour kVermillion{213, 94, 0};
inline constexpr Colour kSkyBlue{86, 180, 233};
inline constexpr Colour kYellow{240, 228, 66};
inline constexpr Colour kPurple{204, 121, 167};
inline constexpr Colour kGreen{0, 158, 115};
inline constexpr Colour kBlue{0, 114, 178};
inline constexpr Colour kOrange{230, 159, 0};

// The boxes of the paper's Figs. 6 and 7.
inline constexpr Colour kSearchRed{230, 57, 53};
inline constexpr Colour kTruthBlue{38, 120, 255};

/// The colour of the `index`th track or curve; repeats after seven.
Colour track_colour(std::size_t index);

enum class ColourMap { kInferno, kViridis };

/// `share` 0 .. 1 of a perceptually uniform colour map; values outside are clamped.
Colour mapped_colour(ColourMap map, double share);

}  // namespace nadir::report
