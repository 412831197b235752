// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/surroundings.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"

namespace nadir::simulation {
namespace {

constexpr double kShadowPerHeight = 0.75;  ///< cotangent of the sun's elevation
constexpr double kShadowDarkness = 0.52;
constexpr int kOutlineCorners = 40;
constexpr int kSubpixelBits = 4;

enum Layer : std::uint32_t { kOutline = 60, kClumps, kLeaves, kRoof };

using Polygon = std::vector<Point2<frames::Map>>;

struct Tree {
  Point2<frames::Map> middle;
  double radius = 0.0;
  double hue = 0.0;  ///< 0 dark green .. 1 yellowish
};

struct Building {
  Point2<frames::Map> middle;
  double yaw = 0.0;
  double half_length = 0.0;
  double half_width = 0.0;
  double height = 0.0;
};

/// Trees on a jittered grid, off the road and its footways.
std::vector<Tree> plant(const Place& place) {
  constexpr double kGrid = 6.5;
  const RandomStream random(place.seed, stream_of(Source::kTrees));
  std::vector<Tree> trees;
  std::uint64_t draw = 0;
  for (int row = 0; row * kGrid < place.width_m; ++row) {
    for (int column = 0; column * kGrid < place.length_m; ++column, draw += 3) {
      const auto [u, v] = random.uniform_pair(draw);
      const auto [keep, size] = random.uniform_pair(draw + 1);
      const Tree tree{{column * kGrid + kGrid * u, row * kGrid + kGrid * v},
                      1.1 + 2.3 * size,
                      random.uniform(draw + 2)};
      const double distance = std::abs(place.road.locate(tree.middle).across);
      if (keep < 0.42 && distance > kEdgingOuter + 0.8 * tree.radius) trees.push_back(tree);
    }
  }
  return trees;
}

std::vector<Building> build(const Place& place) {
  const RandomStream random(place.seed, stream_of(Source::kBuildings));
  std::vector<Building> buildings;
  std::uint64_t draw = 0;
  const double first = place.road.along_at(0.0);
  double along = first + random.uniform(draw++, 10.0, 30.0);
  while (along < first + place.length_m) {
    const double side = random.uniform(draw++) < 0.5 ? -1.0 : 1.0;
    Building building;
    building.middle = place.road.place({along, side * random.uniform(draw++, 18.0, 21.0)});
    building.yaw = place.road.heading(along) + random.uniform(draw++, -0.08, 0.08);
    building.half_length = random.uniform(draw++, 6.0, 10.0);
    building.half_width = random.uniform(draw++, 3.5, 5.5);
    building.height = random.uniform(draw++, 3.5, 6.0);
    buildings.push_back(building);
    along += random.uniform(draw++, 45.0, 70.0);
  }
  return buildings;
}

Polygon outline(const Building& building) {
  Polygon polygon;
  const Transform2<frames::Map, frames::Map> turn{building.middle.x, building.middle.y,
                                                  building.yaw};
  for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    polygon.push_back(turn *
                      Point2<frames::Map>{x * building.half_length, y * building.half_width});
  }
  return polygon;
}

/// Distance of a crown's edge from its trunk in a direction: lobed, different for each tree.
double crown_radius(const Place& place, const Tree& tree, double angle) {
  const double lobes = place.noise.fractal(tree.middle.x + 2.0 * std::cos(angle),
                                           tree.middle.y + 2.0 * std::sin(angle), 1.6, 3, kOutline);
  return tree.radius * (1.0 + 0.32 * lobes);
}

Polygon outline(const Place& place, const Tree& tree) {
  Polygon polygon;
  for (int i = 0; i < kOutlineCorners; ++i) {
    const double angle = 2.0 * kPi * i / kOutlineCorners;
    const double radius = crown_radius(place, tree, angle);
    polygon.push_back(
        {tree.middle.x + radius * std::cos(angle), tree.middle.y + radius * std::sin(angle)});
  }
  return polygon;
}

/// Fills the outline where its shadow falls from `height` metres above the ground.
void cast(const Place& place, const Painting& painting, const Polygon& polygon, double height,
          cv::Mat& mask) {
  constexpr double kOne = 1U << kSubpixelBits;
  const double east = -kShadowPerHeight * height * std::cos(place.sun_azimuth);
  const double north = -kShadowPerHeight * height * std::sin(place.sun_azimuth);
  std::vector<cv::Point> points;
  for (const Point2<frames::Map>& corner : polygon) {
    const PixelCoordinate pixel = painting.geo.pixel_at(corner.x + east, corner.y + north);
    points.emplace_back(cvRound((pixel.column - 0.5) * kOne), cvRound((pixel.row - 0.5) * kOne));
  }
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{points}, cv::Scalar(255), cv::LINE_AA,
               kSubpixelBits);
}

cv::Mat shadow_mask(const Place& place, const Painting& painting, const std::vector<Tree>& trees,
                    const std::vector<Building>& buildings) {
  cv::Mat mask(painting.image.height(), painting.image.width(), CV_8U, cv::Scalar(0));
  for (const Building& building : buildings) {
    constexpr double kSlice = 0.25;  // swept in slices: a prism's shadow
    for (int slice = 0; slice * kSlice <= building.height; ++slice) {
      cast(place, painting, outline(building), slice * kSlice, mask);
    }
  }
  for (const Tree& tree : trees) {
    const Polygon crown = outline(place, tree);
    for (const double height : {0.8, 1.2, 1.6}) {
      cast(place, painting, crown, height * tree.radius, mask);
    }
  }
  cv::GaussianBlur(mask, mask, {0, 0}, 2.5);
  return mask;
}

void paint_shadows(const cv::Mat& mask, Painting& painting) {
  for (int row = 0; row < mask.rows; ++row) {
    for (int column = 0; column < mask.cols; ++column) {
      const double shade = kShadowDarkness * mask.at<std::uint8_t>(row, column) / 255.0;
      if (shade <= 0.0) continue;
      const Colour lit = painting.colour(column, row);
      // What light is left comes from the sky, so shadows are a little blue.
      painting.set(column, row,
                   {lit.red * (1.0 - shade), lit.green * (1.0 - 0.96 * shade),
                    lit.blue * (1.0 - 0.88 * shade)});
    }
  }
}

/// Calls `paint(column, row, point)` for the pixels within `radius` metres of `middle`.
template <class Paint>
void for_pixels_around(Painting& painting, Point2<frames::Map> middle, double radius,
                       const Paint& paint) {
  const PixelCoordinate corner = painting.geo.pixel_at(middle.x - radius, middle.y + radius);
  const int side = static_cast<int>(std::ceil(2.0 * radius / painting.geo.resolution)) + 1;
  const int west = static_cast<int>(std::floor(corner.column));
  const int north = static_cast<int>(std::floor(corner.row));
  for (int row = std::max(north, 0); row < std::min(north + side, painting.image.height()); ++row) {
    for (int column = std::max(west, 0); column < std::min(west + side, painting.image.width());
         ++column) {
      paint(column, row, painting.centre(column, row));
    }
  }
}

void paint_building(const Place& place, const Building& building, Painting& painting) {
  const double reach = std::hypot(building.half_length, building.half_width) + 0.2;
  const double c = std::cos(building.yaw);
  const double s = std::sin(building.yaw);
  for_pixels_around(painting, building.middle, reach, [&](int column, int row, auto p) {
    const double dx = p.x - building.middle.x;
    const double dy = p.y - building.middle.y;
    const double inside = std::min(building.half_length - std::abs(c * dx + s * dy),
                                   building.half_width - std::abs(c * dy - s * dx));
    const double covered = smooth_step(-0.03, 0.03, inside);
    if (covered <= 0.0) return;
    const double stain = place.noise.fractal(p.x, p.y, 3.0, 5, kRoof);
    const double parapet = 1.0 - smooth_step(0.28, 0.36, inside);
    const double gutter = strip(inside, 0.36, 0.62, 0.08);
    const Colour roof = mix(Colour{148, 142, 134}, {196, 190, 181}, parapet);
    painting.set(
        column, row,
        mix(painting.colour(column, row), roof * (1.0 + 0.12 * stain - 0.22 * gutter), covered));
  });
}

/// A crown: a lobed dome of leaf clumps, lit from the sun's side.
void paint_tree(const Place& place, const Tree& tree, Painting& painting) {
  const Colour leaves = mix({58, 82, 42}, {98, 112, 54}, tree.hue);
  for_pixels_around(painting, tree.middle, 1.4 * tree.radius, [&](int column, int row, auto p) {
    const double dx = p.x - tree.middle.x;
    const double dy = p.y - tree.middle.y;
    const double radius = crown_radius(place, tree, std::atan2(dy, dx));
    const double clumps = place.noise.fractal(p.x, p.y, 0.9, 2, kClumps);
    const double fine = place.noise.fractal(p.x, p.y, 0.22, 2, kLeaves);
    const double out = std::hypot(dx, dy) / radius + 0.12 * clumps + 0.06 * fine;
    const double covered = 1.0 - smooth_step(0.93, 1.0, out);
    if (covered <= 0.0) return;
    const double towards_sun =
        (dx * std::cos(place.sun_azimuth) + dy * std::sin(place.sun_azimuth)) / radius;
    const double light =
        0.98 + 0.42 * towards_sun + 0.45 * clumps + 0.38 * fine - 0.25 * smooth_step(0.6, 1.0, out);
    painting.set(column, row,
                 mix(painting.colour(column, row), leaves * std::max(light, 0.22), covered));
  });
}

}  // namespace

void paint_surroundings(const Place& place, Painting& painting) {
  const std::vector<Building> buildings = build(place);
  std::vector<Tree> trees = plant(place);
  std::erase_if(trees, [&](const Tree& tree) {
    return std::any_of(buildings.begin(), buildings.end(), [&](const Building& building) {
      return std::hypot(tree.middle.x - building.middle.x, tree.middle.y - building.middle.y) <
             building.half_length + tree.radius;
    });
  });
  paint_shadows(shadow_mask(place, painting, trees, buildings), painting);
  for (const Building& building : buildings) paint_building(place, building, painting);
  for (const Tree& tree : trees) paint_tree(place, tree, painting);
}

}  // namespace nadir::simulation
