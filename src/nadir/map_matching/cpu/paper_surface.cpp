// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/paper_surface.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "nadir/map_matching/cpu/sums.hpp"

namespace nadir::cpu {
namespace {

constexpr float kUndefined = std::numeric_limits<float>::quiet_NaN();
constexpr double kMinVariance = 1.0;  // grey^2

/// The window's mean and norm at every position of one template.
struct WindowMoments {
  double count = 0.0;       ///< template pixels
  double local_norm = 0.0;  ///< sum (P - Pm)^2
  Raster<float> deviation;  ///< w |P - Pm|
  Raster<float> mean;       ///< mu(u, v); NaN where the score is undefined
  Raster<float> norm;       ///< sum (R - mu)^2
  Raster<float> valid_weight;
};

struct MapSpectra {
  double shift = 0.0;
  Spectrum value;
  Spectrum squares;
  Spectrum seen;
};

double count_of(const Raster<float>& mask) {
  double count = 0.0;
  for (const float value : mask.values()) count += value;
  return count;
}

WindowMoments window_moments(const RealFft& fft, const MapSpectra& map, const Region& region,
                             const RotatedTemplate& local, const PixelWindow& window,
                             double min_valid_weight) {
  WindowMoments moments;
  moments.count = count_of(local.mask);
  const double local_mean = mean_grey(local.value, local.mask);
  moments.deviation = local.weight;
  for (std::size_t i = 0; i < moments.deviation.values().size(); ++i) {
    const double deviation = std::abs(local.value.values()[i] - local_mean);
    moments.deviation.values()[i] *= static_cast<float>(deviation / kGreyScale);
    moments.local_norm += local.mask.values()[i] * deviation * deviation;
  }

  const int left = local.left - region.template_left;
  const int top = local.top - region.template_top;
  const auto correlate = [&](const Spectrum& a, const Spectrum& b) {
    return fft.correlate(a, b, left, top, window.width, window.height);
  };
  const Spectrum mask = fft.forward(local.mask);
  const Raster<float> sum = correlate(map.value, mask);
  const Raster<float> squares = correlate(map.squares, mask);
  const Raster<float> seen = correlate(map.seen, fft.forward(local.seen));

  moments.mean = Raster<float>(window.width, window.height, kUndefined);
  moments.norm = moments.mean;
  moments.valid_weight = Raster<float>(window.width, window.height);
  for (std::size_t i = 0; i < sum.values().size(); ++i) {
    const double share =
        local.total_seen > 0.0 ? std::clamp(seen.values()[i] / local.total_seen, 0.0, 1.0) : 0.0;
    moments.valid_weight.values()[i] = static_cast<float>(share);
    const double mean = sum.values()[i] / moments.count;
    const double norm =
        (squares.values()[i] - moments.count * mean * mean) * kGreyScale * kGreyScale;
    if (share < min_valid_weight || norm < kMinVariance * moments.count ||
        moments.local_norm < kMinVariance * moments.count) {
      continue;
    }
    moments.mean.values()[i] =
        static_cast<float>(std::clamp(map.shift + kGreyScale * mean, 0.0, 255.0));
    moments.norm.values()[i] = static_cast<float>(norm);
  }
  return moments;
}

/// |R - level| / 64 over the whole region.
Raster<float> absolute_deviation(const Raster<float>& value, int level) {
  Raster<float> result = value;
  for (float& grey : result.values()) {
    grey = std::abs(grey - static_cast<float>(level)) / static_cast<float>(kGreyScale);
  }
  return result;
}

std::map<int, Spectrum> level_spectra(const RealFft& fft, const Region& region,
                                      std::span<const WindowMoments> moments) {
  std::array<bool, 257> needed{};
  for (const WindowMoments& window : moments) {
    for (const float mean : window.mean.values()) {
      if (std::isnan(mean)) continue;
      const auto level = static_cast<std::size_t>(mean);
      needed[level] = needed[level + 1] = true;
    }
  }
  std::map<int, Spectrum> spectra;
  for (int level = 0; level < static_cast<int>(needed.size()); ++level) {
    if (needed[static_cast<std::size_t>(level)]) spectra[level];
  }
  tbb::parallel_for(0, static_cast<int>(needed.size()), [&](int level) {
    const auto found = spectra.find(level);
    if (found == spectra.end()) return;
    found->second = fft.forward(absolute_deviation(region.value, level));
  });
  return spectra;
}

/// Adds level L's share to the numerator wherever L is next to the window's mean: the weight falls
/// linearly to 0 one level away.
void add_level(Raster<float>& numerator, const Raster<float>& correlation,
               const Raster<float>& mean, int level) {
  for (std::size_t i = 0; i < numerator.values().size(); ++i) {
    const float distance = std::abs(mean.values()[i] - static_cast<float>(level));
    if (distance < 1.0F) numerator.values()[i] += (1.0F - distance) * correlation.values()[i];
  }
}

ScoreSurface paper_surface(const RealFft& fft, const std::map<int, Spectrum>& levels,
                           const Region& region, const RotatedTemplate& local,
                           const PixelWindow& window, const WindowMoments& moments) {
  const Spectrum deviation = fft.forward(moments.deviation);
  Raster<float> numerator(window.width, window.height);
  for (const auto& [level, spectrum] : levels) {
    const bool used = std::any_of(
        moments.mean.values().begin(), moments.mean.values().end(),
        [at = static_cast<float>(level)](float mean) { return std::abs(mean - at) < 1.0F; });
    if (!used) continue;
    const Raster<float> correlation =
        fft.correlate(spectrum, deviation, local.left - region.template_left,
                      local.top - region.template_top, window.width, window.height);
    add_level(numerator, correlation, moments.mean, level);
  }
  ScoreSurface surface{Raster<float>(window.width, window.height, kUndefined),
                       moments.valid_weight};
  for (std::size_t i = 0; i < numerator.values().size(); ++i) {
    if (std::isnan(moments.mean.values()[i])) continue;
    surface.score.values()[i] =
        static_cast<float>(numerator.values()[i] * kGreyScale * kGreyScale /
                           std::sqrt(moments.norm.values()[i] * moments.local_norm));
  }
  return surface;
}

}  // namespace

std::vector<ScoreSurface> paper_surfaces(const MatchingOptions& options, const Region& region,
                                         std::span<const RotatedTemplate> templates,
                                         const PixelWindow& window) {
  const RealFft fft(region.value.width(), region.value.height());
  MapSpectra map;
  map.shift = mean_grey(region.value, region.takes_part);
  const Raster<float> value = shifted(region.value, region.takes_part, map.shift);
  map.value = fft.forward(value);
  map.squares = fft.forward(times(value, value));
  map.seen = fft.forward(region.valid);

  std::vector<WindowMoments> moments(templates.size());
  tbb::parallel_for(std::size_t{0}, templates.size(), [&](std::size_t k) {
    moments[k] = window_moments(fft, map, region, templates[k], window, options.min_valid_weight);
  });
  const std::map<int, Spectrum> levels = level_spectra(fft, region, moments);
  std::vector<ScoreSurface> surfaces(templates.size());
  tbb::parallel_for(std::size_t{0}, templates.size(), [&](std::size_t k) {
    surfaces[k] = paper_surface(fft, levels, region, templates[k], window, moments[k]);
  });
  return surfaces;
}

}  // namespace nadir::cpu
