// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/stamp.hpp"

#include <charconv>

namespace nadir {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kFarthestSeconds = kFarthestStampNs / kNanosecondsPerSecond;
constexpr std::size_t kFractionDigits = 9;

std::optional<std::int64_t> parse_digits(std::string_view digits) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  if (!digits.empty() && digits.front() == '-') return std::nullopt;
  return value;
}

/// "1.4e9" and the like, as NumPy writes them: only where no precision is lost by a double.
std::optional<Stamp> parse_scientific(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (!(value > -kFarthestSeconds && value < kFarthestSeconds)) return std::nullopt;
  return Stamp{static_cast<std::int64_t>(value * 1e9 + (value < 0 ? -0.5 : 0.5))};
}

}  // namespace

std::optional<Stamp> parse_stamp(std::string_view seconds) {
  if (seconds.find_first_of("eE") != std::string_view::npos) return parse_scientific(seconds);
  const bool negative = !seconds.empty() && seconds.front() == '-';
  if (negative) seconds.remove_prefix(1);
  const std::size_t point = seconds.find('.');
  const std::string_view whole_text = seconds.substr(0, point);
  std::string fraction_text(point == std::string_view::npos ? std::string_view{}
                                                            : seconds.substr(point + 1));
  if (whole_text.empty() && fraction_text.empty()) return std::nullopt;
  if (fraction_text.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  fraction_text.resize(kFractionDigits, '0');

  const auto whole = whole_text.empty() ? std::optional<std::int64_t>{0} : parse_digits(whole_text);
  const auto fraction = parse_digits(fraction_text);
  if (!whole || !fraction || *whole >= kFarthestSeconds) return std::nullopt;
  const std::int64_t value = *whole * kNanosecondsPerSecond + *fraction;
  return Stamp{negative ? -value : value};
}

std::string to_string(Stamp stamp) {
  const bool negative = stamp.nanoseconds < 0;
  // Unsigned arithmetic: the most negative value has no positive counterpart.
  const auto magnitude = negative ? ~static_cast<std::uint64_t>(stamp.nanoseconds) + 1
                                  : static_cast<std::uint64_t>(stamp.nanoseconds);
  std::string fraction = std::to_string(magnitude % kNanosecondsPerSecond);
  fraction.insert(0, kFractionDigits - fraction.size(), '0');
  return (negative ? "-" : "") + std::to_string(magnitude / kNanosecondsPerSecond) + "." + fraction;
}

}  // namespace nadir
