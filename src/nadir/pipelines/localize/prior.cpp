// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/localize/prior.hpp"

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/core/random.hpp"

namespace nadir {
namespace {

/// A stream of its own ("prior" in ASCII): the filter's draws of the same seed stay independent.
constexpr std::uint64_t kPriorStream = 0x7072696f72;

Pose2 moved_by_seed(const Pose2& truth, const Spread& spread, std::uint64_t seed) {
  const RandomStream random(seed, kPriorStream);
  return {truth.x + random.uniform(0, -spread.position_m, spread.position_m),
          truth.y + random.uniform(1, -spread.position_m, spread.position_m),
          wrap_angle(truth.yaw + random.uniform(2, -spread.yaw_rad, spread.yaw_rad))};
}

}  // namespace

Spread parse_spread(const std::string& text) {
  const auto numbers = parse_numbers(text, 2, "--prior-spread", "METRES,DEGREES");
  if (numbers[0] < 0.0 || numbers[1] < 0.0) {
    throw Error(ErrorKind::kUsage, "a spread cannot be negative", "--prior-spread");
  }
  return {numbers[0], radians(numbers[1])};
}

Prior start_of(const PriorOptions& options, const Trajectory& truth, std::uint64_t seed) {
  const Spread spread = parse_spread(options.spread);
  if (options.prior.empty()) {
    throw Error(ErrorKind::kUsage, "a start is needed, as the whole map is not searched yet", {},
                "give --prior X,Y,YAW_DEG, or --prior truth where the site has a truth");
  }
  if (options.prior != "truth") {
    const auto numbers = parse_numbers(options.prior, 3, "--prior", "X,Y,YAW_DEG or truth");
    return {{numbers[0], numbers[1], wrap_angle(radians(numbers[2]))}, spread};
  }
  if (truth.empty()) {
    throw Error(ErrorKind::kUsage, "the site has no true pose among these frames", "--prior truth",
                "give --prior X,Y,YAW_DEG");
  }
  return {moved_by_seed(truth.front().pose, spread, seed), spread};
}

}  // namespace nadir
