// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/paper_surface.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "nadir/core/score_volume.hpp"
#include "nadir/map_matching/cpu/correlator.hpp"
#include "nadir/map_matching/cpu/sums.hpp"

namespace nadir::cpu {
namespace {

constexpr double kMinGreyVariance = 1.0;  // grey^2

/// Levels that are correlated at a time: bounds the memory.
constexpr std::size_t kLevelsAtOnce = 8;

/// The window's mean and norm at every position of one template.
struct WindowMoments {
  double count = 0.0;       ///< template pixels
  double local_norm = 0.0;  ///< sum (P - Pm)^2
  Raster<float> deviation;  ///< w |P - Pm|
  Raster<float> mean;       ///< mu(u, v); NaN where the score is undefined
  Raster<float> norm;       ///< sum (R - mu)^2
  Raster<float> valid_weight;
};

struct PaperMapSpectra {
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

CorrelationWindow part_of(const Region& region, const RotatedTemplate& local,
                          const PixelWindow& window) {
  return {local.left - region.place.left, local.top - region.place.top, window.width,
          window.height};
}

WindowMoments window_moments(const Correlator& correlator, const PaperMapSpectra& map,
                             const Region& region, const RotatedTemplate& local,
                             const PixelWindow& window, double min_valid_weight,
                             CorrelatorScratch& scratch) {
  WindowMoments moments;
  moments.count = count_of(local.mask);
  const double local_mean = mean_grey(local.value, local.mask);
  moments.deviation = local.weight;
  for (std::size_t i = 0; i < moments.deviation.values().size(); ++i) {
    const double deviation = std::abs(local.value.values()[i] - local_mean);
    moments.deviation.values()[i] *= static_cast<float>(deviation / kGreyScale);
    moments.local_norm += local.mask.values()[i] * deviation * deviation;
  }

  const Spectrum* const maps[] = {&map.value, &map.squares, &map.seen};
  const Raster<float>* const locals[] = {&local.mask, &local.seen};
  const Product products[] = {{0, 0}, {1, 0}, {2, 1}};
  moments.mean =
      Raster<float>(window.width, window.height, std::numeric_limits<float>::quiet_NaN());
  moments.norm = moments.mean;
  moments.valid_weight = Raster<float>(window.width, window.height);
  correlator.correlate(
      maps, locals, products, part_of(region, local, window),
      [&](int first_row, int rows, std::span<const float* const> sums) {
        const std::size_t first =
            static_cast<std::size_t>(first_row) * static_cast<std::size_t>(window.width);
        const std::size_t count =
            static_cast<std::size_t>(rows) * static_cast<std::size_t>(window.width);
        for (std::size_t i = 0; i < count; ++i) {
          const double share =
              local.total_seen > 0.0 ? std::clamp(sums[2][i] / local.total_seen, 0.0, 1.0) : 0.0;
          moments.valid_weight.values()[first + i] = static_cast<float>(share);
          const double mean = sums[0][i] / moments.count;
          const double norm = (sums[1][i] - moments.count * mean * mean) * kGreyScale * kGreyScale;
          if (share < min_valid_weight || norm < kMinGreyVariance * moments.count ||
              moments.local_norm < kMinGreyVariance * moments.count) {
            continue;
          }
          moments.mean.values()[first + i] =
              static_cast<float>(std::clamp(map.shift + kGreyScale * mean, 0.0, 255.0));
          moments.norm.values()[first + i] = static_cast<float>(norm);
        }
      },
      scratch, true);
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

std::map<int, Spectrum> level_spectra(const Correlator& correlator, const Region& region,
                                      std::span<const WindowMoments> moments,
                                      const StopToken& stop) {
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
    stop.check();
    found->second = correlator.forward(absolute_deviation(region.value, level));
  });
  return spectra;
}

/// The numerator at every position: between integer levels it is linear in the window's mean, so
/// the correlations at the levels below and above interpolate it exactly.
Raster<float> numerator_of(const Correlator& correlator, const std::map<int, Spectrum>& levels,
                           const Region& region, const RotatedTemplate& local,
                           const PixelWindow& window, const WindowMoments& moments,
                           CorrelatorScratch& scratch, const StopToken& stop) {
  std::vector<int> used;
  for (const auto& entry : levels) {
    const auto at = static_cast<float>(entry.first);
    if (std::any_of(moments.mean.values().begin(), moments.mean.values().end(),
                    [at](float mean) { return std::abs(mean - at) < 1.0F; })) {
      used.push_back(entry.first);
    }
  }
  Raster<float> numerator(window.width, window.height);
  const Raster<float>* const locals[] = {&moments.deviation};
  for (std::size_t begin = 0; begin < used.size(); begin += kLevelsAtOnce) {
    stop.check();
    const std::size_t end = std::min(begin + kLevelsAtOnce, used.size());
    std::vector<const Spectrum*> maps;
    std::vector<Product> products;
    for (std::size_t i = begin; i < end; ++i) {
      maps.push_back(&levels.at(used[i]));
      products.push_back({i - begin, 0});
    }
    correlator.correlate(
        maps, locals, products, part_of(region, local, window),
        [&](int first_row, int rows, std::span<const float* const> sums) {
          const std::size_t first =
              static_cast<std::size_t>(first_row) * static_cast<std::size_t>(window.width);
          const std::size_t count =
              static_cast<std::size_t>(rows) * static_cast<std::size_t>(window.width);
          for (std::size_t k = 0; k < sums.size(); ++k) {
            const auto level = static_cast<float>(used[begin + k]);
            for (std::size_t i = 0; i < count; ++i) {
              const float distance = std::abs(moments.mean.values()[first + i] - level);
              if (distance < 1.0F) {
                numerator.values()[first + i] += (1.0F - distance) * sums[k][i];
              }
            }
          }
        },
        scratch, true);
  }
  return numerator;
}

ScoreSurface paper_surface(const Correlator& correlator, const std::map<int, Spectrum>& levels,
                           const Region& region, const RotatedTemplate& local,
                           const PixelWindow& window, const WindowMoments& moments,
                           CorrelatorScratch& scratch, const StopToken& stop) {
  const Raster<float> numerator =
      numerator_of(correlator, levels, region, local, window, moments, scratch, stop);
  ScoreSurface surface{Raster<float>(window.width, window.height, kUndefinedScore),
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
                                         const PixelWindow& window, const StopToken& stop) {
  const Correlator correlator(region.place.period_width, region.place.period_height);
  PaperMapSpectra map;
  map.shift = mean_grey(region.value, region.takes_part);
  const Raster<float> value = shifted(region.value, region.takes_part, map.shift);
  map.value = correlator.forward(value);
  map.squares = correlator.forward(times(value, value));
  map.seen = correlator.forward(region.valid);

  CorrelatorScratch scratch;
  std::vector<WindowMoments> moments;
  for (const RotatedTemplate& local : templates) {
    stop.check();
    moments.push_back(
        window_moments(correlator, map, region, local, window, options.min_valid_weight, scratch));
  }
  const std::map<int, Spectrum> levels = level_spectra(correlator, region, moments, stop);
  std::vector<ScoreSurface> surfaces;
  for (std::size_t k = 0; k < templates.size(); ++k) {
    surfaces.push_back(
        paper_surface(correlator, levels, region, templates[k], window, moments[k], scratch, stop));
  }
  return surfaces;
}

}  // namespace nadir::cpu
