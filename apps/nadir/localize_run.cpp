// SPDX-License-Identifier: Apache-2.0
#include "localize_run.hpp"

#include <algorithm>

#include "cli/interrupt.hpp"
#include "nadir/core/error.hpp"
#include "nadir/pipelines/site.hpp"
#include "nadir/pipelines/stopwatch.hpp"

namespace nadir::cli {
namespace {

constexpr std::size_t kInstantCount = 6;

/// Whether frame `index` of `count` is one of the instants, first and last among them, at which the
/// swarm and the local map are kept.
bool is_figure_instant(std::size_t index, std::size_t count) {
  if (count <= kInstantCount) return true;
  for (std::size_t k = 0; k < kInstantCount; ++k) {
    if (index == k * (count - 1) / (kInstantCount - 1)) return true;
  }
  return false;
}

/// The second is the local map that was used.
std::pair<FrameRecord, Orthomosaic> run_frame(Localizer& localizer, const RunPlan& plan,
                                              const Sequence::LocalMap& local_map) {
  FrameRecord record;
  record.number = local_map.number;
  const Stopwatch decoding;
  Frame frame = plan.read ? plan.read(local_map) : read_frame(plan.sequence, local_map);
  record.decode_s = decoding.seconds();
  if (!plan.use_odometry_file) frame.odom_from_robot.reset();
  const Stopwatch updating;
  record.estimate = localizer.update(frame, interrupt_token());
  record.update_s = updating.seconds();
  return {record, std::move(frame.local)};
}

void keep_for_figures(RunResult& result, const RunPlan& plan, const ParticleSet& particles,
                      Orthomosaic local) {
  const FrameRecord& record = result.records.back();
  const Pose2& pose = record.estimate.map_from_robot;
  result.seen.push_back(seen_ground(local, pose));
  if (!is_figure_instant(result.records.size() - 1, plan.frames.size())) return;
  const std::string label = "frame " + std::to_string(record.number);
  result.swarms.push_back({label, particles.poses, particles.weights, pose,
                           truth_at(plan.sequence, record.estimate.stamp)});
  result.comparisons.push_back({label, std::move(local), pose});
}

double sum_over(const std::vector<FrameRecord>& records, double FrameRecord::*seconds) {
  double sum = 0.0;
  for (const FrameRecord& record : records) sum += record.*seconds;
  return sum;
}

}  // namespace

Trajectory RunResult::trajectory() const {
  Trajectory trajectory;
  for (const FrameRecord& record : records) {
    trajectory.push_back({record.estimate.stamp, record.estimate.map_from_robot});
  }
  return trajectory;
}

int RunResult::answered() const {
  return static_cast<int>(std::ranges::count_if(records, [](const FrameRecord& record) {
    return record.estimate.status == EstimateStatus::kOk;
  }));
}

double RunResult::update_s() const { return sum_over(records, &FrameRecord::update_s); }
double RunResult::decode_s() const { return sum_over(records, &FrameRecord::decode_s); }

RunResult run_localizer(const RunPlan& plan, const std::function<void(int)>& progress) {
  RunResult result;
  const Stopwatch preparing;
  Localizer localizer(plan.map, plan.surface, plan.options, plan.seed);
  localizer.start_near(plan.start.pose, plan.start.spread);
  result.prepare_s = preparing.seconds();
  for (std::size_t i = 0; i < plan.frames.size(); ++i) {
    if (interrupted()) {
      result.interrupted = true;
      break;
    }
    for (RunObserver* observer : plan.observers) {
      if (const auto start = observer->new_start())
        localizer.start_near(start->pose, start->spread);
    }
    if (plan.new_map) {
      if (const auto map = plan.new_map()) localizer.use_map(*map);
    }
    const Sequence::LocalMap& local_map = plan.frames[i];
    try {
      auto [record, local] = run_frame(localizer, plan, local_map);
      result.records.push_back(record);
      keep_for_figures(result, plan, localizer.particles(), std::move(local));
    } catch (const Stopped&) {  // while the local map was being made
      result.interrupted = true;
      break;
    }
    for (RunObserver* observer : plan.observers) {
      observer->frame_done(result.records.back(), localizer.particles());
    }
    progress(static_cast<int>(i) + 1);
  }
  return result;
}

}  // namespace nadir::cli
