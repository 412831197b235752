// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "nadir/core/stamp.hpp"

namespace nadir {

/// How an estimate is moved onto the truth before it is judged. Anything but `kNone` hides exactly
/// the error that localization in a map must show.
enum class Alignment {
  kNone,
  kOrigin,  ///< the first pose is laid on the first truth
  kSe2,     ///< least squares over all positions: rotation and translation
  kSim2,    ///< the same with a scale
};
inline constexpr std::array<std::pair<Alignment, const char*>, 4> kAlignmentNames{
    {{Alignment::kNone, "none"},
     {Alignment::kOrigin, "origin"},
     {Alignment::kSe2, "se2"},
     {Alignment::kSim2, "sim2"}}};
std::string to_string(Alignment alignment);

enum class DeltaUnit {
  kFrames,  ///< every `delta`-th answered frame
  kMetres,  ///< after every `delta` metres of true path
};

struct EvaluationOptions {
  double t_max_diff_s = 0.01;  ///< largest difference of the stamps of one instant
  Alignment alignment = Alignment::kNone;
  double rpe_delta = 1.0;  ///< distance of the two ends of a relative error
  DeltaUnit rpe_delta_unit = DeltaUnit::kFrames;
  std::optional<Stamp> first = std::nullopt;  ///< truth before it is left out
  std::optional<Stamp> last = std::nullopt;   ///< truth after it is left out
};

}  // namespace nadir
