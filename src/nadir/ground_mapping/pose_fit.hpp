// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>

namespace nadir {

/// What would make poses fit that do not.
enum class PoseFault {
  kUnknown,
  kMillimetres,     ///< the translations are a thousand times too long
  kInverted,        ///< robot_from_odom was given for odom_from_robot
  kMirrored,        ///< y to the right, z up: turned the wrong way
  kStandingImages,  ///< the images do not move
  kStandingPoses,   ///< the poses do not move
};

/// How the poses of a drive fit its images: points of one frame whose depth is known are brought
/// into a later frame by the poses, and looked for there. Lengths in pixels are those of an image
/// 640 wide, or of the image itself where it is smaller.
struct PoseFit {
  int pairs = 0;      ///< of frames that moved and had texture enough to be judged
  int misfits = 0;    ///< of them, those off by more than kMisfitPx
  int gross = 0;      ///< above kGrossPx
  double offset_px =  ///< median over the pairs of the lower quartile over the points: the rest may
                      ///< drive about
      std::numeric_limits<double>::quiet_NaN();
  PoseFault fault = PoseFault::kUnknown;  ///< that explains most of the misfits
  int steps = 0;                          ///< between frames with poses
  double step_m = 0.0;                    ///< median
  double speed_m_per_s = 0.0;             ///< median

  static constexpr double kMisfitPx = 2.5;
  static constexpr double kGrossPx = 5.0;
};

/// One sentence with the cure where the poses do not fit the images, or are too fast for a robot;
/// nothing where they fit, and where too little could be judged.
std::optional<std::string> pose_misfit(const PoseFit& fit);

/// The misfit is so plain that a map made with these poses is worth nothing.
bool is_gross(const PoseFit& fit);

}  // namespace nadir
