// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace nadir {

/// An instant, in integer nanoseconds since an epoch of the data's own. Read and written as
/// decimal seconds in text, never through floating point: a double at Unix time steps by 238 ns.
struct Stamp {
  std::int64_t nanoseconds = 0;

  auto operator<=>(const Stamp&) const = default;
  double seconds() const { return static_cast<double>(nanoseconds) * 1e-9; }
};

/// The farthest that a stamp of a file may be from its epoch, 146 years: the difference of two such
/// stamps is a number of nanoseconds, too.
inline constexpr std::int64_t kFarthestStampNs = 4'600'000'000'000'000'000;

/// Whether a stamp that was not parsed here is as near.
constexpr bool is_near_epoch(Stamp stamp) {
  return stamp.nanoseconds >= -kFarthestStampNs && stamp.nanoseconds <= kFarthestStampNs;
}

/// Parses decimal seconds ("12", "-0.5", "1403636579.763555527"), digits beyond nanoseconds cut
/// off; nothing where the text is not such a number or lies beyond kFarthestStampNs.
std::optional<Stamp> parse_stamp(std::string_view seconds);

/// Decimal seconds with nine places, as TUM files carry them.
std::string to_string(Stamp stamp);

}  // namespace nadir
