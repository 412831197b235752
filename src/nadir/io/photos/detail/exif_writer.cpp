// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "nadir/io/photos/detail/exif.hpp"

namespace nadir {
namespace {

std::string little_endian(std::uint32_t value, std::size_t size) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) {
    bytes.push_back(static_cast<char>(value >> (8U * static_cast<unsigned>(i)) & 0xffU));
  }
  return bytes;
}

/// The largest power of ten below which numerator and denominator fit 32 bits.
std::string rational(double value) {
  double denominator = 1e9;
  while (denominator > 1.0 && value * denominator > 4e9) denominator /= 10.0;
  const double numerator = std::clamp(std::round(value * denominator), 0.0, 4294967295.0);
  return little_endian(static_cast<std::uint32_t>(numerator), 4) +
         little_endian(static_cast<std::uint32_t>(denominator), 4);
}

/// Degrees, minutes and seconds to a millionth of a second (0.03 mm).
std::string degrees_minutes_seconds(double degrees) {
  constexpr std::uint64_t kDenominator = 1'000'000;
  const auto units =
      static_cast<std::uint64_t>(std::llround(std::abs(degrees) * 3600.0 * kDenominator));
  const std::uint64_t minutes = units / (60 * kDenominator);
  const auto whole = [](std::uint64_t value, std::uint64_t denominator) {
    return little_endian(static_cast<std::uint32_t>(value), 4) +
           little_endian(static_cast<std::uint32_t>(denominator), 4);
  };
  return whole(minutes / 60, 1) + whole(minutes % 60, 1) +
         whole(units - minutes * 60 * kDenominator, kDenominator);
}

/// One directory of a TIFF file; tags must be added in rising order.
class Directory {
 public:
  void add_text(std::uint32_t tag, const std::string& text) {
    if (!text.empty()) add(tag, 2, text + '\0', 1);
  }
  void add_bytes(std::uint32_t tag, std::uint32_t type, const std::string& bytes) {
    add(tag, type, bytes, 1);
  }
  void add_short(std::uint32_t tag, double value) {
    add(tag, 3, little_endian(rounded(value), 2), 2);
  }
  void add_long(std::uint32_t tag, std::uint32_t value) { add(tag, 4, little_endian(value, 4), 4); }
  void add_rational(std::uint32_t tag, double value) { add(tag, 5, rational(value), 8); }
  void add_rationals(std::uint32_t tag, const std::string& bytes) { add(tag, 5, bytes, 8); }

  bool empty() const { return entries_.empty(); }
  std::size_t size() const {
    std::size_t total = 2 + 12 * entries_.size() + 4;
    for (const Entry& entry : entries_) {
      if (entry.bytes.size() > 4) total += entry.bytes.size() + entry.bytes.size() % 2;
    }
    return total;
  }

  /// The bytes of the directory where it begins at `offset`: entries, then the values that do not
  /// fit into their entry.
  std::string bytes(std::size_t offset) const {
    std::string table = little_endian(static_cast<std::uint32_t>(entries_.size()), 2);
    std::string values;
    const std::size_t values_at = offset + 2 + 12 * entries_.size() + 4;
    for (const Entry& entry : entries_) {
      table += little_endian(entry.tag, 2) + little_endian(entry.type, 2) +
               little_endian(static_cast<std::uint32_t>(entry.bytes.size() / entry.unit), 4);
      if (entry.bytes.size() <= 4) {
        table += entry.bytes + std::string(4 - entry.bytes.size(), '\0');
        continue;
      }
      table += little_endian(static_cast<std::uint32_t>(values_at + values.size()), 4);
      values += entry.bytes + std::string(entry.bytes.size() % 2, '\0');
    }
    return table + little_endian(0, 4) + values;
  }

 private:
  struct Entry {
    std::uint32_t tag;
    std::uint32_t type;
    std::string bytes;
    std::size_t unit;
  };
  static std::uint32_t rounded(double value) {
    return static_cast<std::uint32_t>(std::clamp(std::round(value), 0.0, 65535.0));
  }
  void add(std::uint32_t tag, std::uint32_t type, const std::string& bytes, std::size_t unit) {
    entries_.push_back({tag, type, bytes, unit});
  }

  std::vector<Entry> entries_;
};

std::string subseconds(Stamp stamp) {
  const std::string text = to_string(Stamp{stamp.nanoseconds});
  const std::string digits = text.substr(text.find('.') + 1);
  const std::size_t last = digits.find_last_not_of('0');
  return last == std::string::npos ? "" : digits.substr(0, last + 1);
}

Directory camera_tags(const PhotoMetadata& m) {
  Directory tags;
  if (m.exposure_s) tags.add_rational(0x829a, *m.exposure_s);
  if (m.f_number) tags.add_rational(0x829d, *m.f_number);
  if (m.iso) tags.add_short(0x8827, *m.iso);
  tags.add_bytes(0x9000, 7, "0232");
  if (m.taken_at) tags.add_text(0x9003, exif_time(*m.taken_at));
  tags.add_bytes(0x9101, 7, std::string("\1\2\3\0", 4));  // Y, Cb, Cr
  if (m.focal_length_mm) tags.add_rational(0x920a, *m.focal_length_mm);
  if (m.taken_at) tags.add_text(0x9291, subseconds(*m.taken_at));
  tags.add_bytes(0xa000, 7, "0100");
  tags.add_short(0xa001, 1);  // sRGB
  tags.add_long(0xa002, static_cast<std::uint32_t>(m.exif_width.value_or(m.width)));
  tags.add_long(0xa003, static_cast<std::uint32_t>(m.exif_height.value_or(m.height)));
  if (m.focal_plane_pixels_per_mm) {
    constexpr std::uint32_t kCentimetre = 3;
    tags.add_rational(0xa20e, *m.focal_plane_pixels_per_mm * 10.0);
    tags.add_rational(0xa20f, *m.focal_plane_pixels_per_mm * 10.0);
    tags.add_short(0xa210, kCentimetre);
  }
  if (m.focal_length_35mm) tags.add_short(0xa405, *m.focal_length_35mm);
  tags.add_text(0xa431, m.serial);
  return tags;
}

Directory gps_tags(const GeodeticPosition& position) {
  Directory tags;
  tags.add_bytes(0, 1, std::string("\x02\x03\0\0", 4));
  tags.add_text(1, position.latitude_deg < 0.0 ? "S" : "N");
  tags.add_rationals(kGpsLatitude, degrees_minutes_seconds(position.latitude_deg));
  tags.add_text(3, position.longitude_deg < 0.0 ? "W" : "E");
  tags.add_rationals(kGpsLongitude, degrees_minutes_seconds(position.longitude_deg));
  if (position.altitude_known) {
    tags.add_bytes(5, 1, std::string(1, position.altitude_m < 0.0 ? '\x01' : '\0'));
    tags.add_rational(kGpsAltitude, std::abs(position.altitude_m));
  }
  if (position.horizontal_sigma_m) {
    tags.add_rational(kGpsHorizontalError, *position.horizontal_sigma_m);
  }
  return tags;
}

std::string app1(const std::string& content) {
  const std::size_t size = content.size() + 2;
  return std::string("\xff\xe1") + static_cast<char>(size >> 8U & 0xffU) +
         static_cast<char>(size & 0xffU) + content;
}

}  // namespace

std::string exif_segment(const PhotoMetadata& m) {
  constexpr std::size_t kFirst = 8;  // behind the TIFF header
  const Directory camera = camera_tags(m);
  const Directory gps = m.position ? gps_tags(*m.position) : Directory{};
  const auto image_tags = [&](std::size_t camera_at, std::size_t gps_at) {
    Directory tags;
    tags.add_text(0x010f, m.make);
    tags.add_text(0x0110, m.model);
    tags.add_short(0x0112, m.orientation);
    tags.add_rational(0x011a, 72.0);
    tags.add_rational(0x011b, 72.0);
    tags.add_short(0x0128, 2);
    tags.add_short(0x0213, 1);
    tags.add_long(0x8769, static_cast<std::uint32_t>(camera_at));
    if (!gps.empty()) tags.add_long(0x8825, static_cast<std::uint32_t>(gps_at));
    return tags;
  };
  const std::size_t camera_at = kFirst + image_tags(0, 0).size();
  const std::size_t gps_at = camera_at + camera.size();
  std::string tiff = std::string("II*\0", 4) + little_endian(kFirst, 4) +
                     image_tags(camera_at, gps_at).bytes(kFirst) + camera.bytes(camera_at);
  if (!gps.empty()) tiff += gps.bytes(gps_at);
  return app1(std::string("Exif\0\0", 6) + tiff);
}

std::string xmp_segment(const PhotoMetadata& m) {
  std::string tags;
  if (m.relative_altitude_m) {
    tags += fmt::format("\n   drone-dji:RelativeAltitude=\"{:+.3f}\"", *m.relative_altitude_m);
  }
  if (m.gimbal) {
    tags += fmt::format(
        "\n   drone-dji:GimbalYawDegree=\"{:+.2f}\"\n   drone-dji:GimbalPitchDegree=\"{:+.2f}\""
        "\n   drone-dji:GimbalRollDegree=\"{:+.2f}\"",
        m.gimbal->yaw_deg, m.gimbal->pitch_deg, m.gimbal->roll_deg);
  }
  if (m.position && m.position->ellipsoidal) tags += "\n   drone-dji:AltitudeType=\"RtkAlt\"";
  if (m.position && m.position->horizontal_sigma_m) {
    tags += fmt::format("\n   drone-dji:RtkStdLat=\"{0:.5f}\"\n   drone-dji:RtkStdLon=\"{0:.5f}\"",
                        *m.position->horizontal_sigma_m);
  }
  if (m.position && m.position->vertical_sigma_m) {
    tags += fmt::format("\n   drone-dji:RtkStdHgt=\"{:.5f}\"", *m.position->vertical_sigma_m);
  }
  if (tags.empty()) return {};
  return app1(std::string("http://ns.adobe.com/xap/1.0/\0", 29) +
              "<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
              "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n"
              " <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
              "  <rdf:Description rdf:about=\"\" "
              "xmlns:drone-dji=\"http://www.dji.com/drone-dji/1.0/\"" +
              tags + "/>\n </rdf:RDF>\n</x:xmpmeta>\n<?xpacket end=\"w\"?>");
}

std::string exif_time(Stamp stamp) {
  using std::chrono::days;
  constexpr std::int64_t kNanosecondsPerDay = 86'400'000'000'000;
  std::int64_t day = stamp.nanoseconds / kNanosecondsPerDay;
  if (stamp.nanoseconds % kNanosecondsPerDay < 0) --day;
  const std::int64_t second = (stamp.nanoseconds - day * kNanosecondsPerDay) / 1'000'000'000;
  const std::chrono::year_month_day date{std::chrono::sys_days(days(day))};
  return fmt::format("{:04}:{:02}:{:02} {:02}:{:02}:{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     second / 3600, second / 60 % 60, second % 60);
}

}  // namespace nadir
