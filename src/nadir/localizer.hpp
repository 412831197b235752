// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/stop.hpp"
#include "nadir/localization/particle_filter.hpp"
#include "nadir/map_matching/matching.hpp"
#include "nadir/map_matching/odometry.hpp"

namespace nadir {

struct LocalizerOptions {
  MatchingOptions matching;
  LocalizationOptions localization;
  RegistrationOptions registration;

  /// The protocol of the paper, section IV: see LocalizationOptions::paper().
  static LocalizerOptions paper();
};

/// All options of a run, dotted by stage ("map_matching.score", "localization.temper").
/// `options` must outlive the table.
OptionTable option_table(LocalizerOptions& options);

enum class EstimateStatus {
  kOk,          ///< the local map was compared and the filter updated
  kNoOverlap,   ///< too little of the local map lies in the map: predicted by odometry only
  kNoTexture,   ///< the local map has nothing to compare: predicted only
  kNoOdometry,  ///< no odometry and none could be registered: the cloud was only spread
};
std::string to_string(EstimateStatus status);

/// What the localizer says after one frame.
struct Estimate {
  Stamp stamp;
  Pose2 map_from_robot;       ///< mean of the heaviest cluster; always finite
  PoseCovariance covariance;  ///< of that cluster: m^2, m rad, rad^2
  EstimateStatus status = EstimateStatus::kOk;
  double cluster_mass = 1.0;  ///< share of the weight in that cluster
  int clusters = 1;
  double effective_particles = 0;  ///< before resampling
  /// Of the particles, by colour, or by heights where those alone are compared; NaN where nothing
  /// was scored.
  double best_score = 0.0;
  double valid_weight = 0.0;  ///< of the best particle
  bool resampled = false;     ///< before this frame's prediction
};

/// The whole of nadir in one class: odometry and local maps in, poses in the map out.
class Localizer {
 public:
  Localizer(const Orthomosaic& map, const LocalizerOptions& options, std::uint64_t seed = 0);
  /// With the surface of the map, where there is one: then the heights of frames that have them are
  /// compared too, as `map_matching.layers` says. Throws Error (usage) where heights alone are to
  /// be compared and there is no surface.
  Localizer(const Orthomosaic& map, const std::optional<ElevationMap>& surface,
            const LocalizerOptions& options, std::uint64_t seed = 0);

  /// Starts the filter with particles uniform in a square and a range of headings around `prior`.
  void start_near(const Pose2& prior, const Spread& spread);

  /// Goes on in another version of the map, of the same frame and resolution: particles and pose
  /// stay where they are in metres. Throws Error (input) for a map of another frame or resolution
  /// and for one that MapIndex refuses; nothing has changed then.
  void use_map(const Orthomosaic& map);

  /// Takes one frame; frames come in the order of their stamps. Throws Error (input) for a
  /// non-finite odometry, a stamp that does not increase, or a local map that make_template()
  /// refuses; Error (usage) before start_near(); Stopped. Nothing has changed where it throws: the
  /// frame, put right, may be given again.
  Estimate update(const Frame& frame, const StopToken& stop = {});

  /// The particles after the last update, with their weights.
  const ParticleSet& particles() const { return filter_.particles(); }

 private:
  /// One way of comparing a frame: by colour or by heights.
  struct Look {
    std::vector<PoseScore> scores;  ///< of every particle
    double temper = 0.0;
  };
  std::vector<Look> look(const Frame& frame, const std::vector<Pose2>& poses,
                         const StopToken& stop) const;
  static bool weigh(ParticleFilter& filter, const std::vector<Look>& looks);
  /// Why the frame said nothing: most of the cloud lies where too little can be compared, or what
  /// can be compared has no contrast.
  EstimateStatus why_not(const std::vector<Look>& looks, const std::vector<double>& weights) const;
  /// From the odometry where both frames have it, else by registering the local maps.
  std::optional<Motion2> motion_since_previous(const Frame& frame, const StopToken& stop) const;

  LocalizerOptions options_;
  GeoReference geo_;                 ///< of the map that it began with
  std::optional<MapIndex> map_;      ///< absent where heights alone are compared
  std::optional<MapIndex> surface_;  ///< absent where colour alone is
  ParticleFilter filter_;
  std::optional<Frame> previous_;
  bool weighed_ = false;  ///< the last frame changed the weights
  Motion2 last_motion_;   ///< stands in where a motion is missing
};

}  // namespace nadir
