// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "nadir/io/drives/sequence.hpp"
#include "nadir/localizer.hpp"
#include "nadir/pipelines/localize/prior.hpp"
#include "nadir/report/figures.hpp"

namespace nadir::cli {

struct FrameRecord {
  int number = 0;
  Estimate estimate;
  double decode_s = 0.0;
  double update_s = 0.0;
};

/// Watches a run, and may send it to another start.
class RunObserver {
 public:
  RunObserver() = default;
  RunObserver(const RunObserver&) = delete;
  RunObserver& operator=(const RunObserver&) = delete;
  RunObserver(RunObserver&&) = delete;
  RunObserver& operator=(RunObserver&&) = delete;
  virtual ~RunObserver() = default;

  /// After every frame, with the particles and weights that it left.
  virtual void frame_done(const FrameRecord& record, const ParticleSet& particles) = 0;
  /// Asked before every frame: where to start anew, if so.
  virtual std::optional<Prior> new_start() { return std::nullopt; }
};

/// Gives the frame of a local map; asked in their order.
using FrameReader = std::function<Frame(const Sequence::LocalMap&)>;

/// Gives the map where it is newer than what it gave before.
using MapReader = std::function<std::optional<Orthomosaic>()>;

/// What to run.
struct RunPlan {
  const Orthomosaic& map;
  const std::optional<ElevationMap>& surface;
  const Sequence& sequence;
  const std::vector<Sequence::LocalMap>& frames;
  const LocalizerOptions& options;
  Prior start;
  std::uint64_t seed = 0;
  bool use_odometry_file = true;  ///< else the odometry is registered from the local maps
  std::vector<RunObserver*> observers = {};
  FrameReader read = {};   ///< empty = from the files of the sequence
  MapReader new_map = {};  ///< asked before every frame; empty = the map stays
};

struct RunResult {
  std::vector<FrameRecord> records;
  // For the figures, the first two at instants spread over the run.
  std::vector<Swarm> swarms;
  std::vector<Comparison> comparisons;
  std::vector<SeenGround> seen;  ///< by the local map of every frame, at its estimate
  double prepare_s = 0.0;        ///< the localizer's preparation of the map
  bool interrupted = false;      ///< the records end early

  Trajectory trajectory() const;
  int answered() const;  ///< frames whose local map was compared
  double update_s() const;
  double decode_s() const;
};

/// Runs the localizer over the frames; `progress(done)` after each. Stops early at an interrupt.
/// Times are those of one frame's decoding and of Localizer::update() alone.
RunResult run_localizer(const RunPlan& plan, const std::function<void(int)>& progress);

}  // namespace nadir::cli
