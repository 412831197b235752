// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/odometry.hpp"

#include <cmath>

#include "nadir/map_matching/matching.hpp"

namespace nadir {

void declare(OptionTable& table, RegistrationOptions& options) {
  const std::string stage = "registration.";
  table.number(stage + "resolution_m", options.resolution_m, {0.005, 10.0},
               "Metres per pixel at which consecutive local maps are registered.");
  table.number(stage + "max_step_m", options.max_step_m, {0.01, 1000.0},
               "Longest travel between two local maps, metres.");
  table.number(stage + "max_turn_deg", options.max_turn_deg, {0.0, 180.0},
               "Largest turn between two local maps, degrees; 0 where all share one orientation.");
  table.number(stage + "turn_step_deg", options.turn_step_deg, {0.01, 90.0},
               "Step between the turns that are tried, degrees.");
  table.number(stage + "min_score", options.min_score, {-1.0, 1.0},
               "Smallest zero-mean correlation at which a registration is believed.");
}

std::optional<Motion2> register_local_maps(const Orthomosaic& earlier, const Orthomosaic& later,
                                           const RegistrationOptions& options) {
  MatchingOptions matching;
  matching.score = Score::kZncc;
  matching.channel = Channel::kGrey;
  matching.resolution_m = options.resolution_m;
  matching.min_valid_weight = 0.3;  // the robot may have moved by a good part of a local map
  const MapIndex map(earlier, matching);
  const Template local = make_template(later, matching);
  SearchRegion region;
  region.centre = Point2<frames::Map>{0.0, 0.0};  // the earlier robot frame serves as the map
  region.half_size_m = options.max_step_m;
  region.yaw_half_range_rad = radians(options.max_turn_deg);
  region.yaw_step_rad = radians(options.turn_step_deg);
  const MatchResult result = match(map, local, region);
  if (result.candidates.empty() || result.candidates.front().score < options.min_score) {
    return std::nullopt;
  }
  const Pose2& motion = result.candidates.front().map_from_robot;
  return Motion2{motion.x, motion.y, motion.yaw};
}

}  // namespace nadir
