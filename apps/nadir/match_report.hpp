// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/streams.hpp"
#include "nadir/map_matching/matching.hpp"

namespace nadir::cli {

/// One score's answer.
struct ScoredMatch {
  Score score = Score::kZwncc;
  Channel channel = Channel::kAuto;
  MatchResult result;
  double seconds = 0.0;
  std::string heat_map;  ///< file name; empty where nothing was found
};

/// Candidates with score, valid weight and, where the truth is known, their error.
Json to_json(const ScoredMatch& match, const std::optional<Pose2>& truth);
/// One row a score.
std::string to_table(const std::vector<ScoredMatch>& matches, const std::optional<Pose2>& truth);

}  // namespace nadir::cli
