// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/ground.hpp"

#include <cmath>

#include "nadir/core/random.hpp"

namespace nadir::simulation {
namespace {

// One texture layer a purpose: equal layers would show the same blotches twice.
enum Layer : std::uint32_t {
  kMeadow = 1,
  kDryness,
  kTufts,
  kBlades,
  kBareSoil,
  kAsphaltStain,
  kAsphaltGrain,
  kAsphaltWear,
  kSlabs,
  kSlabStain,
  kKerbStain,
  kGravel,
  kGravelStain,
  kPathEdge,
  kCreep,
};

constexpr double kSoft = 0.04;  ///< half the width of the edge between two materials

struct Patch {
  RoadPoint centre;
  double half_length;
  double half_width;
  double tone;
};

class Ground {
 public:
  explicit Ground(const Place& place);
  Colour colour_at(Point2<frames::Map> p) const;

 private:
  Colour grass(Point2<frames::Map> p) const;
  Colour gravel(Point2<frames::Map> p) const;
  Colour pavement(RoadPoint at, Point2<frames::Map> p) const;
  Colour kerb(RoadPoint at, Point2<frames::Map> p) const;
  Colour asphalt(RoadPoint at, Point2<frames::Map> p) const;
  double patched(RoadPoint at, double tone) const;
  Colour open_ground(RoadPoint at, Point2<frames::Map> p) const;
  Colour stone(RoadPoint at, Point2<frames::Map> p) const;
  double path_share(RoadPoint at, Point2<frames::Map> p) const;

  const Place& place_;
  std::vector<Patch> patches_;
  double path_along_;
};

Ground::Ground(const Place& place) : place_(place) {
  const RandomStream random(place.seed, stream_of(Source::kPatches));
  const auto count = static_cast<std::uint64_t>(place.length_m / 9.0);
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto [u, v] = random.uniform_pair(3 * i);
    const auto [length, width] = random.uniform_pair(3 * i + 1);
    const auto [tone, unused] = random.uniform_pair(3 * i + 2);
    patches_.push_back({{place.road.along_at(0.0) + u * place.length_m, 6.4 * v - 3.2},
                        0.4 + 2.6 * length * length,
                        0.3 + 0.9 * width,
                        tone < 0.7 ? -12.0 - 12.0 * tone : 14.0});
  }
  path_along_ = place.road.along_at(
      RandomStream(place.seed, stream_of(Source::kPath)).uniform(0, 0.25, 0.75) * place.length_m);
}

Colour Ground::grass(Point2<frames::Map> p) const {
  const SmoothNoise& noise = place_.noise;
  const double meadow = noise.fractal(p.x, p.y, 14.0, 2, kMeadow);
  const double dryness = smooth_step(-0.25, 0.65, noise.fractal(p.x, p.y, 9.0, 3, kDryness));
  const double tufts = noise.fractal(p.x, p.y, 1.1, 2, kTufts);
  const double blades = noise.fractal(p.x, p.y, 0.16, 2, kBlades);
  const double soil = smooth_step(0.42, 0.68, noise.fractal(p.x, p.y, 4.5, 3, kBareSoil));
  const Colour green = mix({92, 112, 56}, {141, 137, 82}, 0.75 * dryness);
  const Colour ground = mix(green, {140, 121, 93}, 0.7 * soil);
  return ground * (1.0 + 0.10 * meadow + 0.16 * tufts + 0.20 * blades);
}

Colour Ground::gravel(Point2<frames::Map> p) const {
  const double grain = place_.noise.fractal(p.x, p.y, 0.22, 2, kGravel);
  const double stain = place_.noise.fractal(p.x, p.y, 2.0, 3, kGravelStain);
  return Colour{172, 157, 131} * (1.0 + 0.10 * grain + 0.08 * stain);
}

double Ground::path_share(RoadPoint at, Point2<frames::Map> p) const {
  const double middle = path_along_ + 4.0 * std::sin(at.across / 9.0) + 0.1 * at.across;
  if (std::abs(at.along - middle) > 1.6) return 0.0;
  const double ragged = 0.5 * place_.noise.fractal(p.x, p.y, 1.5, 3, kPathEdge);
  return 1.0 - smooth_step(0.75, 1.05, std::abs(at.along - middle) + ragged);
}

Colour Ground::pavement(RoadPoint at, Point2<frames::Map> p) const {
  constexpr double kSlabLength = 1.0;
  constexpr double kSlabWidth = 0.8;
  const double column = std::floor(at.along / kSlabLength);
  const double row = std::floor(at.across / kSlabWidth);
  const double u = at.along - column * kSlabLength;
  const double v = at.across - row * kSlabWidth;
  const double slab = place_.noise.at(column + 0.01, row + 0.01, 1.0, kSlabs) - 0.5;
  const double stain = place_.noise.fractal(p.x, p.y, 2.5, 5, kSlabStain);
  const double to_joint = std::min(std::min(u, kSlabLength - u), std::min(v, kSlabWidth - v));
  const double joint = 1.0 - smooth_step(0.01, 0.05, to_joint);
  return Colour{163, 158, 149} * (1.0 + 0.16 * slab + 0.16 * stain - 0.22 * joint);
}

Colour Ground::kerb(RoadPoint at, Point2<frames::Map> p) const {
  const double u = at.along - std::floor(at.along);
  const double joint = 1.0 - smooth_step(0.01, 0.05, std::min(u, 1.0 - u));
  const double stain = place_.noise.fractal(p.x, p.y, 0.9, 3, kKerbStain);
  return Colour{186, 182, 172} * (1.0 + 0.10 * stain - 0.30 * joint);
}

double Ground::patched(RoadPoint at, double tone) const {
  for (const Patch& patch : patches_) {
    const double outside = std::max(std::abs(at.along - patch.centre.along) - patch.half_length,
                                    std::abs(at.across - patch.centre.across) - patch.half_width);
    if (outside > 0.08) continue;
    tone += patch.tone * (1.0 - smooth_step(-0.02, 0.03, outside));
    tone -= 24.0 * strip(outside, -0.03, 0.05);  // the sealed joint around a repair
  }
  return tone;
}

Colour Ground::asphalt(RoadPoint at, Point2<frames::Map> p) const {
  const SmoothNoise& noise = place_.noise;
  const auto bump = [](double offset, double width) {
    return std::exp(-0.5 * offset * offset / (width * width));
  };
  const double from_lane_middle = std::abs(at.across) - kLaneMiddle;
  const double wheels = bump(std::abs(from_lane_middle) - 0.75, 0.22);
  const double gutter = smooth_step(3.0, 3.6, std::abs(at.across));
  double tone = 114.0 + 6.0 * wheels - 9.0 * bump(from_lane_middle, 0.28) - 20.0 * gutter;
  tone += 14.0 * noise.fractal(at.along, 4.0 * at.across, 9.0, 3, kAsphaltWear);
  tone += 15.0 * noise.fractal(p.x, p.y, 3.2, 5, kAsphaltStain);
  tone += 15.0 * noise.fractal(p.x, p.y, 0.14, 2, kAsphaltGrain);
  tone = patched(at, tone) - 16.0 * strip(at.across, 0.12, 0.17);  // seam of the two lanes
  return Colour{1.0, 0.99, 0.985} * tone;
}

Colour Ground::open_ground(RoadPoint at, Point2<frames::Map> p) const {
  const double path = path_share(at, p);
  return path > 0.0 ? mix(grass(p), gravel(p), path) : grass(p);
}

Colour Ground::stone(RoadPoint at, Point2<frames::Map> p) const {
  const double distance = std::abs(at.across);
  if (distance > kPavementOuter) return {150, 147, 140};  // edging
  if (distance < kKerbOuter - kSoft) return kerb(at, p);
  return mix(kerb(at, p), pavement(at, p),
             smooth_step(kKerbOuter - kSoft, kKerbOuter + kSoft, distance));
}

Colour Ground::colour_at(Point2<frames::Map> p) const {
  constexpr double kCreepReach = 0.4;
  const RoadPoint at = place_.road.locate(p);
  const double distance = std::abs(at.across);
  if (distance < kKerbInner - kSoft) return asphalt(at, p);
  if (distance < kKerbInner + kSoft) {
    return mix(asphalt(at, p), stone(at, p),
               smooth_step(kKerbInner - kSoft, kKerbInner + kSoft, distance));
  }
  if (distance > kEdgingOuter + kCreepReach) return open_ground(at, p);
  if (distance < kEdgingOuter - kCreepReach) return stone(at, p);
  // Grass creeps over the edging of the footway.
  const double creep = 0.3 * place_.noise.fractal(p.x, p.y, 0.8, 3, kCreep);
  const double green = smooth_step(kEdgingOuter - 0.06, kEdgingOuter + 0.06, distance + creep);
  return mix(stone(at, p), open_ground(at, p), green);
}

}  // namespace

void paint_ground(const Place& place, Painting& painting) {
  const Ground ground(place);
  for (int row = 0; row < painting.image.height(); ++row) {
    for (int column = 0; column < painting.image.width(); ++column) {
      painting.set(column, row, ground.colour_at(painting.centre(column, row)));
    }
  }
}

}  // namespace nadir::simulation
