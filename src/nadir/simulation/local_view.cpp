// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/local_view.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nadir/core/random.hpp"
#include "nadir/simulation/holes.hpp"
#include "nadir/simulation/paint.hpp"

namespace nadir::simulation {
namespace {

constexpr double kCarHalfLength = 2.2;
constexpr double kCarHalfWidth = 0.9;

/// Bilinear colour at a place of the map; false outside the painted world.
bool sample(const World& world, Point2<frames::Map> point, Colour& colour) {
  const PixelCoordinate pixel = world.geo.pixel_at(point.x, point.y);
  const double column = pixel.column - 0.5;
  const double row = pixel.row - 0.5;
  const int c = static_cast<int>(std::floor(column));
  const int r = static_cast<int>(std::floor(row));
  if (!world.image.contains(c, r) || !world.image.contains(c + 1, r + 1)) return false;
  const auto at = [&](int x, int y) {
    return Colour{static_cast<double>(world.image.at(x, y, 0)),
                  static_cast<double>(world.image.at(x, y, 1)),
                  static_cast<double>(world.image.at(x, y, 2))};
  };
  const Colour top = mix(at(c, r), at(c + 1, r), column - c);
  const Colour bottom = mix(at(c, r + 1), at(c + 1, r + 1), column - c);
  colour = mix(top, bottom, row - r);
  return true;
}

/// Paints the part of a car that covers this place, with darker windows and tyres' shadow.
Colour with_car(const Car& car, Point2<frames::Map> point, Colour colour) {
  const double dx = point.x - car.middle.x;
  const double dy = point.y - car.middle.y;
  const double u = std::cos(car.yaw) * dx + std::sin(car.yaw) * dy;
  const double v = std::cos(car.yaw) * dy - std::sin(car.yaw) * dx;
  constexpr double kCorner = 0.45;
  const double outside = std::hypot(std::max(std::abs(u) - kCarHalfLength + kCorner, 0.0),
                                    std::max(std::abs(v) - kCarHalfWidth + kCorner, 0.0)) -
                         kCorner;
  const double body = 1.0 - smooth_step(-0.05, 0.05, outside);
  const double windows =
      std::max(strip(u, 0.35, 1.0, 0.05), strip(u, -1.6, -1.1, 0.05)) * strip(v, -0.7, 0.7, 0.05);
  const Colour paint{car.colour[0], car.colour[1], car.colour[2]};
  colour = colour * (1.0 - 0.45 * (1.0 - smooth_step(0.0, 0.3, outside)));
  return mix(colour, mix(paint, {34, 38, 44}, windows), body);
}

/// What an ideal camera would see, as floats, and which pixels lie in the world at all.
cv::Mat ideal_view(const World& world, const std::vector<Car>& cars, const Pose2& map_from_robot,
                   Orthomosaic& local) {
  cv::Mat view(local.height(), local.width(), CV_32FC3, cv::Scalar::all(0));
  for (int row = 0; row < local.height(); ++row) {
    for (int column = 0; column < local.width(); ++column) {
      const Point2<frames::Map> point =
          map_from_robot *
          Point2<frames::Robot>{local.geo.x_at(column + 0.5), local.geo.y_at(row + 0.5)};
      Colour colour;
      if (!sample(world, point, colour)) {
        local.valid.at(column, row) = 0;
        continue;
      }
      for (const Car& car : cars) colour = with_car(car, point, colour);
      view.at<cv::Vec3f>(row, column) =
          cv::Vec3f(static_cast<float>(colour.red), static_cast<float>(colour.green),
                    static_cast<float>(colour.blue));
    }
  }
  return view;
}

/// Exposure and sensor noise: most of the noise is common to the three channels.
void expose(const cv::Mat& view, const DriveOptions& options, const RandomStream& random,
            Orthomosaic& local) {
  constexpr double kChromaShare = 0.35;
  std::uint64_t draw = 0;
  for (int row = 0; row < local.height(); ++row) {
    for (int column = 0; column < local.width(); ++column, ++draw) {
      const auto [common, warm] = random.normal_pair(draw);
      for (int channel = 0; channel < 3; ++channel) {
        const double light = view.at<cv::Vec3f>(row, column)[channel] / 255.0;
        const double exposed =
            255.0 * options.exposure_gain * std::pow(std::max(light, 0.0), options.exposure_gamma);
        const double noise = common + kChromaShare * (channel - 1) * warm;
        const double value = exposed + options.noise_grey * noise;
        local.image.at(column, row, channel) =
            static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
      }
    }
  }
}

void blank_holes(Orthomosaic& local) {
  for (int row = 0; row < local.height(); ++row) {
    for (int column = 0; column < local.width(); ++column) {
      if (local.valid.at(column, row) != 0) continue;
      for (int channel = 0; channel < 3; ++channel) local.image.at(column, row, channel) = 0;
    }
  }
}

}  // namespace

Orthomosaic view_from(const World& world, const std::vector<Car>& cars, const Pose2& map_from_robot,
                      const DriveOptions& options, std::uint64_t seed, int frame) {
  const int side = static_cast<int>(std::lround(options.local_size_m / options.local_resolution_m));
  const double half = 0.5 * side * options.local_resolution_m;
  Orthomosaic local{Raster<std::uint8_t>(side, side, 0, 3),
                    Raster<std::uint8_t>(side, side, 255),
                    {-half, half, options.local_resolution_m, {}}};
  cv::Mat view = ideal_view(world, cars, map_from_robot, local);
  if (options.blur_px > 0.0) cv::GaussianBlur(view, view, {0, 0}, options.blur_px);
  expose(view, options, RandomStream(seed, stream_of(Source::kSensorNoise, frame)), local);
  punch_holes(options.hole_share, seed, frame, local.valid);
  blank_holes(local);
  return local;
}

}  // namespace nadir::simulation
