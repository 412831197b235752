// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/poses/pose_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "nadir/ground_mapping/poses/tracking.hpp"

namespace nadir::ground {
namespace {

/// A pair stays open until the poses move the points by this much, or this many frames.
constexpr double kEnoughMotionPx = 6.0;
constexpr int kLongestPair = 8;
/// Below it a pair says nothing.
constexpr double kLeastMotionPx = 1.5;
/// The first pairs follow on each other; then the gap grows by a frame a pair, up to the widest.
constexpr int kPairsInARow = 2;
constexpr int kWidestGap = 16;
/// In a queue of cars this share of what is seen stands still, or more.
constexpr double kSteady = 0.25;
constexpr std::size_t kFewestTracks = 10;
constexpr double kLeastTracked = 0.25;
/// Another reading of the poses explains a misfit where it fits, and leaves so much of it at most.
constexpr double kExplained = 0.3;

/// A thousandth of less, metres, is no motion: it fits wherever a standing robot does.
constexpr double kLeastInMillimetres = 10.0;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool is_power_of_two(int value) { return (value & (value - 1)) == 0; }

OdomPose3 shortened(OdomPose3 pose) {
  pose.translation *= 1e-3;
  return pose;
}

/// y negated, in the world and on the robot.
OdomPose3 mirrored(const OdomPose3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  const Eigen::Vector3d& t = pose.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
}

/// The pose read as one that leads from the odometry to the robot.
OdomPose3 inverted(const OdomPose3& pose) {
  const auto back = pose.inverse();
  return {back.rotation, back.translation};
}

CameraStep step_between(const OdomPose3& from, const OdomPose3& to, const Sighting& sighting) {
  const auto from_camera = from * sighting.robot_from_camera;
  const auto to_camera = to * sighting.robot_from_camera;
  return to_camera.inverse() * from_camera;
}

PoseFault explain(const std::vector<Track>& tracks, const Sighting& sighting, const OdomPose3& from,
                  const OdomPose3& to, double offset) {
  const std::array<std::pair<PoseFault, CameraStep>, 4> readings{
      {{PoseFault::kStandingImages, CameraStep{}},
       {PoseFault::kMillimetres, step_between(shortened(from), shortened(to), sighting)},
       {PoseFault::kInverted, step_between(inverted(from), inverted(to), sighting)},
       {PoseFault::kMirrored, step_between(mirrored(from), mirrored(to), sighting)}}};
  PoseFault best = PoseFault::kUnknown;
  double least = std::min(kExplained * offset, PoseFit::kMisfitPx);
  const double moved_m = (to.translation - from.translation).norm();
  for (const auto& [fault, step] : readings) {
    if (fault == PoseFault::kMillimetres && moved_m < kLeastInMillimetres) continue;
    const double left = offset_of(tracks, sighting.camera, step, kSteady);
    if (left < least) {
      least = left;
      best = fault;
    }
  }
  return best;
}

/// Frames between a pair and the next, where so many were closed.
int gap_after(int closed) { return std::clamp(closed - kPairsInARow, 0, kWidestGap); }

}  // namespace

bool PoseCheck::step(const StampedOdomPose3& now) {
  if (last_) {
    const double metres =
        (now.odom_from_robot.translation - last_->odom_from_robot.translation).norm();
    steps_m_.push_back(metres);
    speeds_m_per_s_.push_back(metres / (now.stamp.seconds() - last_->stamp.seconds()));
  }
  last_ = now;
  ++frames_since_;
  return first_ ? is_power_of_two(frames_since_) : frames_since_ >= gap_after(closed_);
}

void PoseCheck::take(Sighting sighting) {
  Seen now{std::move(sighting), last_->odom_from_robot};
  if (!first_) {
    first_ = std::move(now);
    frames_since_ = 0;
    return;
  }
  // A landmark that is lost while the pair grows leaves what was known of the pair before.
  const std::optional<Pair> pair = judge(*first_, now);
  if (pair) open_ = pair;
  // Where the poses stand and the images do not, a longer pair gives the traffic time to pass.
  const bool traffic = pair && pair->posed_px < kLeastMotionPx && pair->found_px >= kLeastMotionPx;
  const bool decided = !pair || traffic || pair->offset_px > PoseFit::kMisfitPx ||
                       pair->posed_px >= kEnoughMotionPx || frames_since_ >= kLongestPair;
  if (decided) close(std::move(now));
}

std::optional<PoseCheck::Pair> PoseCheck::judge(const Seen& first, const Seen& second) {
  const CameraModel& camera = second.sighting.camera;
  const CameraStep expected =
      step_between(first.odom_from_robot, second.odom_from_robot, first.sighting);
  const std::vector<Track> tracks = track(first.sighting, second.sighting, expected);
  const double fewest = kLeastTracked * static_cast<double>(first.sighting.landmarks.size());
  if (tracks.size() < kFewestTracks || static_cast<double>(tracks.size()) < fewest) {
    return std::nullopt;
  }
  std::vector<Track> expectations;
  for (const Landmark& landmark : first.sighting.landmarks) {
    if (const auto pixel = camera.project(moved(expected, landmark.p_in_camera))) {
      expectations.push_back({landmark.p_in_camera, *pixel});
    }
  }
  Pair pair{.offset_px = offset_of(tracks, camera, expected, kSteady),
            .found_px = offset_of(tracks, camera, {}, 0.5),
            .posed_px = offset_of(expectations, camera, {}, 0.5)};
  if (pair.offset_px > PoseFit::kMisfitPx) {
    pair.fault = explain(tracks, second.sighting, first.odom_from_robot, second.odom_from_robot,
                         pair.offset_px);
    if (pair.posed_px < kLeastMotionPx) pair.fault = PoseFault::kStandingPoses;
  }
  return pair;
}

void PoseCheck::close(Seen now) {
  if (open_ && std::fmax(open_->found_px, open_->posed_px) >= kLeastMotionPx)
    judged_.push_back(*open_);
  open_.reset();
  first_.reset();
  frames_since_ = 0;
  if (gap_after(++closed_) == 0) first_ = std::move(now);
}

PoseFit PoseCheck::fit() const {
  PoseFit fit;
  fit.steps = static_cast<int>(steps_m_.size());
  if (fit.steps > 0) {
    fit.step_m = median(steps_m_);
    fit.speed_m_per_s = median(speeds_m_per_s_);
  }
  fit.pairs = static_cast<int>(judged_.size());
  if (judged_.empty()) return fit;
  std::vector<double> offsets;
  std::map<PoseFault, int> faults;
  for (const Pair& pair : judged_) {
    offsets.push_back(pair.offset_px);
    fit.gross += pair.offset_px > PoseFit::kGrossPx ? 1 : 0;
    if (pair.offset_px <= PoseFit::kMisfitPx) continue;
    ++fit.misfits;
    if (2 * ++faults[pair.fault] > fit.pairs) fit.fault = pair.fault;
  }
  fit.offset_px = median(offsets);
  return fit;
}

}  // namespace nadir::ground
