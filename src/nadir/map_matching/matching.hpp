// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/frames.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/score_volume.hpp"
#include "nadir/core/stop.hpp"
#include "nadir/map_matching/options.hpp"
#include "nadir/map_matching/quads.hpp"

namespace nadir {

/// The image that scores compare, derived from an orthomosaic and resampled to the common
/// resolution: 8-bit grey values (a high-pass is offset by 128) and which of them are valid (1) or
/// holes (0). Valid pixels have values from 1 to 255, holes have 0.
struct ChannelImage {
  Raster<std::uint8_t> value;
  Raster<std::uint8_t> valid;
  GeoReference geo;
};

class PreparedMap;

/// The global map, prepared once for any number of matches.
class MapIndex {
 public:
  /// Resamples to `options.resolution_m` (area average) and derives the channel.
  /// Throws Error (input) for an empty map, one without a valid pixel, or one whose image and mask
  /// differ in size.
  MapIndex(const Orthomosaic& map, const MatchingOptions& options);
  /// Heights instead of colours, compared by `options.for_heights()`. Throws Error (input) for an
  /// empty surface or one without a known height.
  MapIndex(const ElevationMap& surface, const MatchingOptions& options);

  const ChannelImage& channel() const { return channel_; }
  const MatchingOptions& options() const { return options_; }
  double mean_grey() const { return mean_grey_; }  ///< of the channel's valid pixels
  const Quads& quads() const { return quads_; }    ///< the channel, packed for bilinear sampling
  PreparedMap* prepared() const { return prepared_.get(); }  ///< the backend's; may be null
  /// The same map at half the resolution; computed when first asked for, kept from then on.
  const MapIndex& coarser() const;

 private:
  struct Coarser;
  MapIndex(const MatchingOptions& options, ChannelImage channel);

  MatchingOptions options_;
  ChannelImage channel_;
  double mean_grey_ = 0.0;
  Quads quads_;
  std::shared_ptr<PreparedMap> prepared_;
  std::shared_ptr<Coarser> coarser_;  ///< shared by copies: they are of the same map
};

/// A local map, prepared to be matched: the same channel at the same resolution. Its geo-reference
/// places it in the robot frame.
struct Template {
  ChannelImage channel;
  double valid_share = 0.0;  ///< valid pixels / all pixels
};

/// Prepares a local map for `map`. Throws Error (input) where image and mask differ in size or the
/// image is empty.
Template make_template(const Orthomosaic& local, const MatchingOptions& options);
/// Prepares local heights for a map of heights. Throws Error (input) for an empty raster.
Template make_template(const ElevationMap& local, const MatchingOptions& options);

/// Where to look for the robot. Default: the whole map at one heading.
struct SearchRegion {
  /// Centre of the square of robot positions, map frame; absent = every position in the map.
  std::optional<Point2<frames::Map>> centre = std::nullopt;
  double half_size_m = 5.0;         ///< half the side of that square
  double yaw_rad = 0.0;             ///< the middle heading
  double yaw_half_range_rad = 0.0;  ///< pi = every heading
  /// Default: MatchingOptions::yaw_step_deg.
  std::optional<double> yaw_step_rad = std::nullopt;
};

enum class MatchStatus {
  kOk,
  kAmbiguous,  ///< another place scores nearly as well (peak ratio)
  kNoOverlap,  ///< nowhere was enough of the template's weight compared
  kNoTexture,  ///< enough was compared, but a variance was too small for a score
};
std::string to_string(MatchStatus status);

struct MatchCandidate {
  Pose2 map_from_robot;
  double score = 0.0;
  double valid_weight = 0.0;  ///< share of the template's weight that was compared
};

struct MatchResult {
  MatchStatus status = MatchStatus::kNoOverlap;
  /// Local maxima, best first, refined below the pixel, at least `peak_separation_m` apart.
  std::vector<MatchCandidate> candidates;
  /// How far the second-best place rises above the median score of the volume, as a share of how
  /// far the best does: 0 where there is one place only, 1 where two are equal.
  double peak_ratio = 0.0;
  ScoreVolume volume;
};

/// Scores every robot position of the region at every heading, or, for a large region, at a quarter
/// of the resolution and then around the best places (MatchingOptions::search): the volume is then
/// the coarse one. Throws Stopped, and Error (usage) for a region that is not finite or holds more
/// scores than memory does (16 GB).
MatchResult match(const MapIndex& map, const Template& local, const SearchRegion& region,
                  const StopToken& stop = {});

/// A score of one pose; NaN where it is undefined.
struct PoseScore {
  double score = 0.0;
  double valid_weight = 0.0;
};

/// Scores given poses as MatchingOptions::pose_scoring says. Throws Stopped.
std::vector<PoseScore> score_poses(const MapIndex& map, const Template& local,
                                   std::span<const Pose2> map_from_robot,
                                   const StopToken& stop = {});

}  // namespace nadir
