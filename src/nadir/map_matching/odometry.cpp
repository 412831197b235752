// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/map_matching/matching.hpp"

namespace nadir {
namespace {

/// Smallest share of the later map that must lie on the earlier one.
constexpr double kMinOverlap = 0.3;

bool has_valid_pixel(const Orthomosaic& image) {
  const auto& valid = image.valid.values();
  return std::any_of(valid.begin(), valid.end(), [](std::uint8_t value) { return value != 0; });
}

/// The best motion of at most `reach` metres along each axis, unless it lies on the edge of the
/// search, where it is no maximum, or is not believed.
std::optional<Motion2> register_within(const MapIndex& map, const Template& local, double reach,
                                       const RegistrationOptions& options, const StopToken& stop) {
  SearchRegion region;
  region.centre = Point2<frames::Map>{0.0, 0.0};  // the earlier robot frame serves as the map
  region.half_size_m = reach;
  region.yaw_half_range_rad = radians(options.max_turn_deg);
  region.yaw_step_rad = radians(options.turn_step_deg);
  const MatchResult result = match(map, local, region, stop);
  if (result.candidates.empty()) return std::nullopt;
  const MatchCandidate& best = result.candidates.front();
  const Pose2& motion = best.map_from_robot;
  const double edge = reach - 1.5 * options.resolution_m;
  if (best.score < options.min_score || std::abs(motion.x) > edge || std::abs(motion.y) > edge) {
    return std::nullopt;
  }
  return Motion2{motion.x, motion.y, motion.yaw};
}

}  // namespace

void declare(OptionTable& table, RegistrationOptions& options) {
  const std::string stage = "registration.";
  table.number(stage + "resolution_m", options.resolution_m, {0.005, 10.0},
               "Metres per pixel at which consecutive local maps are registered.");
  table.number(stage + "max_step_m", options.max_step_m, {0.01, 1000.0},
               "Travel between two local maps that is tried first, metres; where nothing fits, "
               "twice as far, and so on.");
  table.number(stage + "max_turn_deg", options.max_turn_deg, {0.0, 180.0},
               "Largest turn between two local maps, degrees; 0 where all share one orientation.");
  table.number(stage + "turn_step_deg", options.turn_step_deg, {0.01, 90.0},
               "Step between the turns that are tried, degrees.");
  table.number(stage + "min_score", options.min_score, {-1.0, 1.0},
               "Smallest zero-mean correlation at which a registration is believed.");
}

std::optional<Motion2> register_local_maps(const Orthomosaic& earlier, const Orthomosaic& later,
                                           const RegistrationOptions& options,
                                           const StopToken& stop) {
  MatchingOptions matching;
  matching.score = Score::kZncc;
  matching.channel = Channel::kGrey;
  matching.resolution_m = options.resolution_m;
  matching.min_valid_weight = kMinOverlap;
  matching.candidates = 1;
  if (!has_valid_pixel(earlier) || !has_valid_pixel(later)) return std::nullopt;
  const MapIndex map(earlier, matching);
  const Template local = make_template(later, matching);
  // Frames may be missing: where nothing fits near by, look twice as far, up to where the two maps
  // can no longer overlap enough.
  const double farthest =
      0.5 * std::max(earlier.width(), earlier.height()) * earlier.geo.resolution;
  for (double reach = options.max_step_m;; reach *= 2.0) {
    const auto motion = register_within(map, local, reach, options, stop);
    if (motion || reach >= farthest) return motion;
  }
}

}  // namespace nadir
