// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "nadir/io/photos/detail/exif.hpp"

namespace nadir {
namespace {

constexpr std::string_view kExifHeader("Exif\0\0", 6);
constexpr std::uint32_t kGpsDirectory = 0x8825;
constexpr std::uint32_t kRational = 5;
constexpr std::size_t kEntrySize = 12;

/// The TIFF structure inside an EXIF segment. What lies outside of it reads as 0.
class Tiff {
 public:
  explicit Tiff(std::string_view bytes) : bytes_(bytes), little_(bytes.starts_with("II")) {}

  std::uint32_t number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t position = at + (little_ ? size - 1 - i : i);
      value = value << 8U | static_cast<std::uint8_t>(bytes_[position]);
    }
    return value;
  }

  double rational(std::size_t at) const {
    const double denominator = number(at + 4, 4);
    return denominator > 0.0 ? number(at, 4) / denominator : std::nan("");
  }

  /// Calls `visit(position of the entry)` for each entry of a directory.
  template <class Visit>
  void for_each_entry(std::size_t directory, Visit&& visit) const {
    if (directory == 0 || directory >= bytes_.size()) return;
    const std::size_t count = number(directory, 2);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t entry = directory + 2 + i * kEntrySize;
      if (entry + kEntrySize > bytes_.size()) return;
      visit(entry);
    }
  }

 private:
  std::string_view bytes_;
  bool little_;
};

/// The TIFF structure of the EXIF segment among the segments at the start of a JPEG.
std::string_view exif_block(std::string_view head) {
  constexpr std::uint8_t kApp1 = 0xe1;
  constexpr std::uint8_t kStartOfScan = 0xda;
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(head[at]); };
  for (std::size_t at = 2; at + 4 <= head.size() && byte(at) == 0xff;) {
    const std::uint8_t marker = byte(at + 1);
    const std::size_t size = static_cast<std::size_t>(byte(at + 2)) << 8U | byte(at + 3);
    if (marker == kStartOfScan || size < 2) return {};
    const std::string_view segment = head.substr(at + 4, size - 2);
    if (marker == kApp1 && segment.starts_with(kExifHeader)) {
      return segment.substr(kExifHeader.size());
    }
    at += 2 + size;
  }
  return {};
}

std::optional<int> digits(std::string_view text, std::size_t at, std::size_t count) {
  if (at + count > text.size()) return std::nullopt;
  int value = 0;
  const char* end = text.data() + at + count;
  const auto [stop, error] = std::from_chars(text.data() + at, end, value);
  return error == std::errc{} && stop == end && value >= 0 ? std::optional(value) : std::nullopt;
}

}  // namespace

std::map<int, std::array<double, 3>> gps_rationals(std::string_view head) {
  std::map<int, std::array<double, 3>> values;
  const std::string_view block = exif_block(head);
  if (!block.starts_with("II") && !block.starts_with("MM")) return values;
  const Tiff tiff(block);
  std::size_t gps = 0;
  tiff.for_each_entry(tiff.number(4, 4), [&](std::size_t entry) {
    if (tiff.number(entry, 2) == kGpsDirectory) gps = tiff.number(entry + 8, 4);
  });
  tiff.for_each_entry(gps, [&](std::size_t entry) {
    const std::size_t count = tiff.number(entry + 4, 4);
    if (tiff.number(entry + 2, 2) != kRational || count == 0 || count > 3) return;
    const std::size_t at = tiff.number(entry + 8, 4);
    if (at + 8 * count > block.size()) return;
    std::array<double, 3> value{};
    for (std::size_t i = 0; i < count; ++i) value.at(i) = tiff.rational(at + 8 * i);
    values[static_cast<int>(tiff.number(entry, 2))] = value;
  });
  return values;
}

std::optional<Stamp> parse_exif_time(const std::string& text, const std::string& subseconds) {
  using std::chrono::sys_days;
  const auto year = digits(text, 0, 4), month = digits(text, 5, 2), day = digits(text, 8, 2);
  const auto hour = digits(text, 11, 2), minute = digits(text, 14, 2), second = digits(text, 17, 2);
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok() || *hour > 23 || *minute > 59 || *second > 60) return std::nullopt;
  const std::int64_t days = sys_days(date).time_since_epoch().count();
  const std::int64_t seconds = ((days * 24 + *hour) * 60 + *minute) * 60 + *second;
  const std::string fraction(subseconds.begin(),
                             std::find_if(subseconds.begin(), subseconds.end(),
                                          [](char c) { return c < '0' || c > '9'; }));
  return parse_stamp(std::to_string(seconds) + (fraction.empty() ? "" : "." + fraction));
}

}  // namespace nadir
