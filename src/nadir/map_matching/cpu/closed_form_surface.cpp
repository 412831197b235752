// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/closed_form_surface.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "nadir/map_matching/cpu/sums.hpp"

namespace nadir::cpu {
namespace {

/// The map's side of the correlations.
struct MapSpectra {
  Spectrum mask;     ///< of V
  Spectrum value;    ///< of V R'
  Spectrum squares;  ///< of V R'^2
  Spectrum seen;     ///< of what was really seen; empty where that is V
};

MapSpectra map_spectra(const RealFft& fft, const Region& region, double shift, bool seen_apart) {
  const Raster<float> value = shifted(region.value, region.takes_part, shift);
  MapSpectra spectra;
  spectra.mask = fft.forward(region.takes_part);
  spectra.value = fft.forward(value);
  spectra.squares = fft.forward(times(value, value));
  if (seen_apart) spectra.seen = fft.forward(region.valid);
  return spectra;
}

/// One template over the window: runs the correlations it needs and puts the score together.
class TemplateCorrelator {
 public:
  TemplateCorrelator(const RealFft& fft, const MapSpectra& map, const MatchingOptions& options,
                     const Region& region, const RotatedTemplate& local, const PixelWindow& window,
                     double map_shift)
      : fft_(fft),
        map_(map),
        options_(options),
        local_(local),
        window_(window),
        left_(local.left - region.template_left),
        top_(local.top - region.template_top),
        shifts_{map_shift, mean_grey(local.value, local.mask)} {}

  ScoreSurface surface() const {
    const Raster<float>& a = pixel_role(options_).weighted_norms ? local_.weight : local_.mask;
    const Raster<float> unit = shifted(local_.value, local_.mask, shifts_.local);
    const Raster<float> ap = times(a, unit);
    const Spectrum a_spectrum = fft_.forward(a);
    const Spectrum p_spectrum = fft_.forward(ap);
    const Spectrum pp_spectrum = fft_.forward(times(ap, unit));

    std::array<Raster<float>, 9> sums;
    std::vector<std::function<void()>> jobs = {
        [&] { sums[0] = correlate(map_.mask, a_spectrum); },
        [&] { sums[1] = correlate(map_.value, a_spectrum); },
        [&] { sums[2] = correlate(map_.squares, a_spectrum); },
        [&] { sums[3] = correlate(map_.mask, p_spectrum); },
        [&] { sums[4] = correlate(map_.mask, pp_spectrum); },
        [&] { sums[5] = correlate(map_.value, p_spectrum); }};
    Spectrum wp_spectrum;
    if (options_.score == Score::kWncc) {
      wp_spectrum = fft_.forward(times(local_.weight, shifted(local_.value, local_.mask, 0.0)));
      jobs.emplace_back([&] { sums[6] = correlate(map_.mask, wp_spectrum); });
      jobs.emplace_back([&] { sums[7] = correlate(map_.value, wp_spectrum); });
    }
    // The share of what is compared is the sum of weights itself, unless holes take part.
    const bool seen_apart = !map_.seen.empty();
    Spectrum seen_spectrum;
    if (seen_apart) {
      seen_spectrum = fft_.forward(local_.seen);
      jobs.emplace_back([&] { sums[8] = correlate(map_.seen, seen_spectrum); });
    }
    tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t job) { jobs[job](); });
    return assemble(sums, seen_apart ? sums[8] : sums[0]);
  }

 private:
  Raster<float> correlate(const Spectrum& map, const Spectrum& local) const {
    return fft_.correlate(map, local, left_, top_, window_.width, window_.height);
  }

  ScoreSurface assemble(const std::array<Raster<float>, 9>& sums, const Raster<float>& seen) const {
    ScoreSurface surface{
        Raster<float>(window_.width, window_.height, std::numeric_limits<float>::quiet_NaN()),
        Raster<float>(window_.width, window_.height)};
    const auto value = [&](std::size_t which, std::size_t i) -> double {
      return sums[which].empty() ? 0.0 : sums[which].values()[i];
    };
    for (std::size_t i = 0; i < surface.score.values().size(); ++i) {
      const double share = local_.total_seen > 0.0
                               ? std::clamp(seen.values()[i] / local_.total_seen, 0.0, 1.0)
                               : 0.0;
      surface.valid_weight.values()[i] = static_cast<float>(share);
      if (share < options_.min_valid_weight) continue;
      const Sums at{value(0, i), value(1, i), value(2, i), value(3, i),
                    value(4, i), value(5, i), value(6, i), value(7, i)};
      surface.score.values()[i] = static_cast<float>(score_from_sums(options_.score, at, shifts_));
    }
    return surface;
  }

  const RealFft& fft_;
  const MapSpectra& map_;
  const MatchingOptions& options_;
  const RotatedTemplate& local_;
  const PixelWindow& window_;
  int left_;
  int top_;
  Shifts shifts_;
};

}  // namespace

std::vector<ScoreSurface> closed_form_surfaces(const MatchingOptions& options, const Region& region,
                                               std::span<const RotatedTemplate> templates,
                                               const PixelWindow& window) {
  const RealFft fft(region.value.width(), region.value.height());
  const double map_shift = mean_grey(region.value, region.takes_part);
  const MapSpectra spectra = map_spectra(fft, region, map_shift, pixel_role(options).whole_square);
  std::vector<ScoreSurface> surfaces(templates.size());
  tbb::parallel_for(std::size_t{0}, templates.size(), [&](std::size_t k) {
    surfaces[k] = TemplateCorrelator(fft, spectra, options, region, templates[k], window, map_shift)
                      .surface();
  });
  return surfaces;
}

}  // namespace nadir::cpu
