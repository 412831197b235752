// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/closed_form_surface.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/core/score_volume.hpp"
#include "nadir/map_matching/cpu/map_cache.hpp"
#include "nadir/map_matching/cpu/region.hpp"
#include "nadir/map_matching/cpu/sums.hpp"

namespace nadir::cpu {
namespace {

/// Larger windows are worked on in tiles, so that a transform is about this long at most.
constexpr int kLongestTransform = 2048;
constexpr int kSmallestTile = 512;

/// What the headings that are worked on at the same time may take, bytes; one always may.
constexpr std::size_t kScratchBudget = std::size_t{256} << 20U;

/// The cosine scores remove no mean: over grey values as they are, sums of positive numbers, four
/// correlations do (sum a, sum R^2, sum P^2 and the product), and nothing cancels.
bool is_cosine(Score score) { return score == Score::kNcc || score == Score::kWncc; }
constexpr Product kCosineProducts[] = {{0, 0}, {2, 0}, {0, 1}, {1, 2}};

std::shared_ptr<const MapSpectra> compute_spectra(const MapIndex& map, const RegionPlace& place,
                                                  const PixelWindow& window) {
  const bool whole_square = pixel_role(map.options()).whole_square;
  const Region region = cut_region(map.channel(), place, window, whole_square);
  auto spectra = std::make_shared<MapSpectra>(
      MapSpectra{Correlator(place.period_width, place.period_height),
                 is_cosine(map.options().score) ? 0.0 : map.mean_grey()});
  const Raster<float> value = shifted(region.value, region.takes_part, spectra->shift);
  spectra->mask = spectra->correlator.forward(region.takes_part);
  spectra->value = spectra->correlator.forward(value);
  spectra->squares = spectra->correlator.forward(times(value, value));
  if (whole_square) spectra->seen = spectra->correlator.forward(region.valid);
  return spectra;
}

/// The images of a template whose spectra take part, and the products of them with the map's.
struct LocalImages {
  std::vector<Raster<float>> images;  ///< a, a P', a P'^2, then what was seen if not a
  std::vector<Product> products{std::begin(kZeroMeanProducts), std::end(kZeroMeanProducts)};
  int seen = 0;  ///< index of the product that says what was really seen
};

constexpr std::size_t kSeenSpectrum = 3;  // after V, V R', V R'^2

LocalImages local_images(const MatchingOptions& options, const RotatedTemplate& local,
                         double shift) {
  LocalImages result;
  const PixelRole role = pixel_role(options);
  const Raster<float>& a = role.weighted_norms ? local.weight : local.mask;
  const Raster<float> unit = shifted(local.value, local.mask, shift);
  Raster<float> ap = times(a, unit);
  Raster<float> app = times(ap, unit);
  result.images.push_back(a);
  result.images.push_back(std::move(ap));
  result.images.push_back(std::move(app));
  // The share of what is compared is the sum of weights itself, unless holes take part.
  if (role.whole_square) {
    result.seen = static_cast<int>(result.products.size());
    result.products.push_back({kSeenSpectrum, result.images.size()});
    result.images.push_back(local.seen);
  }
  return result;
}

/// a, P^2 and w P, of grey values divided by 64.
LocalImages cosine_images(const MatchingOptions& options, const RotatedTemplate& local) {
  const Raster<float> unit = shifted(local.value, local.mask, 0.0);
  LocalImages result;
  result.images = {local.mask, times(unit, unit),
                   options.score == Score::kWncc ? times(local.weight, unit) : unit};
  result.products.assign(std::begin(kCosineProducts), std::end(kCosineProducts));
  return result;
}

/// sum w R P / sqrt(sum R^2 sum P^2)
float cosine(double map_norm, double local_norm, double product) {
  constexpr double kNothing = 1e-6;  // rounding about zero: one grey value of 1 adds 2.4e-4
  if (map_norm <= kNothing || local_norm <= kNothing) return kUndefinedScore;
  return static_cast<float>(product / std::sqrt(map_norm * local_norm));
}

/// Puts rows of sums together to scores, in double.
void assemble(const MatchingOptions& options, const LocalImages& images, const Shifts& shifts,
              double total_seen, std::span<const float* const> sums, std::size_t count,
              float* score, float* valid_weight) {
  const auto at = [&](int k, std::size_t i) {
    return static_cast<double>(sums[static_cast<std::size_t>(k)][i]);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double share =
        total_seen > 0.0 ? std::clamp(at(images.seen, i) / total_seen, 0.0, 1.0) : 0.0;
    valid_weight[i] = static_cast<float>(share);
    if (share < options.min_valid_weight) continue;
    if (is_cosine(options.score)) {
      score[i] = cosine(at(1, i), at(2, i), at(3, i));
      continue;
    }
    const Sums values{at(0, i), at(1, i), at(2, i), at(3, i), at(4, i), at(5, i)};
    score[i] = static_cast<float>(score_from_sums(options.score, values, shifts));
  }
}

ScoreSurface surface_of(const MapSpectra& map, const MatchingOptions& options,
                        const RegionPlace& place, const RotatedTemplate& local,
                        const PixelWindow& window, CorrelatorScratch& scratch, bool parallel) {
  const Shifts shifts{map.shift, mean_grey(local.value, local.mask)};
  const LocalImages images = is_cosine(options.score) ? cosine_images(options, local)
                                                      : local_images(options, local, shifts.local);
  std::vector<const Raster<float>*> locals;
  for (const Raster<float>& image : images.images) locals.push_back(&image);
  std::vector<const Spectrum*> maps = {&map.mask, &map.value, &map.squares};
  if (!map.seen.empty()) maps.push_back(&map.seen);
  const CorrelationWindow part{local.left - place.left, local.top - place.top, window.width,
                               window.height};

  ScoreSurface surface{Raster<float>(window.width, window.height, kUndefinedScore),
                       Raster<float>(window.width, window.height)};
  if (options.score == Score::kZncc || options.score == Score::kZwncc) {
    map.correlator.zero_mean(maps, locals, part, local.total_seen, options.min_valid_weight,
                             surface.score, surface.valid_weight, scratch, parallel);
    return surface;
  }
  map.correlator.correlate(
      maps, locals, images.products, part,
      [&](int row, int rows, std::span<const float* const> sums) {
        assemble(options, images, shifts, local.total_seen, sums,
                 static_cast<std::size_t>(rows) * static_cast<std::size_t>(window.width),
                 surface.score.row(row).data(), surface.valid_weight.row(row).data());
      },
      scratch, parallel);
  return surface;
}

/// Surfaces over a window that one transform holds.
std::vector<ScoreSurface> tile_surfaces(const MapIndex& map,
                                        std::span<const RotatedTemplate> templates,
                                        const PixelWindow& window, const StopToken& stop) {
  const MatchingOptions& options = map.options();
  const bool whole_square = pixel_role(options).whole_square;
  const RegionPlace place =
      place_region(map.channel(), templates, window,
                   whole_square ? RegionExtent::kWhole : RegionExtent::kWithinMap);
  const Raster<std::uint8_t>& whole = map.channel().value;
  const bool whole_map =
      !whole_square && place.width == whole.width() && place.height == whole.height();
  const auto compute = [&] { return compute_spectra(map, place, window); };
  // Another backend's where the index was made for that one.
  auto* const cache = dynamic_cast<MapCache*>(map.prepared());
  const std::shared_ptr<const MapSpectra> spectra =
      whole_map && cache != nullptr
          ? cache->whole_map(cheapest_fft_size(static_cast<std::size_t>(place.period_width),
                                               static_cast<std::size_t>(place.period_height)),
                             compute)
          : compute();

  // Slots, each with its memory, work on headings at the same time.
  const TemplateBounds bounds = bounds_of(templates);
  const std::size_t a_slot = spectra->correlator.scratch_bytes(
      std::size(kZeroMeanProducts) + 3, 5, static_cast<std::size_t>(bounds.bottom - bounds.top),
      static_cast<std::size_t>(window.height));
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t slots =
      std::max<std::size_t>(1, std::min({templates.size(), threads, kScratchBudget / a_slot}));
  std::vector<ScoreSurface> surfaces(templates.size());
  tbb::parallel_for(std::size_t{0}, slots, [&](std::size_t slot) {
    CorrelatorScratch scratch;
    for (std::size_t k = slot; k < templates.size(); k += slots) {
      stop.check();
      surfaces[k] =
          surface_of(*spectra, options, place, templates[k], window, scratch, slots < threads);
    }
  });
  return surfaces;
}

void paste(const Raster<float>& tile, int left, int top, Raster<float>& whole) {
  for (int row = 0; row < tile.height(); ++row) {
    const auto from = tile.row(row);
    std::copy(from.begin(), from.end(), whole.row(top + row).begin() + left);
  }
}

}  // namespace

std::vector<ScoreSurface> closed_form_surfaces(const MapIndex& map,
                                               std::span<const RotatedTemplate> templates,
                                               const PixelWindow& window, const StopToken& stop) {
  const TemplateBounds bounds = bounds_of(templates);
  const int width = std::max(kSmallestTile, kLongestTransform - (bounds.right - bounds.left));
  const int height = std::max(kSmallestTile, kLongestTransform - (bounds.bottom - bounds.top));
  if (window.width <= width && window.height <= height) {
    return tile_surfaces(map, templates, window, stop);
  }
  std::vector<ScoreSurface> surfaces(templates.size(),
                                     {Raster<float>(window.width, window.height, kUndefinedScore),
                                      Raster<float>(window.width, window.height)});
  for (int top = 0; top < window.height; top += height) {
    for (int left = 0; left < window.width; left += width) {
      const std::vector<ScoreSurface> tiles =
          tile_surfaces(map, templates,
                        {window.left + left, window.top + top, std::min(width, window.width - left),
                         std::min(height, window.height - top)},
                        stop);
      for (std::size_t k = 0; k < tiles.size(); ++k) {
        paste(tiles[k].score, left, top, surfaces[k].score);
        paste(tiles[k].valid_weight, left, top, surfaces[k].valid_weight);
      }
    }
  }
  return surfaces;
}

}  // namespace nadir::cpu
