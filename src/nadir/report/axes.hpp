// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "nadir/report/canvas.hpp"
#include "nadir/report/figures.hpp"

namespace nadir::report {

/// What an axis reaches over; empty until something finite is included.
struct Interval {
  double low = 0.0;
  double high = 0.0;
  bool empty = true;

  void include(double value);
  /// One value, up to the rounding of how it was computed: too short for an axis.
  bool is_point() const;
};

/// The samples that a curve or band has all coordinates of.
std::size_t length_of(const Curve& curve);
std::size_t length_of(const Band& band);

/// Where all coordinates of a curve or band are finite: [first, last) of every run without a gap.
using Run = std::pair<std::size_t, std::size_t>;
std::vector<Run> whole_runs(const Curve& curve);
std::vector<Run> whole_runs(const Band& band);

/// An entry of a panel's legend.
struct Key {
  std::string name;
  bool is_band = false;
  std::size_t index = 0;  ///< among the curves or the bands
};

/// Of everything in the panel that has a name.
std::vector<Key> keys_of(const Panel& panel);

/// The x axis that panels share: all of the data and no more, and never of no length.
Interval x_interval(const std::vector<Panel>& panels);

/// The y axis reaches over whole steps, and down or up to zero where that is near. `step` becomes
/// the distance of its ticks.
Interval y_interval(const Panel& panel, double& step);

/// One plot: where its data coordinates lie in the figure.
struct Plot {
  Box box;
  Interval x;
  Interval y;

  Position at(double across, double up) const {
    return {box.left + (across - x.low) / (x.high - x.low) * box.width,
            box.bottom() - (up - y.low) / (y.high - y.low) * box.height};
  }
};

/// The colour of the `index`th curve on paper; repeats after six. Unlike the tracks on a map:
/// yellow is too light for a line on white.
Colour curve_colour(std::size_t index);
inline constexpr std::size_t kCurveColours = 6;

/// Of every band.
inline constexpr Colour kBandColour = kSkyBlue;
inline constexpr double kBandOpacity = 0.30;

}  // namespace nadir::report
