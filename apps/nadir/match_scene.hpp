// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "match_plan.hpp"
#include "match_report.hpp"
#include "nadir/core/orthomosaic.hpp"

namespace nadir::cli {

/// What all scores of one `nadir match` share.
struct MatchScene {
  Orthomosaic map;
  Orthomosaic local;
  std::optional<Pose2> truth;
  RegionChoice choice;
  int frame = 0;
};

/// Matches with one score and draws its heat map into the folder; the volume is not kept.
ScoredMatch match_and_draw(const MatchScene& scene, const MatchingOptions& options,
                           const std::filesystem::path& folder);

/// match.json.
Json to_json(const std::vector<ScoredMatch>& matches, const MatchScene& scene);

}  // namespace nadir::cli
