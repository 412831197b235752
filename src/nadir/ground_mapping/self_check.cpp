// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/self_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"

namespace nadir {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
/// Right poses give a p90 of 0.03 to 0.07 m and no shift on the real drives, those of another drive
/// 0.11 m and one pixel both ways: neither alone is proof, but where it is large.
constexpr double kMostDisagreement = 0.15;
constexpr double kMostWithShift = 0.08;
constexpr int kMostShift = 1;
/// The overlap below which a correlation says nothing.
constexpr std::size_t kFewestPixels = 400;

Raster<float> grey(const Orthomosaic& ortho) {
  Raster<float> result(ortho.width(), ortho.height());
  const int channels = ortho.image.channels();
  for (int row = 0; row < ortho.height(); ++row) {
    for (int column = 0; column < ortho.width(); ++column) {
      float sum = 0.0F;
      for (int c = 0; c < channels; ++c) sum += ortho.image.at(column, row, c);
      result.at(column, row) = sum / static_cast<float>(channels);
    }
  }
  return result;
}

/// Zero-mean correlation of a with b moved by (dx, dy), over pixels measured in both.
double zncc(const LocalMap& a, const Raster<float>& grey_a, const LocalMap& b,
            const Raster<float>& grey_b, int dx, int dy) {
  double n = 0.0, sa = 0.0, sb = 0.0, saa = 0.0, sbb = 0.0, sab = 0.0;
  for (int row = std::max(0, -dy); row < std::min(grey_a.height(), grey_a.height() - dy); ++row) {
    for (int column = std::max(0, -dx); column < std::min(grey_a.width(), grey_a.width() - dx);
         ++column) {
      if (a.ortho.valid.at(column, row) != kMeasured ||
          b.ortho.valid.at(column + dx, row + dy) != kMeasured) {
        continue;
      }
      const double x = grey_a.at(column, row), y = grey_b.at(column + dx, row + dy);
      n += 1.0;
      sa += x;
      sb += y;
      saa += x * x;
      sbb += y * y;
      sab += x * y;
    }
  }
  if (n < static_cast<double>(kFewestPixels)) return kUndefined;
  const double va = saa - sa * sa / n, vb = sbb - sb * sb / n;
  return va > 0.0 && vb > 0.0 ? (sab - sa * sb / n) / std::sqrt(va * vb) : kUndefined;
}

double quantile(std::vector<double>& values, double q) {
  const auto position = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + position, values.end());
  return values[static_cast<std::size_t>(position)];
}

void compare_heights(const LocalMap& a, const LocalMap& b, MapComparison& result) {
  // Each map knows its own ground; their difference must show, so it is put back.
  const double datum = a.ground_in_odom_m.value_or(a.odom_from_robot.translation.z()) -
                       b.ground_in_odom_m.value_or(b.odom_from_robot.translation.z());
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.ortho.valid.values().size(); ++i) {
    if (a.ortho.valid.values()[i] != kMeasured || b.ortho.valid.values()[i] != kMeasured) continue;
    const double ha = a.elevation.height_m.values()[i], hb = b.elevation.height_m.values()[i];
    differences.push_back(std::abs(ha - hb + datum));
  }
  result.overlap =
      static_cast<double>(differences.size()) / static_cast<double>(a.ortho.valid.values().size());
  if (differences.empty()) {
    result.height_median_m = result.height_p90_m = kUndefined;
    return;
  }
  result.height_median_m = quantile(differences, 0.5);
  result.height_p90_m = quantile(differences, 0.9);
}

}  // namespace

MapComparison compare_local_maps(const LocalMap& a, const LocalMap& b, int max_shift_px) {
  if (!a.ortho.image.same_size(b.ortho.image) || a.ortho.geo.resolution != b.ortho.geo.resolution) {
    throw Error(ErrorKind::kUsage, "the two local maps differ in size or resolution", {},
                "render both with the same options");
  }
  MapComparison result;
  const Raster<float> grey_a = grey(a.ortho), grey_b = grey(b.ortho);
  result.zncc_unshifted = zncc(a, grey_a, b, grey_b, 0, 0);
  result.zncc = result.zncc_unshifted;
  for (int dy = -max_shift_px; dy <= max_shift_px; ++dy) {
    for (int dx = -max_shift_px; dx <= max_shift_px; ++dx) {
      const double value = zncc(a, grey_a, b, grey_b, dx, dy);
      if (value > result.zncc || (std::isnan(result.zncc) && !std::isnan(value))) {
        result.zncc = value;
        result.shift_columns = dx;
        result.shift_rows = dy;
      }
    }
  }
  compare_heights(a, b, result);
  return result;
}

std::optional<std::string> pose_misfit(const MapComparison& comparison) {
  const int shift = std::max(std::abs(comparison.shift_columns), std::abs(comparison.shift_rows));
  const bool shifted =
      shift > kMostShift || (shift > 0 && comparison.height_p90_m > kMostWithShift);
  const bool disagrees = comparison.height_p90_m > (shifted ? kMostWithShift : kMostDisagreement);
  if (!disagrees && !shifted) return std::nullopt;
  std::string reason;
  if (disagrees) {
    reason = "the heights from odd and even frames differ by " +
             to_text(std::round(100.0 * comparison.height_p90_m) / 100.0) +
             " m and more in a tenth of the cells";
  }
  if (shifted) {
    reason += std::string(reason.empty() ? "" : ", and ") +
              "the maps from odd and even frames are displaced by " + std::to_string(shift) +
              (shift == 1 ? " pixel" : " pixels");
  }
  return "the poses do not fit the images: " + reason +
         "; check that they belong to this drive and name the right frame";
}

MapComparison OddEvenCheck::compare(RenderOptions options) const {
  if (count_ < 2) throw Error(ErrorKind::kUsage, "odd and even frames need at least one of each");
  options.at = last_;
  return compare_local_maps(even_.render(options), odd_.render(options));
}

}  // namespace nadir
