// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/depth/stereo_source.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/ground_mapping/depth/horizon.hpp"
#include "nadir/ground_mapping/depth/images.hpp"
#include "nadir/ground_mapping/depth/stopwatch.hpp"
#include "nadir/ground_mapping/stereo_order.hpp"

namespace nadir::ground {
namespace {

/// Disparities come in 16ths of a pixel.
constexpr int kSubPixels = 16;
/// SGBM is not repeatable where the image is hardly wider than the search (opencv issue 25828).
constexpr int kWidthBeyondSearch = 32;
/// A camera that stands lower, metres, is one whose height nobody gave.
constexpr double kLowestCamera = 0.1;
/// A smaller one, pixels, says too little about the depth to check a pose by.
constexpr double kLeastSightedDisparity = 2.0;
/// Farther than any ground that a metre-scaled pair can see: the calibration is in millimetres.
constexpr double kAbsurdDepth = 200.0;

int round_up(double value, int multiple) {
  return multiple * static_cast<int>(std::ceil(value / multiple - 1e-9));
}

/// The disparity of the ground in the lowest row of a robot that stands level; 0 where the rig does
/// not say how high the camera is, or does not look down there.
double disparity_of_nearest_ground(const RectifiedGeometry& geometry) {
  const CameraModel& camera = geometry.left;
  const Eigen::Vector3d ray =
      geometry.robot_from_left.rotation *
      camera.ray({0.5 * (camera.width - 1), static_cast<double>(camera.height - 1)});
  const double height = geometry.robot_from_left.translation.z();
  if (height < kLowestCamera || ray.z() >= 0.0) return 0.0;
  const double depth = height / -ray.z();
  return geometry.focal_baseline / depth - geometry.disparity_offset;
}

int disparities_for(const RectifiedGeometry& geometry, const GroundMappingOptions& options) {
  // What is nearer than the search reaches is not left out but matched wrongly: the search takes in
  // the nearest ground where that is known, up to a quarter of the width.
  const double width = geometry.left.width;
  const double nearest_ground = std::min(1.05 * disparity_of_nearest_ground(geometry), width / 4.0);
  int count = round_up(std::max(width / 10.0, nearest_ground), kSubPixels);
  if (options.min_range_m > 0.0) {
    const double nearest = geometry.focal_baseline / options.min_range_m;
    count = round_up(nearest - geometry.disparity_offset, kSubPixels);
  }
  if (options.disparities > 0) count = round_up(options.disparities, kSubPixels);
  const int most = (geometry.left.width - kWidthBeyondSearch - 1) / kSubPixels * kSubPixels;
  if (count > most) {
    throw Error(ErrorKind::kUsage,
                "a search of " + std::to_string(count) + " disparities needs an image wider than " +
                    std::to_string(geometry.left.width) + " pixels",
                {},
                "at most " + std::to_string(most) + " are possible, which reach down to " +
                    to_text(geometry.focal_baseline / std::max(1, most)) +
                    " m: raise min_range_m or lower disparities");
  }
  return std::max(count, kSubPixels);
}

/// All that depends on the disparity alone, looked up by it.
struct DepthTable {
  struct Entry {
    float depth = 0.0F;  ///< 0 = out of range
    float depth_variance = 0.0F;
    float lateral_variance = 0.0F;
    float colour_weight = 0.0F;
  };
  std::vector<Entry> entries;

  DepthTable(const RectifiedGeometry& geometry, const GroundMappingOptions& options,
             int disparities, double min_range, double max_range)
      : entries(static_cast<std::size_t>(disparities * kSubPixels)) {
    for (std::size_t i = 1; i < entries.size(); ++i) {
      const double disparity = static_cast<double>(i) / kSubPixels + geometry.disparity_offset;
      const double depth = geometry.focal_baseline / disparity;  // equation 1
      if (disparity <= 0.0 || depth < min_range || depth > max_range) continue;
      const double sigma = depth * depth * options.disparity_sigma_px / geometry.focal_baseline;
      const double lateral = 0.5 * depth / geometry.left.fx;
      const double half_cell = 0.5 * options.resolution_m;
      entries[i] = {static_cast<float>(depth), static_cast<float>(sigma * sigma),
                    static_cast<float>(lateral * lateral),
                    static_cast<float>(1.0 / (sigma * sigma + half_cell * half_cell))};
    }
  }
};

/// The standard deviation of the grey values in a window of 5 x 5 pixels is at least `least`.
cv::Mat textured(const cv::Mat& grey, double least) {
  cv::Mat mean, square, mask;
  cv::boxFilter(grey, mean, CV_32F, {5, 5});
  cv::sqrBoxFilter(grey, square, CV_32F, {5, 5});
  cv::Mat variance = square - mean.mul(mean);
  cv::compare(variance, least * least, mask, cv::CMP_GE);
  return mask;
}

double median_depth(const cv::Mat& disparity, const RectifiedGeometry& geometry) {
  std::vector<std::int16_t> values;
  for (int row = 0; row < disparity.rows; row += 4) {
    for (int column = 0; column < disparity.cols; column += 4) {
      const auto d = disparity.at<std::int16_t>(row, column);
      if (d > 0) values.push_back(d);
    }
  }
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return geometry.focal_baseline /
         std::max(1e-6, static_cast<double>(*middle) / kSubPixels + geometry.disparity_offset);
}

}  // namespace

struct StereoSource::Pixels {
  cv::Mat left;       ///< colours
  cv::Mat disparity;  ///< CV_16S, 16ths of a pixel
  cv::Mat textured;
  CameraModel camera;  ///< of these rows
  Transform3<frames::Odom, frames::Camera> odom_from_camera;
};

StereoSource::StereoSource(const StereoRig& rig, const GroundMappingOptions& options)
    : rig_(rig),
      options_(options),
      rectifier_(rig, options.image_scale),
      disparities_(disparities_for(rectifier_.geometry(), options)) {
  const RectifiedGeometry& geometry = rectifier_.geometry();
  min_range_ = std::max(options.min_range_m,
                        geometry.focal_baseline / (disparities_ + geometry.disparity_offset));
  // Equation 4; the disparity's error is that of the scaled image.
  max_range_ = options.max_range_m > 0.0
                   ? options.max_range_m
                   : std::sqrt(options.max_depth_sigma_m * geometry.focal_baseline /
                               options.disparity_sigma_px / options.image_scale);
  if (max_range_ <= min_range_) {
    throw Error(ErrorKind::kUsage,
                "the stereo pair measures from " + to_text(min_range_) +
                    " m on, but only depths up "
                    "to " +
                    to_text(max_range_) + " m are wanted",
                {}, "raise ground_mapping.disparities or ground_mapping.max_range_m");
  }
  const int block = options.block_size;
  matcher_ = cv::StereoSGBM::create(0, disparities_, block, 2 * block * block, 32 * block * block,
                                    1, 31, 8, 100, 2, cv::StereoSGBM::MODE_SGBM_3WAY);
}

cv::Mat StereoSource::match(const cv::Mat& left, const cv::Mat& right) {
  cv::Mat disparity;
  matcher_->compute(left, right, disparity);
  return disparity;
}

Measurement StereoSource::measure(const StereoFrame& frame, const OdomPose3& odom_from_robot,
                                  const RobotMotion& /*motion*/, FrameStatistics& statistics) {
  check_image(frame.left, rig_.left, "left");
  check_image(frame.right, rig_.right, "right");
  const RectifiedGeometry& geometry = rectifier_.geometry();
  disparity_.release();
  Measurement measurement;
  measurement.channels = frame.left.channels();
  Pixels pixels;
  pixels.odom_from_camera = odom_from_robot * geometry.robot_from_left;
  measurement.sensor_in_odom = pixels.odom_from_camera.translation;

  Stopwatch watch;
  pixels.camera = geometry.left;
  const int first_row =
      first_ground_row(geometry.left, pixels.odom_from_camera.rotation.toRotationMatrix());
  pixels.camera.height -= first_row;
  pixels.camera.cy -= first_row;
  if (pixels.camera.height < 2 * kRowsPerStripe) {
    measurement.status = MappingStatus::kNoGround;
    return measurement;
  }
  if (options_.check_stereo_order && !order_checked_) {
    const StereoOrder order = stereo_order(rig_, frame, options_);
    if (order.looks_swapped()) {
      const auto percent = [](double share) { return std::to_string(std::lround(100.0 * share)); };
      throw Error(ErrorKind::kInput,
                  "left and right are swapped: " + percent(order.as_given) +
                      " % of the pixels match as given, " + percent(order.swapped) +
                      " % the other way round",
                  {}, "exchange the two image folders or topics");
    }
    order_checked_ = true;
  }
  pixels.left = rectifier_.left(frame.left, first_row);
  const cv::Mat left = grey_of(pixels.left);
  const cv::Mat right = grey_of(rectifier_.right(frame.right, first_row));
  statistics.ms.rectify = watch.lap();
  pixels.disparity = match(left, right);
  statistics.ms.depth = watch.lap();

  const double depth = median_depth(pixels.disparity, geometry);
  if (depth > kAbsurdDepth) {
    throw Error(ErrorKind::kInput,
                "the median stereo depth is " + to_text(std::round(depth)) + " m", {},
                "the calibration must be in metres; it looks like millimetres");
  }
  pixels.textured = textured(left, options_.texture_std);
  to_points(pixels, measurement, statistics);
  if (options_.colour_rule == ColourRule::kInverse) measurement.views.push_back(view(pixels));
  disparity_ = pixels.disparity;
  first_row_ = first_row;
  statistics.ms.points = watch.lap();
  return measurement;
}

std::optional<Sighting> StereoSource::sighting(const StereoFrame& frame) const {
  if (disparity_.empty()) return std::nullopt;
  const RectifiedGeometry& geometry = rectifier_.geometry();
  CameraModel camera = geometry.left;
  camera.height -= first_row_;
  camera.cy -= first_row_;
  Sighting sighting =
      sighting_of(rectifier_.left(frame.left, first_row_), camera, geometry.robot_from_left);
  const cv::Size size = sighting.grey.size();
  const double scale = static_cast<double>(size.width) / camera.width;
  cv::Mat depth(size, CV_32F, cv::Scalar(0.0));
  for (int row = 0; row < size.height; ++row) {
    const auto* disparities = disparity_.ptr<std::int16_t>(
        std::min(camera.height - 1, static_cast<int>((row + 0.5) / scale)));
    for (int column = 0; column < size.width; ++column) {
      const std::int16_t d =
          disparities[std::min(camera.width - 1, static_cast<int>((column + 0.5) / scale))];
      const double disparity = static_cast<double>(d) / kSubPixels + geometry.disparity_offset;
      if (d > 0 && disparity > kLeastSightedDisparity) {
        depth.at<float>(row, column) = static_cast<float>(geometry.focal_baseline / disparity);
      }
    }
  }
  find_landmarks(sighting, depth);
  return sighting;
}

void StereoSource::to_points(const Pixels& pixels, Measurement& measurement,
                             FrameStatistics& statistics) const {
  const DepthTable table(rectifier_.geometry(), options_, disparities_, min_range_, max_range_);
  const Eigen::Matrix3f turn = pixels.odom_from_camera.rotation.toRotationMatrix().cast<float>();
  const CameraModel& camera = pixels.camera;
  const auto attitude = static_cast<float>(radians(options_.attitude_sigma_deg));
  const auto own = static_cast<float>(options_.height_sigma_m * options_.height_sigma_m);
  const auto lowest = static_cast<float>(-options_.height_gate_below_m);
  const auto highest = static_cast<float>(options_.height_gate_above_m);
  const bool rgb = pixels.left.channels() == 3;
  const int stripes = (camera.height + kRowsPerStripe - 1) / kRowsPerStripe;
  measurement.points.resize(static_cast<std::size_t>(stripes));
  std::vector<DroppedPoints> dropped(measurement.points.size());

  tbb::parallel_for(0, stripes, [&](int stripe) {
    auto& points = measurement.points[static_cast<std::size_t>(stripe)];
    DroppedPoints& lost = dropped[static_cast<std::size_t>(stripe)];
    const int end = std::min(camera.height, (stripe + 1) * kRowsPerStripe);
    points.reserve(static_cast<std::size_t>(kRowsPerStripe) *
                   static_cast<std::size_t>(camera.width));
    for (int row = stripe * kRowsPerStripe; row < end; ++row) {
      const auto* disparities = pixels.disparity.ptr<std::int16_t>(row);
      const auto* textured_row = pixels.textured.ptr<std::uint8_t>(row);
      const auto* colours = pixels.left.ptr<std::uint8_t>(row);
      const Eigen::Vector3f row_ray =
          turn.col(1) * static_cast<float>((row - camera.cy) / camera.fy) + turn.col(2);
      for (int column = 0; column < camera.width; ++column) {
        const std::int16_t disparity = disparities[column];
        if (disparity <= 0) {
          ++lost.no_disparity;
          continue;
        }
        const DepthTable::Entry& entry = table.entries[static_cast<std::size_t>(disparity)];
        if (entry.depth <= 0.0F) {
          ++lost.range;
          continue;
        }
        const Eigen::Vector3f ray =
            row_ray + turn.col(0) * static_cast<float>((column - camera.cx) / camera.fx);
        const Eigen::Vector3f p = entry.depth * ray;
        if (p.z() < lowest || p.z() > highest) {
          ++lost.height;
          continue;
        }
        if (textured_row[column] == 0) {
          ++lost.texture;
          continue;
        }
        SurfacePoint point{.x = p.x(), .y = p.y(), .z = p.z()};
        // Equation 3; a roll or pitch error lifts a point by its distance.
        point.height_variance = ray.z() * ray.z() * entry.depth_variance + entry.lateral_variance +
                                (p.x() * p.x() + p.y() * p.y()) * attitude * attitude + own;
        point.colour_weight = entry.colour_weight;
        const std::uint8_t* colour = colours + (rgb ? 3 * column : column);
        point.colour = rgb ? std::array{colour[0], colour[1], colour[2]}
                           : std::array{colour[0], colour[0], colour[0]};
        if (*std::max_element(point.colour.begin(), point.colour.end()) > kSaturated) {
          point.colour_weight *= kSaturatedWeight;
        }
        points.push_back(point);
      }
    }
  });
  statistics.points_in = static_cast<std::int64_t>(camera.width) * camera.height;
  for (const DroppedPoints& lost : dropped) {
    statistics.dropped.no_disparity += lost.no_disparity;
    statistics.dropped.range += lost.range;
    statistics.dropped.height += lost.height;
    statistics.dropped.texture += lost.texture;
  }
}

ColourView StereoSource::view(const Pixels& pixels) const {
  const RectifiedGeometry& geometry = rectifier_.geometry();
  ColourView view;
  view.image = raster_of(pixels.left);
  view.model = pixels.camera;
  view.odom_from_camera = pixels.odom_from_camera;
  view.depth = Raster<float>(pixels.camera.width, pixels.camera.height,
                             std::numeric_limits<float>::infinity());
  view.depth_sigma_per_m2 =
      static_cast<float>(3.0 * options_.disparity_sigma_px / geometry.focal_baseline);
  for (int row = 0; row < pixels.camera.height; ++row) {
    const auto* disparities = pixels.disparity.ptr<std::int16_t>(row);
    for (int column = 0; column < pixels.camera.width; ++column) {
      const double disparity =
          static_cast<double>(disparities[column]) / kSubPixels + geometry.disparity_offset;
      if (disparities[column] > 0 && disparity > 0.0) {
        view.depth.at(column, row) = static_cast<float>(geometry.focal_baseline / disparity);
      }
    }
  }
  return view;
}

}  // namespace nadir::ground
