// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/report/ticks.hpp"

namespace nadir::report {
namespace {

/// Share of its size by which a curve must vary to be more than flat.
constexpr double kFlat = 1e-3;

template <class Whole>
std::vector<Run> runs_where(std::size_t length, Whole&& whole) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < length; ++i) {
    if (!whole(i)) continue;
    const std::size_t first = i;
    while (i < length && whole(i)) ++i;
    runs.emplace_back(first, i);
  }
  return runs;
}

}  // namespace

void Interval::include(double value) {
  if (!std::isfinite(value)) return;
  low = empty ? value : std::min(low, value);
  high = empty ? value : std::max(high, value);
  empty = false;
}

bool Interval::is_point() const {
  return high - low <= 1e-9 * std::max(std::abs(low), std::abs(high));
}

std::size_t length_of(const Curve& curve) { return std::min(curve.x.size(), curve.y.size()); }

std::size_t length_of(const Band& band) {
  return std::min({band.x.size(), band.low.size(), band.high.size()});
}

std::vector<Run> whole_runs(const Curve& curve) {
  return runs_where(length_of(curve), [&](std::size_t i) {
    return std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]);
  });
}

std::vector<Run> whole_runs(const Band& band) {
  return runs_where(length_of(band), [&](std::size_t i) {
    return std::isfinite(band.x[i]) && std::isfinite(band.low[i]) && std::isfinite(band.high[i]);
  });
}

std::vector<Key> keys_of(const Panel& panel) {
  std::vector<Key> keys;
  for (std::size_t i = 0; i < panel.bands.size(); ++i) {
    if (!panel.bands[i].name.empty()) keys.push_back({panel.bands[i].name, true, i});
  }
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    if (!panel.curves[i].name.empty()) keys.push_back({panel.curves[i].name, false, i});
  }
  return keys;
}

Interval x_interval(const std::vector<Panel>& panels) {
  Interval interval;
  for (const Panel& panel : panels) {
    for (const Curve& curve : panel.curves) {
      for (std::size_t i = 0; i < length_of(curve); ++i) interval.include(curve.x[i]);
    }
    for (const Band& band : panel.bands) {
      for (std::size_t i = 0; i < length_of(band); ++i) interval.include(band.x[i]);
    }
  }
  if (interval.empty) return {0.0, 1.0, true};
  if (interval.is_point()) return {interval.low - 0.5, interval.high + 0.5, false};
  return interval;
}

Interval y_interval(const Panel& panel, double& step) {
  Interval data;
  for (const Curve& curve : panel.curves) {
    for (std::size_t i = 0; i < length_of(curve); ++i) {
      if (std::isfinite(curve.x[i])) data.include(curve.y[i]);
    }
  }
  for (const Band& band : panel.bands) {
    for (std::size_t i = 0; i < length_of(band); ++i) {
      if (!std::isfinite(band.x[i])) continue;
      data.include(band.low[i]);
      data.include(band.high[i]);
    }
  }
  const bool empty = data.empty;
  if (empty) data = {0.0, 1.0, true};
  if (data.low > 0.0 && data.low < 0.6 * data.high) data.low = 0.0;
  if (data.high < 0.0 && data.high > 0.6 * data.low) data.high = 0.0;
  // A curve that only its last digits move is flat: they must not become the scale.
  const double size = std::max(std::abs(data.low), std::abs(data.high));
  if (data.is_point() || data.high - data.low < kFlat * size) {
    const double half = std::max(0.5, 0.1 * size);
    data = {data.low - half, data.high + half, data.empty};
  }
  step = nice_step(data.high - data.low, 4);
  return {step * std::floor(data.low / step + 1e-9), step * std::ceil(data.high / step - 1e-9),
          empty};
}

Colour curve_colour(std::size_t index) {
  constexpr std::array<Colour, kCurveColours> kColours{kVermillion, kBlue,   kGreen,
                                                       kPurple,     kOrange, kSkyBlue};
  return kColours[index % kColours.size()];
}

}  // namespace nadir::report
