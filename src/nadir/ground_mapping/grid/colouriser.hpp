// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "nadir/ground_mapping/depth/points.hpp"
#include "nadir/ground_mapping/grid/elevation_grid.hpp"
#include "nadir/ground_mapping/options.hpp"

namespace nadir::ground {

struct SampledColour {
  float weight = 0.0F;  ///< 1/m^2; 0 = not seen
  std::array<float, 3> colour{};
};

/// Looks up in an image what colour a place has (equation 12): where it lies inside, in front of
/// the camera and not behind something nearer.
class ViewSampler {
 public:
  /// `view` must outlive the sampler.
  explicit ViewSampler(const ColourView& view)
      : view_(&view), camera_from_odom_(view.odom_from_camera.inverse()) {}

  /// The colour of a square of `side_m` on the ground: bilinear, or the mean where the square
  /// covers more than two pixels.
  SampledColour at(const Point3<frames::Odom>& place, double side_m) const;

 private:
  bool hidden(double u, double v, double depth) const;
  std::array<float, 3> bilinear(double u, double v) const;
  std::array<float, 3> mean(double u, double v, double half_u, double half_v) const;

  const ColourView* view_;
  Transform3<frames::Camera, frames::Odom> camera_from_odom_;
};

/// Colours the cells around the sensor from the views of a frame; cells without a height take part
/// with a height filled across at most `options.fill_cells`. Adjusts the exposure as the forward
/// way does. Returns the gain.
double colour_inversely(ElevationGrid& grid, const Measurement& measurement, double max_range_m,
                        const GroundMappingOptions& options);

}  // namespace nadir::ground
