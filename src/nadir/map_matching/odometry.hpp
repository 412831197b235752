// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "nadir/core/frames.hpp"
#include "nadir/core/options.hpp"
#include "nadir/core/orthomosaic.hpp"

namespace nadir {

struct RegistrationOptions {
  double resolution_m = 0.10;
  double max_step_m = 2.0;
  double max_turn_deg = 0.0;
  double turn_step_deg = 0.5;
  double min_score = 0.65;
};

void declare(OptionTable& table, RegistrationOptions& options);

/// The robot's motion between two consecutive local maps, found by matching the later on the
/// earlier: nothing where they do not overlap or do not look alike. Throws Stopped.
std::optional<Motion2> register_local_maps(const Orthomosaic& earlier, const Orthomosaic& later,
                                           const RegistrationOptions& options,
                                           const StopToken& stop = {});

}  // namespace nadir
