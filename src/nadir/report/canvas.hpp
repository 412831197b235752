// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nadir/core/raster.hpp"
#include "nadir/report/colours.hpp"

namespace nadir::report {

/// A place in a figure: pixels from its upper left corner, x to the right, y downwards.
struct Position {
  double x = 0.0;
  double y = 0.0;
};

/// An upright rectangle of a figure, pixels.
struct Box {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;

  double right() const { return left + width; }
  double bottom() const { return top + height; }
  Position centre() const { return {left + 0.5 * width, top + 0.5 * height}; }
  std::vector<Position> corners() const {
    return {{left, top}, {right(), top}, {right(), bottom()}, {left, bottom()}};
  }
  Box inset(double margin) const {
    return {left + margin, top + margin, width - 2.0 * margin, height - 2.0 * margin};
  }
};

enum class Align { kLeft, kCentre, kRight };

struct TextStyle {
  double size = 22.0;  ///< pixels; capitals are 0.7 of it
  Colour colour = kInk;
  Align align = Align::kLeft;
  bool bold = false;
  std::optional<Colour> halo;
};

struct Stroke {
  Colour colour = kInk;
  double width = 2.0;          ///< pixels
  std::optional<Colour> halo;  ///< drawn around the line, to part it from imagery
  double dash = 0.0;           ///< length of a dash and of a gap; 0 = solid
};

/// A sheet to draw on with antialiasing, in the pixels of the finished figure. Points that are not
/// finite interrupt lines and are otherwise not drawn.
class Canvas {
 public:
  /// The sheet is kept this much finer than the finished figure.
  static constexpr int kOversampling = 2;

  Canvas(int width, int height, Colour background = kPaper);

  int width() const { return sheet_.width() / kOversampling; }
  int height() const { return sheet_.height() / kOversampling; }

  /// Nothing is drawn outside `box` until `unclip`.
  void clip(const Box& box);
  void unclip();

  void line(const std::vector<Position>& points, const Stroke& stroke);
  void outline(const std::vector<Position>& corners, const Stroke& stroke);
  void fill(const std::vector<Position>& corners, Colour colour, double opacity = 1.0);
  void disc(Position centre, double radius, Colour colour, double opacity = 1.0);
  void ring(Position centre, double radius, const Stroke& stroke);
  void arrow(Position tail, Position tip, const Stroke& stroke);

  /// The text's capitals are centred vertically on `position.y`. UTF-8 in; what the font lacks is
  /// spelled in ASCII.
  void text(Position position, std::string_view text, const TextStyle& style);
  /// The same, made smaller and then cut so as not to be wider than `width`.
  void fitted_text(Position position, std::string_view text, double width, TextStyle style);

  /// Lays an RGB image over `box`, with one value of `opacity` (0 .. 255) a pixel. Both have the
  /// sheet's pixels: fine_pixels(box.width) x fine_pixels(box.height).
  void image(const Box& box, const Raster<std::uint8_t>& image,
             const Raster<std::uint8_t>& opacity);

  /// The finished figure: RGB.
  Raster<std::uint8_t> finish() const;

 private:
  void plain_line(const std::vector<Position>& points, Colour colour, double width);

  Raster<std::uint8_t> sheet_;
  Box clip_;
};

/// Number of sheet pixels across a length in figure pixels.
int fine_pixels(double length);

/// Width of a text in pixels.
double text_width(std::string_view text, const TextStyle& style);

inline constexpr double kFine = Canvas::kOversampling;  ///< fine pixels per pixel

}  // namespace nadir::report
