// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/depth/lidar_source.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/ground_mapping/depth/images.hpp"
#include "nadir/ground_mapping/depth/stopwatch.hpp"
#include "nadir/ground_mapping/grid/colouriser.hpp"

namespace nadir::ground {
namespace {

constexpr std::size_t kPointsPerStripe = 4096;
/// Pixels of the image in one cell of the z-buffer: a sweep is sparser than an image.
constexpr int kDepthStep = 4;
/// Beam spread across the ray: metres, and metres per metre (HDL-32E, elevation_mapping).
constexpr double kLateralSigma = 0.0015;
constexpr double kLateralSpread = 0.0006;
/// No ground robot's lidar sees so far: the points are in millimetres.
constexpr double kAbsurdRange = 200.0;

bool usable(const LidarPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z) &&
         (point.x != 0.0F || point.y != 0.0F || point.z != 0.0F);
}

void check_units(const std::vector<LidarPoint>& points) {
  std::vector<double> ranges;
  for (std::size_t i = 0; i < points.size(); i += 16) {
    const LidarPoint& p = points[i];
    if (usable(p)) ranges.push_back(Eigen::Vector3d(p.x, p.y, p.z).norm());
  }
  if (ranges.empty()) return;
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  if (*middle > kAbsurdRange) {
    throw Error(ErrorKind::kInput,
                "the median lidar range is " + to_text(std::round(*middle)) + " m", {},
                "the points must be in metres; they look like millimetres");
  }
}

/// Where the robot was at a time offset from the stamp, by the velocity of its last step.
class SweepPoses {
 public:
  SweepPoses(OdomPose3 pose, RobotMotion motion)
      : pose_(std::move(pose)), motion_(std::move(motion)), turn_(motion_.step.rotation) {}

  OdomPose3 at(double offset_s) const {
    if (offset_s == 0.0 || motion_.duration_s <= 0.0) return pose_;
    const double share = offset_s / motion_.duration_s;
    const Eigen::AngleAxisd part(turn_.angle() * share, turn_.axis());
    return pose_ * Transform3<frames::Robot, frames::Robot>{Eigen::Quaterniond(part),
                                                            share * motion_.step.translation};
  }

 private:
  OdomPose3 pose_;
  RobotMotion motion_;
  Eigen::AngleAxisd turn_;
};

}  // namespace

LidarSource::LidarSource(const LidarRig& rig, const GroundMappingOptions& options)
    : rig_(rig), options_(options) {
  if (!rig.robot_from_lidar.is_finite()) {
    throw Error(ErrorKind::kInput, "the pose of the lidar on the robot is not finite", {},
                "check the calibration");
  }
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    check_camera(rig.cameras[i].model, "lidar's " + std::to_string(i + 1) + ".");
    if (!rig.cameras[i].robot_from_camera.is_finite()) {
      throw Error(ErrorKind::kInput, "the pose of a camera on the robot is not finite", {},
                  "check the calibration");
    }
  }
}

Measurement LidarSource::measure(const LidarFrame& frame, const OdomPose3& odom_from_robot,
                                 const RobotMotion& motion, FrameStatistics& statistics) {
  if (!frame.images.empty() && frame.images.size() != rig_.cameras.size()) {
    throw Error(ErrorKind::kInput,
                "the sweep comes with " + std::to_string(frame.images.size()) +
                    " images, the rig has " + std::to_string(rig_.cameras.size()) + " cameras",
                {}, "give one image a camera, or none");
  }
  check_units(frame.points);
  Stopwatch watch;
  Measurement measurement;
  measurement.channels = 1;
  for (std::size_t i = 0; i < frame.images.size(); ++i) {
    check_image(frame.images[i], rig_.cameras[i].model, "camera " + std::to_string(i + 1));
    measurement.channels = std::max(measurement.channels, frame.images[i].channels());
    ColourView view;
    view.image = frame.images[i];
    view.model = rig_.cameras[i].model;
    view.odom_from_camera = odom_from_robot * rig_.cameras[i].robot_from_camera;
    view.depth_step = kDepthStep;
    view.depth =
        Raster<float>(view.model.width / kDepthStep + 1, view.model.height / kDepthStep + 1,
                      std::numeric_limits<float>::infinity());
    measurement.views.push_back(std::move(view));
  }
  statistics.ms.rectify = watch.lap();
  to_points(frame, odom_from_robot, motion, measurement, statistics);
  statistics.ms.points = watch.lap();
  colour(measurement);
  statistics.ms.colour = watch.lap();
  return measurement;
}

std::optional<Sighting> LidarSource::sighting(const LidarFrame& frame) const {
  if (frame.images.empty()) return std::nullopt;
  const MountedCamera& mounted = rig_.cameras.front();
  Sighting sighting =
      sighting_of(view_of(frame.images.front()), mounted.model, mounted.robot_from_camera);
  const cv::Size size = sighting.grey.size();
  cv::Mat depth(size, CV_32F, cv::Scalar(0.0));
  const auto camera_from_lidar = mounted.robot_from_camera.inverse() * rig_.robot_from_lidar;
  for (const LidarPoint& point : frame.points) {
    if (!usable(point)) continue;
    const Eigen::Vector3d p =
        (camera_from_lidar * Point3<frames::Lidar>{point.x, point.y, point.z}).vector();
    if (!(p.z() > options_.lidar_min_range_m)) continue;
    const auto pixel = sighting.camera.project(p);
    if (!pixel || !(pixel->x() >= 0.0 && pixel->y() >= 0.0 && pixel->x() < size.width &&
                    pixel->y() < size.height)) {
      continue;
    }
    // A sweep is sparser than the image: a point stands for the pixels around it, the nearest wins.
    const cv::Rect around =
        cv::Rect(static_cast<int>(pixel->x()) - 1, static_cast<int>(pixel->y()) - 1, 3, 3) &
        cv::Rect({}, size);
    for (int row = around.y; row < around.y + around.height; ++row) {
      for (int column = around.x; column < around.x + around.width; ++column) {
        auto& nearest = depth.at<float>(row, column);
        if (nearest == 0.0F || p.z() < nearest) nearest = static_cast<float>(p.z());
      }
    }
  }
  find_landmarks(sighting, depth);
  return sighting;
}

void LidarSource::to_points(const LidarFrame& frame, const OdomPose3& odom_from_robot,
                            const RobotMotion& motion, Measurement& measurement,
                            FrameStatistics& statistics) const {
  const SweepPoses poses(odom_from_robot, motion);
  const Eigen::Vector3d sensor = (odom_from_robot * rig_.robot_from_lidar).translation;
  measurement.sensor_in_odom = sensor;
  const double attitude = radians(options_.attitude_sigma_deg);
  const std::size_t stripes = (frame.points.size() + kPointsPerStripe - 1) / kPointsPerStripe;
  measurement.points.resize(stripes);
  std::vector<DroppedPoints> dropped(stripes);
  tbb::parallel_for(std::size_t{0}, stripes, [&](std::size_t stripe) {
    const std::size_t end = std::min(frame.points.size(), (stripe + 1) * kPointsPerStripe);
    float time = std::numeric_limits<float>::quiet_NaN();
    Transform3<frames::Odom, frames::Lidar> odom_from_lidar;
    for (std::size_t i = stripe * kPointsPerStripe; i < end; ++i) {
      const LidarPoint& in = frame.points[i];
      if (!usable(in)) {
        ++dropped[stripe].no_disparity;
        continue;
      }
      const Eigen::Vector3d beam(in.x, in.y, in.z);
      const double range = beam.norm();
      if (range < options_.lidar_min_range_m || range > options_.lidar_max_range_m) {
        ++dropped[stripe].range;
        continue;
      }
      if (in.time_offset_s != time) {
        time = in.time_offset_s;
        odom_from_lidar = poses.at(static_cast<double>(time)) * rig_.robot_from_lidar;
      }
      const Eigen::Vector3d turned = odom_from_lidar.rotation * beam;
      const Eigen::Vector3d p = turned + odom_from_lidar.translation - sensor;
      if (p.z() < -options_.height_gate_below_m || p.z() > options_.height_gate_above_m) {
        ++dropped[stripe].height;
        continue;
      }
      // Equation 6, with the beam's own direction: only its vertical share counts.
      const double along = turned.z() / range;
      const double lateral = kLateralSigma + kLateralSpread * range;
      const double range_sigma = options_.lidar_range_sigma_m;
      const double variance = along * along * range_sigma * range_sigma +
                              (1.0 - along * along) * lateral * lateral +
                              p.head<2>().squaredNorm() * attitude * attitude +
                              options_.height_sigma_m * options_.height_sigma_m;
      measurement.points[stripe].push_back({.x = static_cast<float>(p.x()),
                                            .y = static_cast<float>(p.y()),
                                            .z = static_cast<float>(p.z()),
                                            .height_variance = static_cast<float>(variance)});
    }
  });
  statistics.points_in = static_cast<std::int64_t>(frame.points.size());
  for (const DroppedPoints& lost : dropped) {
    statistics.dropped.no_disparity += lost.no_disparity;
    statistics.dropped.range += lost.range;
    statistics.dropped.height += lost.height;
  }
}

void LidarSource::colour(Measurement& measurement) const {
  const Eigen::Vector3d& sensor = measurement.sensor_in_odom;
  const auto place = [&sensor](const SurfacePoint& p) {
    return Point3<frames::Odom>::from(sensor + Eigen::Vector3d(p.x, p.y, p.z));
  };
  for (ColourView& view : measurement.views) {
    const auto camera_from_odom = view.odom_from_camera.inverse();
    for (const auto& stripe : measurement.points) {
      for (const SurfacePoint& point : stripe) {
        const Eigen::Vector3d p = (camera_from_odom * place(point)).vector();
        const auto pixel = view.model.project(p);
        if (!pixel) continue;
        const double u = std::floor(pixel->x() / kDepthStep),
                     v = std::floor(pixel->y() / kDepthStep);
        if (!(u >= 0.0 && v >= 0.0 && u < view.depth.width() && v < view.depth.height())) continue;
        float& nearest = view.depth.at(static_cast<int>(u), static_cast<int>(v));
        nearest = std::min(nearest, static_cast<float>(p.z()));
      }
    }
  }
  // By lookup of the cells themselves, later; the points then carry no colour.
  if (options_.colour_rule == ColourRule::kInverse) return;
  const std::vector<ViewSampler> samplers(measurement.views.begin(), measurement.views.end());
  tbb::parallel_for(std::size_t{0}, measurement.points.size(), [&](std::size_t stripe) {
    for (SurfacePoint& point : measurement.points[stripe]) {
      for (const ViewSampler& sampler : samplers) {
        const SampledColour seen = sampler.at(place(point), options_.resolution_m);
        if (seen.weight <= point.colour_weight) continue;
        point.colour_weight = seen.weight;
        for (std::size_t c = 0; c < 3; ++c) {
          point.colour[c] = static_cast<std::uint8_t>(std::lround(seen.colour[c]));
        }
      }
    }
  });
}

}  // namespace nadir::ground
