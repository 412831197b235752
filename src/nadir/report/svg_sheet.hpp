// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "nadir/report/canvas.hpp"

namespace nadir::report {

inline constexpr double kSvgWidth = 480.0;    ///< of every chart
inline constexpr double kSvgBelowAll = 44.0;  ///< below the last plot: tick labels and the x label

/// An SVG document being written. Colours are classes: those of the curves are `c0`, `c1`, …; the
/// style sheet inside has them for light and for dark.
class SvgSheet {
 public:
  SvgSheet(double width, double height, const std::string& title);

  void line(Position from, Position to, std::string_view classes);
  /// A path in SVG's own words.
  void path(const std::string& data, std::string_view classes);
  void disc(Position centre, double radius, std::string_view classes);
  void rectangle(const Box& box, std::string_view classes);
  /// `anchor`: start, middle or end. The text stands on `position.y`.
  void text(Position position, std::string_view text, std::string_view anchor,
            std::string_view classes = {});

  std::string finish() const;

 private:
  std::string content_;
};

/// A coordinate with at most two decimals.
std::string svg_number(double value);

/// "c3" for the fourth curve.
std::string curve_class(std::size_t index);

/// About how wide a text of the sheet is: SVG cannot be asked.
double svg_text_width(std::string_view text);

}  // namespace nadir::report
