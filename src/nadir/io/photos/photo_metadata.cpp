// SPDX-License-Identifier: Apache-2.0
#include <cpl_minixml.h>
#include <cpl_string.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>

#include "nadir/io/detail/raster_file.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/photos/detail/exif.hpp"
#include "nadir/io/photos/photo_file.hpp"

namespace nadir {
namespace {

/// The first number in a text such as "+39.80" or "(0.0027)".
std::optional<double> number(const std::string& text) {
  const std::size_t begin = text.find_first_of("-.0123456789");
  if (begin == std::string::npos) return std::nullopt;
  double value = 0.0;
  const auto result = std::from_chars(text.data() + begin, text.data() + text.size(), value);
  const bool sound = result.ec == std::errc{} && std::abs(value) <= kLargestNumber;
  return sound ? std::optional(value) : std::nullopt;
}

/// EXIF as GDAL gives it: "EXIF_<name>" among the metadata of a JPEG, in a domain of its own in a
/// TIFF.
class ExifTags {
 public:
  explicit ExifTags(GDALDataset& dataset) : dataset_(dataset) {}
  std::string text(const std::string& name) const {
    const std::string item = "EXIF_" + name;
    const char* value = dataset_.GetMetadataItem(item.c_str());
    if (value == nullptr) value = dataset_.GetMetadataItem(item.c_str(), "EXIF");
    std::string text = value == nullptr ? "" : value;
    text.erase(text.find_last_not_of(" \0") + 1);
    return text;
  }
  std::optional<double> positive(const std::string& name) const {
    const auto value = number(text(name));
    return value && *value > 0.0 ? value : std::nullopt;
  }
  std::optional<int> positive_int(const std::string& name) const {
    const auto value = positive(name);
    return value && *value < 1e6 ? std::optional(static_cast<int>(*value)) : std::nullopt;
  }

 private:
  GDALDataset& dataset_;
};

/// Every value of an XMP packet by its name without namespace, whether it stands as an element or
/// as an attribute.
void collect(const CPLXMLNode* node, std::map<std::string, std::string>& values) {
  for (; node != nullptr; node = node->psNext) {
    const bool named = node->eType == CXT_Element || node->eType == CXT_Attribute;
    const CPLXMLNode* child = node->psChild;
    if (named && child != nullptr && child->eType == CXT_Text) {
      const std::string name = node->pszValue;
      values.emplace(name.substr(name.find(':') + 1), child->pszValue);
    }
    collect(child, values);
  }
}

std::map<std::string, std::string> read_xmp(GDALDataset& dataset) {
  std::map<std::string, std::string> values;
  char** packet = dataset.GetMetadata("xml:XMP");
  if (packet == nullptr || packet[0] == nullptr) return values;
  const XmlTree tree(CPLParseXMLString(packet[0]));
  collect(tree.get(), values);
  return values;
}

std::string read_head(const std::filesystem::path& path) {
  constexpr std::streamsize kHead = 262'144;  // four segments of the largest size
  std::string head(static_cast<std::size_t>(kHead), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), kHead);
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

/// Degrees out of up to three rationals; absent where the parts are impossible.
std::optional<double> decimal_degrees(const std::array<double, 3>& parts,
                                      const std::string& reference) {
  const double value = parts[0] + parts[1] / 60.0 + parts[2] / 3600.0;
  if (!(std::abs(value) <= 180.0)) return std::nullopt;
  return reference.starts_with('S') || reference.starts_with('W') ? -value : value;
}

std::array<double, 3> three_numbers(const std::string& text) {
  std::array<double, 3> values{};
  std::size_t begin = 0;
  for (double& value : values) {
    begin = text.find('(', begin);
    if (begin == std::string::npos) break;
    value = number(text.substr(begin)).value_or(0.0);
    ++begin;
  }
  return values;
}

/// The altitude: below the reference where it says 1 (or 3), above the ellipsoid where it says 2 or
/// 3 (EXIF 3.0).
void set_altitude(GeodeticPosition& position, double metres, const std::string& reference) {
  const double code = number(reference.substr(reference.find('x') + 1)).value_or(0.0);
  position.altitude_m = code == 1.0 || code == 3.0 ? -metres : metres;
  position.ellipsoidal = code == 2.0 || code == 3.0;
  // Receivers that have no height yet write 0.
  position.altitude_known = std::isfinite(metres) && metres != 0.0;
  if (!position.altitude_known) position.altitude_m = 0.0;
}

/// Fills in `position`; false where EXIF has none.
bool read_exif_position(const ExifTags& exif, const std::string& head, GeodeticPosition& position) {
  const auto exact = gps_rationals(head);
  const auto value = [&](int tag, const char* name) -> std::optional<std::array<double, 3>> {
    if (const auto found = exact.find(tag); found != exact.end()) return found->second;
    const std::string text = exif.text(name);
    return text.empty() ? std::nullopt : std::optional(three_numbers(text));
  };
  const auto latitude = value(kGpsLatitude, "GPSLatitude");
  const auto longitude = value(kGpsLongitude, "GPSLongitude");
  if (!latitude || !longitude) return false;
  const auto north = decimal_degrees(*latitude, exif.text("GPSLatitudeRef"));
  const auto east = decimal_degrees(*longitude, exif.text("GPSLongitudeRef"));
  if (!north || !east || std::abs(*north) > 90.0) return false;
  position.latitude_deg = *north;
  position.longitude_deg = *east;
  const auto altitude = value(kGpsAltitude, "GPSAltitude");
  set_altitude(position, altitude ? altitude->front() : 0.0, exif.text("GPSAltitudeRef"));
  if (exact.contains(kGpsHorizontalError) && exact.at(kGpsHorizontalError)[0] > 0.0) {
    position.horizontal_sigma_m = exact.at(kGpsHorizontalError)[0];
  }
  return true;
}

class XmpTags {
 public:
  explicit XmpTags(GDALDataset& dataset) : values_(read_xmp(dataset)) {}
  std::optional<double> value(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::nullopt : number(found->second);
  }
  std::string text(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? "" : found->second;
  }

 private:
  std::map<std::string, std::string> values_;
};

/// Only where EXIF has lost its position. Some models write "GpsLongtitude".
bool read_xmp_position(const XmpTags& xmp, GeodeticPosition& position) {
  const auto latitude = xmp.value("GpsLatitude");
  auto longitude = xmp.value("GpsLongitude");
  if (!longitude) longitude = xmp.value("GpsLongtitude");
  if (!latitude || !longitude || std::abs(*latitude) > 90.0 || std::abs(*longitude) > 180.0) {
    return false;
  }
  position.latitude_deg = *latitude;
  position.longitude_deg = *longitude;
  set_altitude(position, xmp.value("AbsoluteAltitude").value_or(0.0), "");
  return true;
}

void add_accuracy(const XmpTags& xmp, GeodeticPosition& position) {
  const auto north = xmp.value("RtkStdLat"), east = xmp.value("RtkStdLon");
  if (north && east && *north > 0.0 && *east > 0.0) {
    position.horizontal_sigma_m = std::max(*north, *east);
  }
  const auto height = xmp.value("RtkStdHgt");
  if (height && *height > 0.0) position.vertical_sigma_m = height;
  if (xmp.text("AltitudeType") == "RtkAlt") position.ellipsoidal = true;
}

std::optional<GeodeticPosition> position_of(const ExifTags& exif, const XmpTags& xmp,
                                            const std::string& head) {
  GeodeticPosition position;
  if (!read_exif_position(exif, head, position) && !read_xmp_position(xmp, position)) {
    return std::nullopt;
  }
  // A receiver without a fix writes 0, 0, a place in the Gulf of Guinea.
  if (position.latitude_deg == 0.0 && position.longitude_deg == 0.0) return std::nullopt;
  add_accuracy(xmp, position);
  return position;
}

std::optional<GimbalAttitude> gimbal_of(const XmpTags& xmp) {
  const auto yaw = xmp.value("GimbalYawDegree"), pitch = xmp.value("GimbalPitchDegree"),
             roll = xmp.value("GimbalRollDegree");
  if (!yaw || !pitch || !roll) return std::nullopt;
  return GimbalAttitude{*yaw, *pitch, *roll};
}

/// Pixels per millimetre of the sensor, of the full-size image.
std::optional<double> focal_plane_resolution(const ExifTags& exif) {
  const auto resolution = exif.positive("FocalPlaneXResolution");
  if (!resolution) return std::nullopt;
  constexpr std::array<double, 6> kMillimetres{25.4, 25.4, 25.4, 10.0, 1.0, 0.001};
  const auto unit =
      static_cast<std::size_t>(exif.positive_int("FocalPlaneResolutionUnit").value_or(2));
  return *resolution / (unit < kMillimetres.size() ? kMillimetres.at(unit) : 25.4);
}

void add_camera(PhotoMetadata& metadata, const ExifTags& exif) {
  metadata.orientation = exif.positive_int("Orientation").value_or(1);
  metadata.exif_width = exif.positive_int("PixelXDimension");
  metadata.exif_height = exif.positive_int("PixelYDimension");
  metadata.make = exif.text("Make");
  metadata.model = exif.text("Model");
  metadata.serial = exif.text("BodySerialNumber");
  metadata.focal_length_mm = exif.positive("FocalLength");
  metadata.focal_length_35mm = exif.positive("FocalLengthIn35mmFilm");
  metadata.focal_plane_pixels_per_mm = focal_plane_resolution(exif);
  metadata.exposure_s = exif.positive("ExposureTime");
  metadata.iso = exif.positive("ISOSpeedRatings");
  metadata.f_number = exif.positive("FNumber");
  std::string subseconds = exif.text("SubSecTime_Original");
  if (subseconds.empty()) subseconds = exif.text("SubSecTimeOriginal");
  metadata.taken_at = parse_exif_time(exif.text("DateTimeOriginal"), subseconds);
}

}  // namespace

PhotoMetadata read_photo_metadata(const std::filesystem::path& path) {
  const GdalErrors errors;
  const GdalSetting no_side_files("GDAL_PAM_ENABLED", "NO");
  const GdalDataset dataset = open_raster(path, errors, RasterUse::kPhoto);
  PhotoMetadata metadata;
  metadata.name = path.filename().string();
  metadata.width = dataset->GetRasterXSize();
  metadata.height = dataset->GetRasterYSize();
  const ExifTags exif(*dataset);
  const XmpTags xmp(*dataset);
  add_camera(metadata, exif);
  if (metadata.serial.empty()) metadata.serial = xmp.text("CameraSerialNumber");
  metadata.position = position_of(exif, xmp, read_head(path));
  metadata.relative_altitude_m = xmp.value("RelativeAltitude");
  metadata.gimbal = gimbal_of(xmp);
  return metadata;
}

}  // namespace nadir
