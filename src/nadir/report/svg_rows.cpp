// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "nadir/report/axes.hpp"
#include "nadir/report/charts.hpp"
#include "nadir/report/svg_sheet.hpp"
#include "nadir/report/ticks.hpp"

namespace nadir {
namespace {

using namespace report;

constexpr double kTop = 8.0;
constexpr double kRowHeight = 30.0;
constexpr double kValueRoom = 66.0;  ///< right of the plot: the numbers
constexpr double kLeastNameRoom = 60.0;
constexpr double kMostNameRoom = 190.0;

std::vector<double> sorted_values(const Sample& sample) {
  std::vector<double> values;
  std::ranges::copy_if(sample.values, std::back_inserter(values),
                       [](double value) { return std::isfinite(value) && value >= 0.0; });
  std::ranges::sort(values);
  return values;
}

/// Between the two nearest values, as NumPy has it.
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

std::string three_digits(double value) {
  std::array<char, 32> text{};
  const int decimals = value >= 100.0 ? 0 : static_cast<int>(value < 10.0) + 1;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

void draw_box(SvgSheet& sheet, const Plot& plot, const std::vector<double>& values, double y,
              std::size_t index) {
  const auto at = [&](double value) { return plot.at(value, 0.0).x; };
  const double half = 8.0;
  if (values.size() == 1) {
    const double end = at(values.front());
    sheet.rectangle({plot.box.left, y - half, end - plot.box.left, 2.0 * half},
                    "dot " + curve_class(index));
    return;
  }
  const double lower = at(quantile(values, 0.25));
  const double upper = at(quantile(values, 0.75));
  const double median = at(quantile(values, 0.5));
  sheet.line({at(quantile(values, 0.05)), y}, {lower, y}, "curve " + curve_class(index));
  sheet.line({upper, y}, {at(quantile(values, 0.95)), y}, "curve " + curve_class(index));
  sheet.rectangle({lower, y - half, upper - lower, 2.0 * half}, "box " + curve_class(index));
  sheet.line({median, y - half}, {median, y + half}, "median " + curve_class(index));
  sheet.disc({at(values.back()), y}, 2.0, "dot " + curve_class(index));
}

void draw_axis(SvgSheet& sheet, const Plot& plot, double step) {
  for (const double x : ticks_between(plot.x.low, plot.x.high, step)) {
    const double at = plot.at(x, 0.0).x;
    sheet.line({at, plot.box.top}, {at, plot.box.bottom()}, "grid");
    sheet.text({at, plot.box.bottom() + 15.0}, tick_label(x, step), "middle", "muted");
  }
  sheet.line({plot.box.left, plot.box.top}, {plot.box.left, plot.box.bottom()}, "frame");
}

}  // namespace

std::string svg_rows(const std::vector<Sample>& samples, const std::string& x_label,
                     const std::string& title) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, samples.size()));
  double names = kLeastNameRoom;
  Interval x{0.0, 0.0, true};
  for (const Sample& sample : samples) {
    names = std::max(names, svg_text_width(sample.name) + 12.0);
    for (const double value : sorted_values(sample)) x.include(value);
  }
  names = std::min(names, kMostNameRoom);
  const double step = nice_step(x.high > 0.0 ? x.high : 1.0, 5);
  SvgSheet sheet(kSvgWidth, kTop + count * kRowHeight + kSvgBelowAll, title);
  const Plot plot{{names, kTop, kSvgWidth - names - kValueRoom, count * kRowHeight},
                  {0.0, x.high > 0.0 ? x.high : 1.0, x.empty},
                  {0.0, 1.0, false}};
  draw_axis(sheet, plot, step);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::vector<double> values = sorted_values(samples[i]);
    const double y = kTop + kRowHeight * (static_cast<double>(i) + 0.5);
    sheet.text({names - 8.0, y + 4.0}, samples[i].name, "end");
    if (!values.empty()) draw_box(sheet, plot, values, y, i);
    sheet.text({kSvgWidth - 4.0, y + 4.0},
               values.empty() ? "no value" : three_digits(quantile(values, 0.5)), "end", "bold");
  }
  if (samples.empty()) {
    sheet.text({0.5 * kSvgWidth, kTop + 0.5 * kRowHeight}, "nothing to show", "middle", "muted");
  }
  sheet.text({plot.box.centre().x, plot.box.bottom() + 34.0}, x_label, "middle");
  return sheet.finish();
}

}  // namespace nadir
