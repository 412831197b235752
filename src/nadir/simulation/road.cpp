// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/road.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"
#include "nadir/simulation/noise.hpp"

namespace nadir::simulation {
namespace {

constexpr double kSpacing = 0.05;   ///< metres of x between two samples
constexpr double kOverhang = 30.0;  ///< the road goes on beyond the site on both sides
constexpr int kNewtonIterations = 3;

struct Wave {
  double amplitude;
  double frequency;
  double phase;
};

}  // namespace

Road::Road(std::uint64_t seed, double length_m, double width_m) {
  const RandomStream random(seed, stream_of(Source::kRoad));
  const std::array<Wave, 2> waves{
      Wave{random.uniform(0, 3.0, 4.5), 2.0 * kPi / random.uniform(1, 85.0, 115.0),
           random.uniform(2, 0.0, 2.0 * kPi)},
      Wave{random.uniform(3, 0.6, 1.2), 2.0 * kPi / random.uniform(4, 40.0, 55.0),
           random.uniform(5, 0.0, 2.0 * kPi)}};
  const double middle = 0.5 * width_m + random.uniform(6, -2.0, 2.0);
  const auto count = static_cast<std::size_t>((length_m + 2.0 * kOverhang) / kSpacing) + 2;
  samples_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Sample& sample = samples_[i];
    const double x = static_cast<double>(i) * kSpacing - kOverhang;
    sample.y = middle;
    for (const Wave& wave : waves) {
      const double angle = wave.frequency * x + wave.phase;
      sample.y += wave.amplitude * std::sin(angle);
      sample.slope += wave.amplitude * wave.frequency * std::cos(angle);
      sample.bend -= wave.amplitude * wave.frequency * wave.frequency * std::sin(angle);
    }
    if (i > 0) {
      const Sample& before = samples_[i - 1];
      sample.along = before.along + std::hypot(kSpacing, sample.y - before.y);
    }
  }
}

Road::Sample Road::sample(double x) const {
  const double position =
      std::clamp((x + kOverhang) / kSpacing, 0.0, static_cast<double>(samples_.size()) - 1.001);
  const auto i = static_cast<std::size_t>(position);
  const double t = position - static_cast<double>(i);
  const Sample& a = samples_[i];
  const Sample& b = samples_[i + 1];
  const auto blend = [t](double from, double to) { return from + t * (to - from); };
  return {blend(a.along, b.along), blend(a.y, b.y), blend(a.slope, b.slope), blend(a.bend, b.bend)};
}

double Road::along_at(double x) const { return sample(x).along; }

double Road::x_at(double along) const {
  const auto after =
      std::lower_bound(samples_.begin() + 1, samples_.end() - 1, along,
                       [](const Sample& sample, double value) { return sample.along < value; });
  const auto before = after - 1;
  const double t = (along - before->along) / (after->along - before->along);
  return (static_cast<double>(before - samples_.begin()) + t) * kSpacing - kOverhang;
}

RoadPoint Road::locate(Point2<frames::Map> point) const {
  double x = point.x;
  for (int iteration = 0; iteration < kNewtonIterations; ++iteration) {
    const Sample s = sample(x);
    const double residual = (x - point.x) + (s.y - point.y) * s.slope;
    const double derivative = 1.0 + s.slope * s.slope + (s.y - point.y) * s.bend;
    x -= residual / std::max(derivative, 0.3);
  }
  const Sample s = sample(x);
  const double norm = std::hypot(1.0, s.slope);
  return {s.along, ((point.y - s.y) - s.slope * (point.x - x)) / norm};
}

Point2<frames::Map> Road::place(RoadPoint point) const {
  const double x = x_at(point.along);
  const Sample s = sample(x);
  const double norm = std::hypot(1.0, s.slope);
  return {x - point.across * s.slope / norm, s.y + point.across / norm};
}

double Road::heading(double along) const { return std::atan(sample(x_at(along)).slope); }

}  // namespace nadir::simulation
