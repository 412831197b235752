// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/streams.hpp"
#include "nadir/evaluation/consistency.hpp"
#include "nadir/evaluation/evaluation.hpp"
#include "nadir/evaluation/summary.hpp"

namespace nadir::cli {

/// An evaluation with what belongs to it. Angles become degrees here.
struct Judgement {
  Evaluation evaluation;
  Alignment alignment = Alignment::kNone;
  std::optional<Consistency> consistency;
};

/// Of a run as it is: not aligned, over all its frames.
Judgement judged(const Trajectory& estimated, const std::vector<StampedCovariance>& covariances,
                 const Trajectory& truth);

Json to_json(const Judgement& judgement);
Json to_json(const SeedSummary& summary);

/// Tables for reading.
std::string to_table(const Judgement& judgement);
std::string to_table(const SeedSummary& summary);

}  // namespace nadir::cli
