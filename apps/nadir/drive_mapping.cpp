// SPDX-License-Identifier: Apache-2.0
#include "drive_mapping.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/interrupt.hpp"
#include "nadir/core/error.hpp"
#include "nadir/pipelines/stopwatch.hpp"

namespace nadir::cli {
namespace {

constexpr double kJudgedSideM = 18.0;  ///< the paper's square

GroundMapper mapper_of(const Drive& drive, const GroundMappingOptions& options) {
  return std::visit([&](const auto& rig) { return GroundMapper(rig, options); }, drive.rig);
}

const Drive& with_poses(const Drive& drive) {
  if (drive.odometry) return drive;
  throw Error(ErrorKind::kInput, "the drive has no poses", drive.name,
              "give --poses FILE with odom_from_robot at every frame, from wheel, inertial or "
              "visual odometry: TUM (t tx ty tz qx qy qz qw) or KITTI (12 numbers a row); nadir "
              "computes no visual odometry");
}

RenderOptions square(RenderOptions options, double side_m) {
  options.size_x_m = side_m;
  options.size_y_m = side_m;
  return options;
}

/// Adds a sentence, or counts it where it was said before.
void count(std::vector<std::pair<std::string, int>>& said, const std::string& sentence, int times) {
  const auto known = std::ranges::find(said, sentence, &std::pair<std::string, int>::first);
  if (known == said.end()) {
    said.emplace_back(sentence, times);
  } else {
    known->second += times;
  }
}

}  // namespace

DriveMapping::DriveMapping(const Drive& drive, const Options& options)
    : drive_(with_poses(drive)), options_(options), mapper_(mapper_of(drive, options.mapping)) {
  if (options.local_map.up != MapUp::kRobot) {
    throw Error(ErrorKind::kUsage, "local maps of a site lie in the robot frame", "local_map.up",
                "leave it at robot");
  }
  if (options.self_check) {
    check_ = std::visit(
        [&](const auto& rig) { return std::make_unique<OddEvenCheck>(rig, options.mapping); },
        drive.rig);
  }
  plan(options.every);
}

void DriveMapping::plan(const Spacing& every) {
  double since = 0.0;
  std::optional<std::size_t> last;
  std::optional<OdomPose3> before;
  for (std::size_t i = 0; i < drive_.frames.size(); ++i) {
    const auto pose = pose_at(*drive_.odometry, drive_.frames[i].stamp);
    if (!pose) continue;
    if (before && every.unit == Spacing::Unit::kMetres) {
      since += (pose->translation - before->translation).norm();
    } else if (before && every.unit == Spacing::Unit::kSeconds) {
      since += drive_.frames[i].stamp.seconds() - drive_.frames[*last].stamp.seconds();
    } else if (before) {
      since += 1.0;
    }
    // A step that falls short by the rounding of a sum counts as whole.
    if (!before || since >= every.amount * (1.0 - 1e-9)) {
      due_.push_back(i);
      since = before ? std::fmod(since, every.amount) : 0.0;
      if (every.amount - since < 1e-9 * every.amount) since = 0.0;
    }
    before = pose;
    last = i;
  }
  if (!last) {
    throw Error(
        ErrorKind::kInput,
        fmt::format("the poses, {} s to {} s, cover none of the frames, {} s to {} s",
                    to_string(drive_.odometry->front().stamp),
                    to_string(drive_.odometry->back().stamp),
                    to_string(drive_.frames.front().stamp), to_string(drive_.frames.back().stamp)),
        drive_.name, "give the poses of this drive, with stamps of the same clock");
  }
  if (due_.back() != *last) due_.push_back(*last);
}

void DriveMapping::take(const DriveFrame& frame) {
  MappedFrame done{frame.number, frame.stamp, pose_at(*drive_.odometry, frame.stamp), {}, 0.0};
  const auto integrate = [&](const auto& sensed) {
    done.statistics = mapper_.integrate(sensed, *done.odom_from_robot);
    if (check_) check_->integrate(sensed, *done.odom_from_robot);
  };
  try {
    if (done.odom_from_robot) {
      const Stopwatch decoding;
      if (drive_.is_stereo()) {
        const StereoFrame sensed = drive_.read_stereo(frame);
        done.decode_ms = 1e3 * decoding.seconds();
        integrate(sensed);
      } else {
        const LidarFrame sensed = drive_.read_lidar(frame, notes_);
        done.decode_ms = 1e3 * decoding.seconds();
        integrate(sensed);
      }
      any_ = any_ || done.statistics.status == MappingStatus::kOk;
    }
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("frame {}: {}", frame.number, error.what()));
  }
  frames_.push_back(std::move(done));
  refuse_wrong_poses();
}

void DriveMapping::refuse_wrong_poses() const {
  const PoseFit fit = mapper_.pose_fit();
  if (!is_gross(fit)) return;
  throw Error(ErrorKind::kInput, pose_misfit(fit).value(), drive_.pose_file.string(),
              "--set ground_mapping.check_poses=off maps all the same");
}

std::optional<RenderedMap> DriveMapping::map_at(std::size_t position,
                                                const std::function<void(int)>& progress) {
  for (; next_ <= position; ++next_) {
    stop_if_interrupted();
    take(drive_.frames[next_]);
    if (progress) progress(static_cast<int>(next_) + 1);
  }
  if (!any_) return std::nullopt;
  const Stopwatch rendering;
  RenderOptions options = options_.local_map;
  options.at = frames_.back().odom_from_robot;
  RenderedMap rendered{frames_.back().number, mapper_.render(options), 0.0};
  rendered.map.stamp = frames_.back().stamp;
  rendered.render_ms = 1e3 * rendering.seconds();
  return rendered;
}

std::optional<LocalMap> DriveMapping::last_square() const {
  const double grid_m = options_.mapping.resolution_m * options_.mapping.grid_cells;
  if (!any_ || grid_m < kJudgedSideM) return std::nullopt;
  RenderOptions options = square(options_.local_map, kJudgedSideM);
  options.ground_only = false;
  return mapper_.render(options);
}

std::optional<MapComparison> DriveMapping::comparison() const {
  const auto mapped = std::ranges::count_if(
      frames_, [](const MappedFrame& frame) { return frame.odom_from_robot.has_value(); });
  if (!check_ || mapped < 2) return std::nullopt;
  return check_->compare(square(options_.local_map, kJudgedSideM));
}

std::vector<std::string> DriveMapping::doubts(const std::optional<MapComparison>& compared) const {
  std::vector<std::string> doubts;
  if (const auto misfit = pose_misfit(mapper_.pose_fit())) {
    doubts.push_back(drive_.pose_file.string() + ": " + *misfit);
  }
  if (compared) {
    if (const auto misfit = pose_misfit(*compared)) doubts.push_back(*misfit);
  }
  const auto mapped = std::ranges::count_if(frames_, [](const MappedFrame& frame) {
    return frame.odom_from_robot && frame.statistics.status == MappingStatus::kOk;
  });
  if (2 * mapped < std::ssize(frames_)) {
    doubts.push_back(
        fmt::format("{}: only {} of {} frames are in the local maps; check that the "
                    "poses are those of this drive, and its calibration",
                    drive_.name, mapped, frames_.size()));
  }
  return doubts;
}

std::vector<std::string> DriveMapping::warnings() const {
  std::vector<std::pair<std::string, int>> said;
  for (const std::string& note : drive_.notes) count(said, note, 1);
  for (const std::string& note : notes_) count(said, note, 1);
  for (const MappedFrame& frame : frames_) {
    if (!frame.odom_from_robot) count(said, "no pose at its time: frame left out", 1);
    if (frame.odom_from_robot && frame.statistics.status != MappingStatus::kOk) {
      count(said, "frame skipped: " + to_string(frame.statistics.status), 1);
    }
    for (const std::string& warning : frame.statistics.warnings) count(said, warning, 1);
  }
  std::vector<std::string> warnings;
  for (const auto& [sentence, times] : said) {
    warnings.push_back(times > 1 ? fmt::format("{} ({} times)", sentence, times) : sentence);
  }
  return warnings;
}

Frame to_frame(const LocalMap& map) {
  return {map.stamp, map.ortho, planar(map.odom_from_robot), map.elevation};
}

}  // namespace nadir::cli
