// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "nadir/core/frames.hpp"

namespace nadir::simulation {

/// A place as seen from the road: metres along its centre line, and metres to the left of it.
struct RoadPoint {
  double along = 0.0;
  double across = 0.0;
};

/// A gently curving road from west to east: its centre line is a sum of two sines.
class Road {
 public:
  /// A road through a site of `length_m` x `width_m` with its south-west corner at (0, 0).
  Road(std::uint64_t seed, double length_m, double width_m);

  /// The foot of the perpendicular; meant for places within about 15 m of the road.
  RoadPoint locate(Point2<frames::Map> point) const;
  Point2<frames::Map> place(RoadPoint point) const;
  /// Direction of travel towards the east, radians counter-clockwise from east.
  double heading(double along) const;
  /// `along` of the point of the centre line that lies at this x.
  double along_at(double x) const;

 private:
  struct Sample {
    double along = 0.0;
    double y = 0.0;
    double slope = 0.0;
    double bend = 0.0;  ///< second derivative of y
  };
  Sample sample(double x) const;
  double x_at(double along) const;

  std::vector<Sample> samples_;  ///< evenly spaced in x
};

}  // namespace nadir::simulation
