// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/options.hpp"

namespace nadir {

std::string to_string(Score score) {
  for (const auto& [value, name] : kScoreNames)
    if (value == score) return name;
  return {};
}

Channel MatchingOptions::effective_channel() const {
  if (channel != Channel::kAuto) return channel;
  return score == Score::kZncc || score == Score::kZwncc ? Channel::kHighPass : Channel::kGrey;
}

MatchingOptions MatchingOptions::for_heights() const {
  MatchingOptions options = *this;
  options.score = Score::kZwncc;
  return options;
}

void declare(OptionTable& table, MatchingOptions& options) {
  const std::string stage = "map_matching.";
  table.choice<Layers>(stage + "layers", options.layers, kLayersNames,
                       "What is compared: colour, heights, or both where map and frames have "
                       "heights.",
                       "Kaeslin et al., 2016; docs/height.md");
  table.choice<Score>(stage + "score", options.score, kScoreNames,
                      "How the alikeness of two patches is measured.",
                      "docs/scores.md; measured on the Aero-Ground run");
  table.choice<Channel>(stage + "channel", options.channel, kChannelNames,
                        "Image that is compared; auto is the high-pass for zncc and zwncc, grey "
                        "for the other scores.");
  table.choice<HoleTreatment>(stage + "holes", options.holes, kHoleTreatmentNames,
                              "What ssd and sad do with holes: leave them out, or take them for "
                              "white pixels.",
                              "paper, Fig. 6");
  table.choice<PaperWeight>(stage + "paper_weight", options.paper_weight, kPaperWeightNames,
                            "Weight of wncc_paper: equation 4 in raw pixels as printed, or with "
                            "normalised distances.",
                            "paper, equation 4");
  table.choice<Backend>(
      stage + "backend", options.backend, kBackendNames,
      "Implementation; cuda needs a GPU, reference is slow, in double, and obviously "
      "right.");
  table.choice<Search>(stage + "search", options.search, kSearchNames,
                       "How a search goes over positions and headings; auto is coarse to fine "
                       "where there are more than ten million of them and the score is zncc or "
                       "zwncc.",
                       "docs/performance.md");
  table.choice<PoseScoring>(
      stage + "pose_scoring", options.pose_scoring, kPoseScoringNames,
      "How particles are scored: exactly, or interpolated between score "
      "surfaces; auto interpolates where that costs a sixteenth (wncc_paper: a half) for their "
      "number and spread.",
      "docs/performance.md");
  table.number(stage + "resolution_m", options.resolution_m, {0.005, 10.0},
               "Metres per pixel at which both maps are compared.", "paper, section II");
  table.number(stage + "high_pass_sigma_m", options.high_pass_sigma_m, {0.1, 50.0},
               "Standard deviation of the Gaussian mean that the high-pass subtracts, metres.",
               "measured on the Aero-Ground run");
  table.number(stage + "height_sigma_m", options.height_sigma_m, {0.5, 50.0},
               "Standard deviation of the surroundings whose ground is the zero of heights, "
               "metres.");
  table.number(stage + "height_scale_m", options.height_scale_m, {0.01, 100.0},
               "Height above the ground that is half as good as any: lower things are compared by "
               "their height, higher ones by being there, metres.");
  table.number(
      stage + "height_ceiling_m", options.height_ceiling_m, {0.1, 1000.0},
      "What stands higher above the ground is unknown, metres: under a crown that the drone "
      "sees, the robot sees the ground; and cars come and go.",
      "measured on the simulated campus");
  table.number(stage + "min_valid_weight", options.min_valid_weight, {0.01, 1.0},
               "Smallest share of the local map's weight that must lie on valid map pixels.");
  table.number(stage + "yaw_step_deg", options.yaw_step_deg, {0.01, 90.0},
               "Step between the headings of a search, degrees.");
  table.integer(stage + "candidates", options.candidates, {1.0, 1000.0},
                "How many places a match returns at most.");
  table.number(stage + "peak_separation_m", options.peak_separation_m, {0.0, 1000.0},
               "Smallest distance between two returned places, metres.");
  table.number(stage + "ambiguous_peak_ratio", options.ambiguous_peak_ratio, {0.0, 1.0},
               "Ratio of second-best to best score from which a match is called ambiguous.");
}

}  // namespace nadir
