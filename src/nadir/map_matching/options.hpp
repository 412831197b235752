// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <utility>

#include "nadir/core/options.hpp"

namespace nadir {

/// How alike two patches are. Definitions: docs/scores.md and map_matching/reference/scores.hpp.
/// Larger is better for every one of them: the distances are returned negated.
enum class Score {
  kSsd,        ///< mean squared difference, negated
  kSad,        ///< mean absolute difference, negated
  kNcc,        ///< cosine, masked, no mean removed (what the authors' scripts call NCC)
  kWncc,       ///< the same with weight [4], normalised distances, in the numerator only
  kWnccPaper,  ///< equation [5] as printed
  kZncc,       ///< masked zero-mean NCC
  kZwncc,      ///< masked zero-mean NCC, weighted in means and norms too
};
inline constexpr std::array<std::pair<Score, const char*>, 7> kScoreNames{
    {{Score::kSsd, "ssd"},
     {Score::kSad, "sad"},
     {Score::kNcc, "ncc"},
     {Score::kWncc, "wncc"},
     {Score::kWnccPaper, "wncc_paper"},
     {Score::kZncc, "zncc"},
     {Score::kZwncc, "zwncc"}}};
std::string to_string(Score score);

/// What a hole is to `ssd` and `sad`.
enum class HoleTreatment { kMasked, kWhite };
inline constexpr std::array<std::pair<HoleTreatment, const char*>, 2> kHoleTreatmentNames{
    {{HoleTreatment::kMasked, "masked"}, {HoleTreatment::kWhite, "white"}}};

/// Equation [4] in raw pixels as printed, or with distances normalised by the half sides.
enum class PaperWeight { kLiteral, kNormalised };
inline constexpr std::array<std::pair<PaperWeight, const char*>, 2> kPaperWeightNames{
    {{PaperWeight::kLiteral, "literal"}, {PaperWeight::kNormalised, "normalised"}}};

/// Which derived 8-bit image is compared.
enum class Channel { kAuto, kGrey, kHighPass };
inline constexpr std::array<std::pair<Channel, const char*>, 3> kChannelNames{
    {{Channel::kAuto, "auto"}, {Channel::kGrey, "grey"}, {Channel::kHighPass, "high_pass"}}};

enum class Backend { kCpu, kCuda, kReference };
inline constexpr std::array<std::pair<Backend, const char*>, 3> kBackendNames{
    {{Backend::kCpu, "cpu"}, {Backend::kCuda, "cuda"}, {Backend::kReference, "reference"}}};

/// Which of a site's layers are compared.
enum class Layers {
  kBoth,    ///< colour, and heights where map and frame have them
  kColour,  ///< the orthomosaics alone
  kHeight,  ///< the heights alone
};
inline constexpr std::array<std::pair<Layers, const char*>, 3> kLayersNames{
    {{Layers::kBoth, "both"}, {Layers::kColour, "colour"}, {Layers::kHeight, "height"}}};

/// How a search goes over its window and headings.
enum class Search {
  kAuto,          ///< coarse to fine where the volume is large and the score is zncc or zwncc
  kFull,          ///< every position and heading at full resolution
  kCoarseToFine,  ///< the best places of a quarter of the resolution, refined in two steps
};
inline constexpr std::array<std::pair<Search, const char*>, 3> kSearchNames{
    {{Search::kAuto, "auto"}, {Search::kFull, "full"}, {Search::kCoarseToFine, "coarse_to_fine"}}};

/// How the poses of particles are scored.
enum class PoseScoring {
  kAuto,     ///< interpolated where that costs a small part of exact scores
  kExact,    ///< the map is sampled under every template pixel of every pose
  kSurface,  ///< interpolated between score surfaces of a few headings
};
inline constexpr std::array<std::pair<PoseScoring, const char*>, 3> kPoseScoringNames{
    {{PoseScoring::kAuto, "auto"},
     {PoseScoring::kExact, "exact"},
     {PoseScoring::kSurface, "surface"}}};

struct MatchingOptions {
  Layers layers = Layers::kBoth;
  Score score = Score::kZwncc;
  Channel channel = Channel::kAuto;
  HoleTreatment holes = HoleTreatment::kMasked;
  PaperWeight paper_weight = PaperWeight::kLiteral;
  Backend backend = Backend::kCpu;
  Search search = Search::kAuto;
  PoseScoring pose_scoring = PoseScoring::kAuto;
  double resolution_m = 0.10;
  double high_pass_sigma_m = 1.5;
  double height_sigma_m = 3.0;
  double height_scale_m = 0.25;
  double height_ceiling_m = 1.2;
  double min_valid_weight = 0.6;
  double yaw_step_deg = 1.0;
  int candidates = 10;
  double peak_separation_m = 1.0;
  double ambiguous_peak_ratio = 0.95;

  /// The channel that is compared: `kAuto` is the high-pass for the zero-mean scores, grey else.
  Channel effective_channel() const;
  /// The options by which heights are compared: as these, but for the score, which is zwncc, since
  /// only the zero-mean scores do without a common datum.
  MatchingOptions for_heights() const;
};

void declare(OptionTable& table, MatchingOptions& options);

}  // namespace nadir
