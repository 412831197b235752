// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/overlay.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/report/imagery.hpp"

namespace nadir::report {
namespace {

// Low values leave more of the map to be seen.
constexpr double kLowestOpacity = 0.45;
constexpr double kHighestOpacity = 0.85;

}  // namespace

std::optional<ColourScale> scale_of(const Raster<float>& values, const std::string& name) {
  std::optional<ColourScale> scale;
  for (const float value : values.values()) {
    if (!std::isfinite(value)) continue;
    const auto number = static_cast<double>(value);
    if (!scale) scale = ColourScale{number, number, name};
    scale->low = std::min(scale->low, number);
    scale->high = std::max(scale->high, number);
  }
  return scale;
}

Orthomosaic coloured(const Raster<float>& values, const GeoReference& geo, const ColourScale& scale,
                     ColourMap map) {
  Orthomosaic picture{Raster<std::uint8_t>(values.width(), values.height(), 0, 3),
                      Raster<std::uint8_t>(values.width(), values.height()), geo};
  const double span = scale.high > scale.low ? scale.high - scale.low : 1.0;
  for (int row = 0; row < values.height(); ++row) {
    for (int column = 0; column < values.width(); ++column) {
      const auto value = static_cast<double>(values.at(column, row));
      if (!std::isfinite(value)) continue;
      const Colour colour = mapped_colour(map, (value - scale.low) / span);
      picture.image.at(column, row, 0) = colour.red;
      picture.image.at(column, row, 1) = colour.green;
      picture.image.at(column, row, 2) = colour.blue;
      picture.valid.at(column, row) = 255;
    }
  }
  return picture;
}

void draw_overlay(Canvas& canvas, const MapView& view, const Orthomosaic& picture) {
  const double step =
      1.0 / (view.pixels_per_metre() * Canvas::kOversampling * picture.geo.resolution);
  const PixelCoordinate corner = picture.geo.pixel_at(view.region.west, view.region.north);
  Imagery imagery = resample(picture, {step, 0.0, corner.column, 0.0, step, corner.row},
                             fine_pixels(view.box.width), fine_pixels(view.box.height));
  for (std::size_t i = 0; i < imagery.opacity.values().size(); ++i) {
    // The colour maps are as bright as the value is high.
    const double bright =
        std::max(imagery.colour.values()[3 * i], imagery.colour.values()[3 * i + 1]);
    const double share = kLowestOpacity + (kHighestOpacity - kLowestOpacity) * bright / 255.0;
    std::uint8_t& opacity = imagery.opacity.values()[i];
    opacity = static_cast<std::uint8_t>(std::lround(share * opacity));
  }
  canvas.clip(view.box);
  canvas.image(view.box, imagery.colour, imagery.opacity);
  canvas.unclip();
}

}  // namespace nadir::report
