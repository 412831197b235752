// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/detail/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "nadir/aerial_mapping/detail/median.hpp"
#include "nadir/aerial_mapping/flight.hpp"
#ifdef NADIR_HAS_SFM
#include <Eigen/Dense>

#include "nadir/aerial_mapping/sfm/triangulation.hpp"
#endif

namespace nadir::aerial {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

PhotoReport& report_of(const std::string& name, AdjustmentReport& report) {
  const auto found = std::lower_bound(
      report.photos.begin(), report.photos.end(), name,
      [](const PhotoReport& photo, const std::string& wanted) { return photo.name < wanted; });
  if (found != report.photos.end() && found->name == name) return *found;
  PhotoReport fresh;
  fresh.name = name;
  return *report.photos.insert(found, fresh);
}

}  // namespace

void fill_views(const PhotoSet& set, const Block& block, const Ground& ground, AerialMap& map) {
  std::vector<double> heights;
  std::vector<double> pixels;
  for (const View& view : block.views) {
    const std::string& name = set.photos[view.photo].name;
    map.poses.push_back(pose_of(view, name));
    PhotoReport& photo = report_of(name, map.report);
    photo.registered = !view.provisional;
    photo.gain = 0.299 * view.gain[0] + 0.587 * view.gain[1] + 0.114 * view.gain[2];
    photo.ground_below_camera_m =
        view.centre.z() - ground.height_at(view.centre.x(), view.centre.y());
    photo.off_nadir_deg = std::acos(std::clamp(-view.camera_from_map(2, 2), -1.0, 1.0)) / kDegree;
    heights.push_back(photo.ground_below_camera_m);
    pixels.push_back(photo.ground_below_camera_m / view.camera.fx);
  }
  AdjustmentReport& report = map.report;
  report.registered =
      static_cast<int>(std::count_if(report.photos.begin(), report.photos.end(),
                                     [](const PhotoReport& photo) { return photo.registered; }));
  report.ground_below_camera_m = median_of(heights);
  report.photo_pixel_m = median_of(pixels);
}

#ifdef NADIR_HAS_SFM

namespace {

constexpr int kManyViews = 3;
constexpr double kDoubtfulAltitude = 0.1;
constexpr double kDoubtfulTrend = 0.05;  // of the flying height, over the block
constexpr std::size_t kFewestForTrend = 8;
constexpr double kFarPosition = 10.0;  // metres; no receiver in the open is that far off
constexpr double kFarSigmas = 5.0;
constexpr double kRoughScale = 0.05;  // relative: 1 m over the 20 m of a local map

std::string number(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

/// A warning for which the map must not be relied on unseen.
void doubt(AdjustmentReport& report, const std::string& reason) {
  report.warnings.push_back(reason);
  report.doubts.push_back(reason);
}

void report_observations(const PhotoSet& set, const Reconstruction& found,
                         AdjustmentReport& report) {
  std::vector<double> sum(set.photos.size(), 0.0);
  std::vector<int> count(set.photos.size(), 0);
  for (const Landmark& landmark : found.model.landmarks) {
    if (!landmark.valid) continue;
    for (std::size_t k = 0; k < landmark.track.size(); ++k) {
      if (landmark.used[k] == 0) continue;
      const double error = found.model.error_px(landmark.track[k], landmark.position);
      sum[landmark.track[k].photo] += error * error;
      ++count[landmark.track[k].photo];
    }
  }
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    PhotoReport& photo = report_of(set.photos[i].name, report);
    photo.observations = count[i];
    photo.reprojection_px = count[i] > 0 ? std::sqrt(sum[i] / count[i]) : 0.0;
  }
  const ReprojectionError total = reprojection_error(found.model);
  report.points = total.points;
  report.observations = total.observations;
  report.reprojection_px = total.rms;
}

/// Positions far from where the photos put them are not those of these photos, or not in this
/// reference system.
void report_far_positions(const PhotoSet& set, double usual_sigma_m, AdjustmentReport& report) {
  std::vector<double> sigmas;
  for (const MappingPhoto& photo : set.photos)
    if (photo.prior.position)
      sigmas.push_back(photo.prior.horizontal_sigma_m.value_or(usual_sigma_m));
  if (!report.position_residual_m || sigmas.empty()) return;
  if (*report.position_residual_m <= std::max(kFarPosition, kFarSigmas * median_of(sigmas))) return;
  doubt(report, "the photos' positions differ by " + number(*report.position_residual_m, 1) +
                    " m (root mean square, horizontal) from where the photos put them: check that "
                    "they are those of these photos, and their reference system");
}

void report_positions(const PhotoSet& set, const Reconstruction& found, AdjustmentReport& report) {
  if (found.scale_source != ScaleSource::kPositions &&
      found.scale_source != ScaleSource::kControlPoints &&
      found.scale_source != ScaleSource::kGivenPoses)
    return;
  const auto velocities = velocities_of(set.photos);
  std::array<double, 3> squares{};
  int count = 0;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    const Pose& pose = found.model.poses[i];
    if (!pose.known || !set.photos[i].prior.position) continue;
    const Eigen::Vector3d residual = pose.centre - found.state.time_offset_s * velocities[i] -
                                     set.photos[i].prior.position->vector() -
                                     found.state.position_bias;
    PhotoReport& photo = report_of(set.photos[i].name, report);
    photo.position_residual_m = {residual.x(), residual.y(), residual.z()};
    for (int k = 0; k < 3; ++k) squares[static_cast<std::size_t>(k)] += residual[k] * residual[k];
    ++count;
  }
  if (count == 0) return;
  report.position_rms_m = {std::sqrt(squares[0] / count), std::sqrt(squares[1] / count),
                           std::sqrt(squares[2] / count)};
  report.position_residual_m = std::sqrt((squares[0] + squares[1]) / count);
  if (found.state.time_offset_s != 0.0) report.time_offset_s = found.state.time_offset_s;
}

/// Heights that rise against the positions' from one end of the block to the other, or from its
/// middle to its edge, and more than they scatter: tilted, or bent as a wrong lens bends it.
void report_trend(const PhotoSet& set, const Reconstruction& found, AdjustmentReport& report) {
  std::vector<Eigen::Vector3d> places;
  std::vector<double> residuals;
  for (const PhotoReport& photo : report.photos) {
    if (!photo.position_residual_m) continue;
    const auto at = std::find_if(set.photos.begin(), set.photos.end(),
                                 [&](const MappingPhoto& p) { return p.name == photo.name; });
    places.push_back(found.model.poses[static_cast<std::size_t>(at - set.photos.begin())].centre);
    residuals.push_back((*photo.position_residual_m)[2]);
  }
  if (places.size() < kFewestForTrend) return;
  const auto n = static_cast<Eigen::Index>(places.size());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : places) middle += p / static_cast<double>(n);
  Eigen::MatrixXd rows(n, 4);
  Eigen::VectorXd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d p = places[static_cast<std::size_t>(i)] - middle;
    rows.row(i) << 1.0, p.x(), p.y(), p.head<2>().squaredNorm();
    values[i] = residuals[static_cast<std::size_t>(i)];
  }
  const Eigen::VectorXd trend = rows * rows.colPivHouseholderQr().solve(values);
  const double range = trend.maxCoeff() - trend.minCoeff();
  const double scatter = std::sqrt((values - trend).squaredNorm() / static_cast<double>(n));
  const double height = middle.z() - found.state.ground;
  if (range > kDoubtfulTrend * height && range > 4.0 * scatter)
    doubt(report, "surface doubtful: the heights rise by " + number(range, 1) +
                      " m against the positions over the block: tilted or bent");
}

void report_control(const PhotoSet& set, const Reconstruction& found, AdjustmentReport& report) {
  for (std::size_t i = 0; i < set.control_points.size(); ++i) {
    const GroundControlPoint& point = set.control_points[i];
    ControlPointReport control;
    control.name = point.name;
    const bool known = i < found.state.control_known.size() && found.state.control_known[i] != 0;
    if (!known) {
      report.warnings.push_back("control point " + point.name +
                                " has no part: it needs two marks in mapped photos, and there "
                                "must be three points that are not on a line");
      report.control_points.push_back(control);
      continue;
    }
    const Eigen::Vector3d residual = found.state.control[i] - point.position.vector();
    control.residual_m = {residual.x(), residual.y(), residual.z()};
    double sum = 0.0;
    for (const GroundControlPoint::Mark& mark : point.marks) {
      const auto photo = std::find_if(set.photos.begin(), set.photos.end(),
                                      [&](const auto& p) { return p.name == mark.photo; });
      if (photo == set.photos.end()) continue;
      const auto n = static_cast<std::size_t>(photo - set.photos.begin());
      if (!found.model.poses[n].known) continue;
      const double error = found.model.error_px({n, mark.u, mark.v}, found.state.control[i]);
      sum += error * error;
      ++control.marks;
    }
    if (control.marks > 0) control.reprojection_px = std::sqrt(sum / control.marks);
    const double allowed_xy = std::max(0.1, 5.0 * point.horizontal_sigma_m);
    const double allowed_z = std::max(0.2, 5.0 * point.vertical_sigma_m);
    control.outlier =
        std::hypot(residual.x(), residual.y()) > allowed_xy || std::abs(residual.z()) > allowed_z;
    if (control.outlier)
      doubt(report, "control point " + point.name + " is off by " + number(residual.x(), 2) + ", " +
                        number(residual.y(), 2) + ", " + number(residual.z(), 2) +
                        " m: check its coordinates and its marks");
    report.control_points.push_back(control);
  }
  if (!set.control_points.empty() && found.scale_source != ScaleSource::kControlPoints)
    doubt(report,
          "the control points have no part in the map: check the names of the photos in "
          "their list, and that three of them have two marks each");
}

void report_groups(const PhotoSet& set, const Reconstruction& found, AdjustmentReport& report) {
  for (const auto& component : found.components) {
    std::vector<std::string> names;
    for (const std::size_t i : component) names.push_back(set.photos[i].name);
    report.components.push_back(std::move(names));
  }
  if (report.components.size() < 2) return;
  std::vector<std::string> left_out;
  for (std::size_t k = 1; k < report.components.size(); ++k)
    left_out.insert(left_out.end(), report.components[k].begin(), report.components[k].end());
  std::sort(left_out.begin(), left_out.end());
  report.warnings.push_back(std::to_string(left_out.size()) + " of " +
                            std::to_string(set.photos.size()) +
                            " photos do not join the map: " + listed(left_out));
}

void report_scale(const PhotoSet& set, const Reconstruction& found, AdjustmentReport& report) {
  report.scale_source = found.scale_source;
  report.scale_sigma = found.scale_sigma;
  report.heading_sigma_deg = found.heading_sigma_rad / kDegree;
  if (found.scale_source == ScaleSource::kNone)
    doubt(report,
          "the scale is arbitrary: nothing says how large the ground is; give positions, control "
          "points or the size of a photo's pixel on the ground");
  if (found.scale_source == ScaleSource::kRelativeAltitude) {
    const std::string rough =
        "the scale comes from the height above take-off alone: uncertain by " +
        number(100.0 * found.scale_sigma, 0) + " %";
    found.scale_sigma > kRoughScale ? doubt(report, rough) : report.warnings.push_back(rough);
  }
  // [6] against the ground that was found.
  std::vector<double> ratios;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    const auto& altitude = set.photos[i].prior.relative_altitude_m;
    if (found.model.poses[i].known && altitude && *altitude > 1.0)
      ratios.push_back((found.model.poses[i].centre.z() - found.state.ground) / *altitude);
  }
  if (ratios.empty() || found.scale_source == ScaleSource::kNone) return;
  const double off = median_of(ratios) - 1.0;
  if (std::abs(off) <= kDoubtfulAltitude) return;
  const std::string altitude = "surface doubtful: the ground lies " +
                               number(100.0 * std::abs(off), 0) + " % " +
                               (off > 0.0 ? "farther" : "nearer") +
                               " below the photos than their height above take-off says: the "
                               "scale is uncertain by as much";
  // Where positions or control points hold the scale, a take-off from a hill explains it.
  const bool scale_is_held = found.scale_source == ScaleSource::kPositions ||
                             found.scale_source == ScaleSource::kControlPoints;
  scale_is_held ? report.warnings.push_back(altitude) : doubt(report, altitude);
}

/// Directions that the photos leave open and a prior holds.
void report_weakness(const Reconstruction& found, AdjustmentReport& report) {
  if (found.strip_turn_sigma_deg)
    report.warnings.push_back(
        "one straight strip: the turn about it is held by " +
        std::string(found.strip_held_by_gimbals
                        ? "the gimbal angles"
                        : "the assumption that the photos look straight down") +
        " alone, to " + number(*found.strip_turn_sigma_deg, 1) + " degrees");
  if (!found.focal_held || found.focal_sigma.empty()) return;
  report.warnings.push_back(
      "the photos look straight down and there are no control points, which leaves a free focal "
      "length open: held by its prior, to " +
      number(100.0 * found.focal_sigma.front(), 1) + " %");
}

/// Points that three photos or more see; in squares of side `near` that hold none, those of two.
std::vector<Eigen::Vector3d> surface_points(const std::vector<Landmark>& landmarks, double near) {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> of_two;
  std::set<std::pair<long, long>> covered;
  for (const Landmark& landmark : landmarks) {
    if (!landmark.valid) continue;
    const Eigen::Vector3d& p = landmark.position;
    if (landmark.used_count() < kManyViews) {
      of_two.push_back(p);
      continue;
    }
    points.push_back(p);
    covered.emplace(std::lround(p.x() / near), std::lround(p.y() / near));
  }
  for (const Eigen::Vector3d& p : of_two)
    if (!covered.contains({std::lround(p.x() / near), std::lround(p.y() / near)}))
      points.push_back(p);
  return points;
}

}  // namespace

Block block_of(const Reconstruction& found) {
  Block block;
  block.ground = found.state.ground;
  for (std::size_t i = 0; i < found.model.poses.size(); ++i) {
    const Pose& pose = found.model.poses[i];
    if (!pose.known) continue;
    View view;
    view.photo = i;
    view.camera = found.model.camera(i);
    view.camera_from_map = pose.camera_from_map;
    view.centre = pose.centre;
    view.flown = pose.flown;
    block.views.push_back(view);
  }
  const auto& landmarks = found.surface.empty() ? found.model.landmarks : found.surface;
  block.points = without_outliers(surface_points(landmarks, 5.0 * block.outlier_tolerance()),
                                  block.outlier_tolerance());
  return block;
}

void fill_report(const PhotoSet& set, const Reconstruction& found,
                 const std::vector<VerifiedPair>& pairs, const AerialMappingOptions& options,
                 AdjustmentReport& report) {
  report_observations(set, found, report);
  report_positions(set, found, report);
  report_far_positions(set, options.gps_sigma_m, report);
  report_trend(set, found, report);
  report_control(set, found, report);
  report_groups(set, found, report);
  report_scale(set, found, report);
  report_weakness(found, report);
  for (const VerifiedPair& pair : pairs)
    if (pair.support() >= options.min_pair_inliers)
      report.pairs.push_back({set.photos[pair.first].name, set.photos[pair.second].name,
                              pair.matches, pair.epipolar_inliers, pair.homography_inliers});
  for (std::size_t i = 0; i < set.cameras.size(); ++i) {
    CameraReport camera;
    camera.name = set.cameras[i].name;
    camera.model = found.model.cameras[i];
    camera.prior_focal_px = set.cameras[i].focal.focal_px;
    camera.focal_source = set.cameras[i].focal.source;
    camera.readout_s = found.model.readout_s[i];
    if (i < found.focal_sigma.size()) camera.focal_sigma = found.focal_sigma[i];
    report.cameras.push_back(camera);
  }
}

#endif

}  // namespace nadir::aerial
