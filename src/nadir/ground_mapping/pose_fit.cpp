// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/pose_fit.hpp"

#include <cmath>

#include "nadir/core/options.hpp"

namespace nadir {
namespace {

/// Fewer pairs, or steps, are no evidence.
constexpr int kFewestPairs = 3;
constexpr int kFewestForRefusal = 5;
/// No ground robot drives so fast, m/s.
constexpr double kAbsurdSpeed = 100.0;

bool is_too_fast(const PoseFit& fit) {
  return fit.steps >= kFewestForRefusal && fit.speed_m_per_s > kAbsurdSpeed;
}

std::string to_tenths(double value) { return to_text(std::round(10.0 * value) / 10.0); }

std::string cure_of(PoseFault fault) {
  switch (fault) {
    case PoseFault::kMillimetres:
      return "a thousandth of their lengths fits: they are in millimetres, give metres";
    case PoseFault::kInverted:
      return "their inverses fit: give odom_from_robot, not robot_from_odom";
    case PoseFault::kMirrored:
      return "mirrored they fit: give x forward, y left, z up, yaw counter-clockwise";
    case PoseFault::kStandingImages:
      return "the images stand still while the poses move: check that --poses belongs to this "
             "drive";
    case PoseFault::kStandingPoses:
      return "the poses stand still while the images move: check that --poses belongs to this "
             "drive";
    case PoseFault::kUnknown:
      break;
  }
  return "check that --poses belongs to this drive and is odom_from_robot in metres";
}

}  // namespace

std::optional<std::string> pose_misfit(const PoseFit& fit) {
  if (is_too_fast(fit)) {
    return "the poses move by " + to_tenths(fit.step_m) + " m from frame to frame, " +
           to_text(std::round(fit.speed_m_per_s)) +
           " m/s: are they in millimetres? Give metres, and stamps in seconds";
  }
  if (fit.pairs < kFewestPairs || 2 * fit.misfits <= fit.pairs) return std::nullopt;
  return "the poses do not fit the images: three quarters of the points of one frame land more "
         "than " +
         to_tenths(fit.offset_px) + " px from where a later frame shows them, in " +
         std::to_string(fit.misfits) + " of " + std::to_string(fit.pairs) + " checked pairs; " +
         cure_of(fit.fault);
}

bool is_gross(const PoseFit& fit) {
  return is_too_fast(fit) || (fit.pairs >= kFewestForRefusal && 5 * fit.gross >= 4 * fit.pairs);
}

}  // namespace nadir
