// SPDX-License-Identifier: Apache-2.0
#include "match_plan.hpp"

#include <fmt/format.h>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/core/random.hpp"

namespace nadir::cli {
namespace {

/// A stream of its own ("window" in ASCII).
constexpr std::uint64_t kWindowStream = 0x77696e646f77;

Point2<frames::Map> off_centre(const Pose2& truth, double window_m, std::uint64_t seed) {
  const RandomStream random(seed, kWindowStream);
  const double largest = 0.5 * window_m;
  return {truth.x + random.uniform(0, -largest, largest),
          truth.y + random.uniform(1, -largest, largest)};
}

void choose_window(const RegionOptions& options, const std::optional<Pose2>& truth,
                   std::uint64_t seed, RegionChoice& choice) {
  if (!options.window_m) {
    if (!options.centre.empty()) {
      throw Error(ErrorKind::kUsage, "a centre needs the size of its window", "--centre",
                  "give --window METRES too");
    }
    choice.explanation = "whole map";
    return;
  }
  choice.region.half_size_m = *options.window_m;
  if (!options.centre.empty()) {
    const auto numbers = parse_numbers(options.centre, 2, "--centre", "X,Y");
    choice.region.centre = Point2<frames::Map>{numbers[0], numbers[1]};
    choice.explanation = fmt::format("window of +-{} m around the given centre", *options.window_m);
    return;
  }
  if (!truth) {
    throw Error(ErrorKind::kUsage, "this frame has no true pose to lay the window around",
                "--window", "give --centre X,Y");
  }
  choice.region.centre = off_centre(*truth, *options.window_m, seed);
  choice.explanation = fmt::format(
      "window of +-{} m, {:.2f} m east and {:.2f} m north of the truth", *options.window_m,
      choice.region.centre->x - truth->x, choice.region.centre->y - truth->y);
}

}  // namespace

RegionChoice choose_region(const RegionOptions& options, const std::optional<Pose2>& truth,
                           std::uint64_t seed) {
  RegionChoice choice;
  choose_window(options, truth, seed, choice);
  choice.region.yaw_half_range_rad = radians(options.yaw_range_deg);
  const bool every_heading = options.yaw_range_deg >= 180.0;
  if (!options.yaw_deg && !truth && !every_heading) {
    throw Error(ErrorKind::kUsage, "this frame has no true pose to take the heading from", {},
                "give --yaw-deg, or --yaw-range-deg 180 for every heading");
  }
  choice.region.yaw_rad =
      options.yaw_deg ? wrap_angle(radians(*options.yaw_deg)) : truth.value_or(Pose2{}).yaw;
  choice.explanation += options.yaw_deg ? ", heading as given" : ", heading of the truth";
  choice.explanation += fmt::format(" +-{} deg", options.yaw_range_deg);
  return choice;
}

}  // namespace nadir::cli
