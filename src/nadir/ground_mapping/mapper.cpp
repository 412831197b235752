// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/ground_mapping/depth/lidar_source.hpp"
#include "nadir/ground_mapping/depth/stereo_source.hpp"
#include "nadir/ground_mapping/depth/stopwatch.hpp"
#include "nadir/ground_mapping/grid/aggregator.hpp"
#include "nadir/ground_mapping/grid/cleaner.hpp"
#include "nadir/ground_mapping/grid/colouriser.hpp"
#include "nadir/ground_mapping/grid/fuser.hpp"
#include "nadir/ground_mapping/grid/renderer.hpp"
#include "nadir/ground_mapping/poses/pose_check.hpp"

namespace nadir {
namespace {

using ground::RobotMotion;

/// What a ground robot can do at most; the pose may leave its prediction by as much.
constexpr double kAcceleration = 3.0;           // m/s^2
constexpr double kAngularAcceleration = 300.0;  // deg/s^2
/// A class that swallows more than this share of a frame's points is worth a warning.
constexpr double kMostDropped = 0.9;

GroundMappingOptions with_rule(GroundMappingOptions options, ColourRule automatic) {
  check(options);
  if (options.colour_rule == ColourRule::kAuto) options.colour_rule = automatic;
  return options;
}

/// The motion of the robot between two poses, in the frame of the earlier one.
RobotMotion motion_between(const StampedOdomPose3& from, const StampedOdomPose3& to) {
  return {from.odom_from_robot.inverse() * to.odom_from_robot,
          to.stamp.seconds() - from.stamp.seconds()};
}

double angle_deg(const Eigen::Quaterniond& turn) {
  return degrees(Eigen::AngleAxisd(turn).angle());
}

void warn_of_drops(FrameStatistics& statistics) {
  const DroppedPoints& d = statistics.dropped;
  const std::pair<std::int64_t, const char*> classes[] = {
      {d.no_disparity, "have no match in the other image, or no range"},
      {d.range, "lie outside the range limits"},
      {d.height,
       "lie outside the height gate about the sensor: check its pose and the axes of the "
       "odometry"},
      {d.outside, "lie outside the grid"},
      {d.texture, "lie where the image is too plain"},
      {d.sparse, "lie alone in their cell"},
      {d.gate, "contradict the map: check the poses"}};
  for (const auto& [count, reason] : classes) {
    const double share = static_cast<double>(count) / static_cast<double>(statistics.points_in);
    if (share > kMostDropped) {
      statistics.warnings.push_back(std::to_string(std::lround(100.0 * share)) +
                                    " % of the points " + reason);
    }
  }
}

}  // namespace

class GroundMapper::Impl {
 public:
  using Source = std::variant<ground::StereoSource, ground::LidarSource>;

  Impl(Source source, const GroundMappingOptions& options)
      : options_(options),
        source_(std::move(source)),
        grid_(options.resolution_m, options.grid_cells),
        aggregator_(options.height_sigma_m),
        fuser_(options) {}

  template <class Sensor>
  FrameStatistics integrate(const typename Sensor::SensorFrame& frame, const OdomPose3& pose) {
    auto* sensor = std::get_if<Sensor>(&source_);
    if (sensor == nullptr) {
      throw Error(ErrorKind::kUsage, "the frame is not of the sensor that the mapper was made for");
    }
    check_pose(frame.stamp, pose);
    FrameStatistics statistics;
    const StampedOdomPose3 now{frame.stamp, pose};
    const RobotMotion motion = follow(now, statistics);
    const ground::Measurement measurement = sensor->measure(frame, pose, motion, statistics);
    channels_ = std::max(channels_, measurement.channels);
    if (measurement.status != MappingStatus::kOk) {
      statistics.status = measurement.status;
    } else {
      add(measurement, sensor->min_points(), sensor->max_range_m(), statistics);
    }
    warn_of_drops(statistics);
    if (options_.check_poses && pose_check_.step(now)) {
      if (auto sighting = sensor->sighting(frame)) {
        pose_check_.take(std::move(*sighting));
      }
    }
    return statistics;
  }

  LocalMap render(const RenderOptions& options) const {
    if (!last_) {
      throw Error(ErrorKind::kUsage, "there is no local map before the first frame");
    }
    LocalMap map = ground::render(grid_, options.at.value_or(last_->odom_from_robot), options,
                                  channels_, options_.fill_cells);
    map.stamp = last_->stamp;
    return map;
  }

  PoseFit pose_fit() const { return pose_check_.fit(); }

  double min_range_m() const {
    return std::visit([](const auto& source) { return source.min_range_m(); }, source_);
  }
  double max_range_m() const {
    return std::visit([](const auto& source) { return source.max_range_m(); }, source_);
  }

 private:
  void check_pose(Stamp stamp, const OdomPose3& pose) const {
    if (!pose.is_finite()) {
      throw Error(ErrorKind::kInput, "the odometry is not finite", "stamp " + to_string(stamp));
    }
    if (last_ && stamp <= last_->stamp) {
      throw Error(ErrorKind::kInput,
                  "the stamp does not increase: it follows " + to_string(last_->stamp),
                  "stamp " + to_string(stamp), "give the frames in the order of their stamps");
    }
  }

  /// Notes the pose; drops the map where it has jumped. Returns the robot's last step.
  RobotMotion follow(const StampedOdomPose3& now, FrameStatistics& statistics) {
    RobotMotion motion;
    if (last_) {
      motion = motion_between(*last_, now);
      const bool jumped = last_motion_.duration_s > 0.0 && has_jumped(motion, statistics);
      if (jumped) {
        grid_.clear();
        statistics.map_dropped = true;
        last_motion_ = {};
        motion = {};
      } else {
        last_motion_ = motion;
        elapsed_ms_ += static_cast<std::uint32_t>(std::lround(1e3 * motion.duration_s));
        odometer_mm_ +=
            static_cast<std::uint32_t>(std::lround(1e3 * motion.step.translation.norm()));
      }
    }
    last_ = now;
    ++frame_;
    return motion;
  }

  bool has_jumped(const RobotMotion& motion, FrameStatistics& statistics) const {
    const double share = motion.duration_s / last_motion_.duration_s;
    const Eigen::AngleAxisd turn(last_motion_.step.rotation);
    const Eigen::Quaterniond expected_turn(Eigen::AngleAxisd(turn.angle() * share, turn.axis()));
    const double metres = (motion.step.translation - share * last_motion_.step.translation).norm();
    const double turned = angle_deg(expected_turn.conjugate() * motion.step.rotation);
    const double squared = motion.duration_s * motion.duration_s;
    if (metres <= options_.pose_jump_m + kAcceleration * squared &&
        turned <= options_.pose_jump_deg + kAngularAcceleration * squared) {
      return false;
    }
    statistics.warnings.push_back("the pose jumped by " + to_text(std::round(metres * 100) / 100) +
                                  " m and " + to_text(std::round(turned * 10) / 10) +
                                  " degrees against its prediction: the map was dropped");
    return true;
  }

  void add(const ground::Measurement& measurement, int min_points, double max_range,
           FrameStatistics& statistics) {
    const Eigen::Vector3d& sensor = measurement.sensor_in_odom;
    ground::Stopwatch watch;
    grid_.centre_on(grid_.index_of(sensor.x(), sensor.y()));
    const double moved = watch.lap();
    statistics.dropped.outside = aggregator_.aggregate(measurement, grid_);
    statistics.ms.aggregate = watch.lap();
    const ground::Progress now{elapsed_ms_, odometer_mm_, frame_};
    fuser_.fuse_heights(aggregator_, grid_, sensor, now, min_points, statistics);
    if (options_.colour_rule != ColourRule::kInverse) {
      fuser_.fuse_colours(aggregator_, grid_, options_.colour_rule, statistics);
    }
    statistics.ms.fuse = moved + watch.lap();
    if (options_.clear_seen_through) {
      statistics.cells_cleared = ground::clear_seen_through(aggregator_, grid_, sensor, now);
    }
    statistics.ms.clean = watch.lap();
    if (options_.colour_rule == ColourRule::kInverse) {
      statistics.exposure_gain = ground::colour_inversely(grid_, measurement, max_range, options_);
      statistics.ms.colour += watch.lap();
    }
    if (statistics.cells_new + statistics.cells_updated + statistics.cells_rejected == 0) {
      statistics.status = MappingStatus::kNoPoints;
    }
  }

  GroundMappingOptions options_;
  Source source_;
  ground::ElevationGrid grid_;
  ground::Aggregator aggregator_;
  ground::Fuser fuser_;
  ground::PoseCheck pose_check_;
  std::optional<StampedOdomPose3> last_;
  RobotMotion last_motion_;
  std::uint32_t elapsed_ms_ = 0;
  std::uint32_t odometer_mm_ = 0;
  std::uint8_t frame_ = 0;
  int channels_ = 1;
};

GroundMapper::GroundMapper(const StereoRig& rig, const GroundMappingOptions& options) {
  const GroundMappingOptions resolved = with_rule(options, ColourRule::kMean);
  impl_ = std::make_unique<Impl>(ground::StereoSource(rig, resolved), resolved);
}

GroundMapper::GroundMapper(const LidarRig& rig, const GroundMappingOptions& options) {
  const GroundMappingOptions resolved = with_rule(options, ColourRule::kInverse);
  impl_ = std::make_unique<Impl>(ground::LidarSource(rig, resolved), resolved);
}

GroundMapper::~GroundMapper() = default;
GroundMapper::GroundMapper(GroundMapper&&) noexcept = default;
GroundMapper& GroundMapper::operator=(GroundMapper&&) noexcept = default;

FrameStatistics GroundMapper::integrate(const StereoFrame& frame,
                                        const OdomPose3& odom_from_robot) {
  return impl_->integrate<ground::StereoSource>(frame, odom_from_robot);
}

FrameStatistics GroundMapper::integrate(const LidarFrame& frame, const OdomPose3& odom_from_robot) {
  return impl_->integrate<ground::LidarSource>(frame, odom_from_robot);
}

LocalMap GroundMapper::render(const RenderOptions& options) const { return impl_->render(options); }

PoseFit GroundMapper::pose_fit() const { return impl_->pose_fit(); }

double GroundMapper::min_range_m() const { return impl_->min_range_m(); }
double GroundMapper::max_range_m() const { return impl_->max_range_m(); }

}  // namespace nadir
