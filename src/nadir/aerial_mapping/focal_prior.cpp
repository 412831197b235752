// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/focal_prior.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace nadir {
namespace {

constexpr double kTableSigma = 0.02;
constexpr double kEquivalentSigma = 0.05;
constexpr double kUnknownSigma = 0.30;
// 35 mm equivalents are of the width by some makers and of the diagonal by others: for 4:3 photos
// the two differ by 4 %, inside kEquivalentSigma.
constexpr double kFilmWidthMm = 36.0;
// Field of view 61 degrees: the middle of the drone and compact cameras of the table.
constexpr double kUnknownFocalOfWidth = 0.85;
constexpr double kDoubtfulRatio = 1.05;

bool same_word(std::string_view a, std::string_view b) {
  const auto lower = [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return text;
}

std::string rounded(double value) { return std::to_string(static_cast<long>(std::lround(value))); }

/// Photos may have been resized but not cropped: then the longer side spans the sensor's width.
double longer_side(const PhotoMetadata& metadata, int working_width) {
  if (metadata.width <= 0 || metadata.height <= metadata.width) return working_width;
  return static_cast<double>(working_width) * metadata.height / metadata.width;
}

std::optional<double> focal_of_plane_resolution(const PhotoMetadata& metadata, double side) {
  if (!metadata.focal_length_mm || !metadata.focal_plane_pixels_per_mm) return std::nullopt;
  // The resolution is that of the full-size image, which EXIF still claims after a resize.
  const int full_width = metadata.exif_width.value_or(metadata.width);
  const int full = std::max(full_width, metadata.exif_height.value_or(metadata.height));
  if (full <= 0) return std::nullopt;
  const double sensor_mm = full / *metadata.focal_plane_pixels_per_mm;
  if (!(sensor_mm > 2.0 && sensor_mm < 60.0)) return std::nullopt;
  return *metadata.focal_length_mm / sensor_mm * side;
}

}  // namespace

const std::vector<SensorEntry>& sensor_table() {
  // Nominal widths by optical format. FC300S checked against GPS and relative altitude of a real
  // block; the others by their makers' focal length and 35 mm equivalent only.
  static const std::vector<SensorEntry> table{
      {"DJI", "FC300S", 6.17, 3.61},
      {"DJI", "FC300X", 6.17, 3.61},
      {"DJI", "FC300C", 6.17, 3.61},
      {"DJI", "FC330", 6.17, 3.61},
      {"DJI", "FC220", 6.17, 4.73},
      {"DJI", "FC350", 6.17, 3.61},
      {"DJI", "FC6310", 13.2, 8.8},
      {"DJI", "FC6310S", 13.2, 8.8},
      {"DJI", "FC6310R", 13.2, 8.8},
      {"DJI", "FC6360", 4.87, 5.74},
      {"DJI", "FC550", 17.3, 0.0},
      {"DJI", "FC6520", 17.3, 0.0},
      {"DJI", "FC7203", 6.17, 4.49},
      {"DJI", "FC3170", 6.4, 4.5},
      {"DJI", "FC3411", 13.2, 8.38},
      {"DJI", "FC3582", 9.7, 6.7},
      {"Hasselblad", "L1D-20c", 13.2, 10.26},
  };
  return table;
}

std::optional<SensorEntry> find_sensor(std::string_view make, std::string_view model) {
  for (const SensorEntry& entry : sensor_table())
    if (same_word(entry.make, trimmed(make)) && same_word(entry.model, trimmed(model)))
      return entry;
  return std::nullopt;
}

FocalPrior focal_prior(const PhotoMetadata& metadata, int working_width,
                       std::vector<std::string>* warnings) {
  const double side = longer_side(metadata, working_width);
  const auto warn = [&](const std::string& text) {
    if (warnings != nullptr) warnings->push_back(text);
  };
  std::optional<double> equivalent;
  if (metadata.focal_length_35mm && *metadata.focal_length_35mm > 5.0)
    equivalent = *metadata.focal_length_35mm / kFilmWidthMm * side;

  FocalPrior prior;
  const auto sensor = find_sensor(metadata.make, metadata.model);
  // EXIF rounds the focal length of some cameras to a tenth (3.6 for 3.61): a fixed lens is known
  // better by the table, unless the tag says that this is another lens.
  std::optional<double> focal_mm = metadata.focal_length_mm;
  if (sensor && sensor->focal_mm > 0.0 &&
      (!focal_mm || std::abs(*focal_mm / sensor->focal_mm - 1.0) < 0.02))
    focal_mm = sensor->focal_mm;
  if (sensor && focal_mm && *focal_mm > 0.0) {
    prior = {*focal_mm / sensor->width_mm * side, kTableSigma,
             "sensor table (" + std::string(sensor->model) + ") and focal length"};
  } else if (const auto plane = focal_of_plane_resolution(metadata, side)) {
    prior = {*plane, kEquivalentSigma, "focal length and focal-plane resolution"};
  } else if (equivalent) {
    prior = {*equivalent, kEquivalentSigma, "35 mm equivalent"};
  } else {
    prior = {kUnknownFocalOfWidth * side, kUnknownSigma, "assumed: the tags say nothing"};
    warn(metadata.name + ": the focal length is unknown; " + rounded(prior.focal_px) +
         " px is assumed");
  }
  if (equivalent && prior.source != "35 mm equivalent") {
    const double ratio = std::max(prior.focal_px / *equivalent, *equivalent / prior.focal_px);
    if (ratio > kDoubtfulRatio)
      warn(metadata.name + ": focal length " + rounded(prior.focal_px) + " px by " + prior.source +
           ", " + rounded(*equivalent) + " px by its 35 mm equivalent; the former is used");
  }
  return prior;
}

}  // namespace nadir
