// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/reconstruction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "nadir/aerial_mapping/sfm/control.hpp"
#include "nadir/aerial_mapping/sfm/guided.hpp"
#include "nadir/aerial_mapping/sfm/pairs.hpp"
#include "nadir/aerial_mapping/sfm/pose_start.hpp"
#include "nadir/aerial_mapping/sfm/resection.hpp"
#include "nadir/aerial_mapping/sfm/triangulation.hpp"
#include "nadir/core/error.hpp"

namespace nadir::aerial {
namespace {

constexpr double kFlatness = 0.04;       // relief of the first round, in flying heights
constexpr int kFewestObservations = 15;  // that hold a photo
constexpr std::size_t kFewestForGuidance = 50;
constexpr double kGuidanceMargin = 0.05;  // of the flying height
constexpr std::size_t kNeighbours = 8;    // that a new photo moves
constexpr double kNarrow = 0.15;          // width of a strip in lengths
constexpr double kNadirSigmaDeg = 10.0;
constexpr std::size_t kFewestControl = 3;
constexpr int kFewestGimbals = 10;
constexpr double kSteadyGimbalRad = 0.2 * std::numbers::pi / 180.0;  // no gimbal is better
constexpr double kTiltHoldsFocalRad = 0.17;  // usual tilt from which a block holds its focal length

double median_height(const Model& model, double ground) {
  std::vector<double> heights;
  for (const Pose& pose : model.poses)
    if (pose.known) heights.push_back(pose.centre.z() - ground);
  if (heights.empty()) return 1.0;
  std::nth_element(heights.begin(),
                   heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2),
                   heights.end());
  return std::max(1e-6, heights[heights.size() / 2]);
}

std::vector<int> observations_of(const Model& model) {
  std::vector<int> count(model.poses.size(), 0);
  for (const Landmark& landmark : model.landmarks)
    if (landmark.valid)
      for (std::size_t k = 0; k < landmark.track.size(); ++k)
        if (landmark.used[k] != 0) ++count[landmark.track[k].photo];
  return count;
}

void update_ground(const Model& model, AdjustmentState& state) {
  double sum = 0.0;
  int count = 0;
  for (const Landmark& landmark : model.landmarks)
    if (landmark.valid) {
      sum += landmark.position.z();
      ++count;
    }
  if (count > 0) state.ground = sum / count;
}

std::vector<Landmark> landmarks_of(const std::vector<PhotoFeatures>& features,
                                   const std::vector<VerifiedPair>& pairs) {
  std::vector<Landmark> landmarks;
  for (Track& track : build_tracks(features, pairs)) {
    Landmark landmark;
    landmark.used.assign(track.size(), 0);
    landmark.track = std::move(track);
    landmarks.push_back(std::move(landmark));
  }
  return landmarks;
}

/// One reconstruction in the making.
class Reconstructor {
 public:
  Reconstructor(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                const std::vector<VerifiedPair>& pairs, const AerialMappingOptions& options,
                const StopToken& stop)
      : set_(set), features_(features), pairs_(pairs), options_(options), stop_(stop) {
    const double gimbal = options.gimbal_sigma_deg * std::numbers::pi / 180.0;
    plan_.gimbal_sigma = {gimbal, gimbal};
    result_.model = start_model(set, features, pairs, options.min_pair_inliers);
    PhotoPairs links;
    for (const VerifiedPair& pair : pairs)
      if (pair.support() >= options.min_pair_inliers) links.emplace_back(pair.first, pair.second);
    result_.components = components_of(set.photos.size(), links);
  }

  Reconstruction from_matches() {
    const std::vector<std::size_t> group = result_.components.front();
    if (group.size() < 2)
      throw Error(ErrorKind::kNoResult, "no two photos join each other", {},
                  "photos must overlap by more than half and show texture");
    std::vector<VerifiedPair> links;
    for (const VerifiedPair& pair : pairs_)
      if (pair.support() >= options_.min_pair_inliers) links.push_back(pair);
    lay_out(model(), group, set_.photos, features_, links, stop_);
    placement_ = place(model(), group, set_.photos);
    state().ground = placement_.ground;
    choose_gauge(group);
    settle_on_plane();
    reseat(group);
    round(8.0, 12);
    find_lost(group);
    reseat(group);
    round(4.0, 20);
    find_lost(group);
    reseat(group);
    if (take_control_points(model(), state(), set_)) placement_.scale = true;
    round(2.0, 30);
    weigh_gimbals();
    round(1.5, 30);
    drop_lost();
    finish();
    return std::move(result_);
  }

  Reconstruction from_known(const KnownPoses& known) {
    std::copy_n(known.cameras.begin(), std::min(known.cameras.size(), model().cameras.size()),
                model().cameras.begin());
    std::copy_n(known.readout_s.begin(), std::min(known.readout_s.size(), model().readout_s.size()),
                model().readout_s.begin());
    const auto velocities = velocities_of(set_.photos);
    std::vector<std::size_t> fresh;
    for (std::size_t i = 0; i < set_.photos.size(); ++i) {
      const auto found = known.poses.find(set_.photos[i].name);
      if (found != known.poses.end())
        model().poses[i] = found->second;
      else
        fresh.push_back(i);
    }
    triangulate(model(), {4.0, 1.0, 2});
    update_ground(model(), state());
    std::erase_if(fresh, [&](std::size_t i) {
      return !resect(model(), i, kFewestObservations, 8.0, seed_of(set_.photos[i].name));
    });
    for (const std::size_t i : fresh)
      model().poses[i].flown = model().readout_s[model().camera_of[i]] * velocities[i];
    plan_.hold_cameras = true;
    plan_.held.assign(set_.photos.size(), 1);
    for (const std::size_t i : fresh) {
      plan_.held[i] = 0;
      for (const std::size_t j : neighbours_of(i)) plan_.held[j] = 0;
    }
    if (!fresh.empty()) {
      local_round(4.0);
      local_round(2.0);
    }
    triangulate(model(), {1.5, 1.0, 2});
    update_ground(model(), state());
    result_.scale_source = ScaleSource::kPositions;
    return std::move(result_);
  }

  Reconstruction from_given_poses() {
    for (std::size_t i = 0; i < set_.photos.size(); ++i) {
      const PhotoPose& given = *set_.photos[i].pose;
      model().cameras[set_.photos[i].camera] = given.camera;
      Pose& pose = model().poses[i];
      pose.camera_from_map =
          given.map_from_camera.rotation.normalized().toRotationMatrix().transpose();
      pose.centre = given.map_from_camera.translation;
      pose.flown = given.flown_in_readout;
      pose.known = true;
    }
    result_.components = {std::vector<std::size_t>(set_.photos.size())};
    std::iota(result_.components[0].begin(), result_.components[0].end(), std::size_t{0});
    triangulate(model(), {4.0, 1.0, 2});
    update_ground(model(), state());
    if (options_.refine_given_poses) {
      placement_.scale = placement_.position = true;
      plan_.gauge_sigma_m = 0.1 * median_height(model(), state().ground);
      take_control_points(model(), state(), set_);
      round(4.0, 30);
      round(2.0, 30);
    }
    triangulate(model(), {options_.refine_given_poses ? 1.5 : 3.0, 1.0, 2});
    densify();
    result_.scale_source = ScaleSource::kGivenPoses;
    return std::move(result_);
  }

 private:
  Model& model() { return result_.model; }
  AdjustmentState& state() { return result_.state; }

  void choose_gauge(const std::vector<std::size_t>& group) {
    const auto widths = widths_of_positions(group, set_.photos);
    const bool positions = placement_.position && placement_.scale;
    plan_.use_positions = placement_.position;
    plan_.use_heading = !positions;
    bool attitudes = options_.gimbal_sigma_deg > 0.0;
    for (const std::size_t i : group) attitudes = attitudes && set_.photos[i].prior.attitude;
    if (!positions) plan_.gauge_sigma_m = median_height(model(), state().ground);
    levelled_ = attitudes;
    const bool strip = !widths || widths->second < kNarrow * widths->first;
    is_wide_ = positions && !strip;
    if (!attitudes && (!positions || strip)) plan_.nadir_sigma_deg = kNadirSigmaDeg;
    if (positions && strip) {
      result_.strip_turn_sigma_deg = attitudes ? options_.gimbal_sigma_deg : kNadirSigmaDeg;
      result_.strip_held_by_gimbals = attitudes;
    }
    hold_focal_of_flat_block();
  }

  /// Gimbals weigh as much as they agree with the block: good ones then keep it from bending, which
  /// a row of photos that look straight down resists little, and with it the scale of the ground.
  void weigh_gimbals() {
    if (!is_wide_ || plan_.gimbal_sigma.sideward_rad <= 0.0) return;
    const auto left = gimbal_residuals(model(), set_, kFewestGimbals);
    if (!left) return;
    const auto weighed = [](double residual, double said) {
      return std::min(said, std::max(kSteadyGimbalRad, residual));
    };
    plan_.gimbal_sigma = {weighed(left->sideward_rad, plan_.gimbal_sigma.sideward_rad),
                          weighed(left->forward_rad, plan_.gimbal_sigma.forward_rad)};
  }

  /// A block that looks straight down does not determine its focal length: its prior does.
  void hold_focal_of_flat_block() {
    if (!options_.free_focal || set_.control_points.size() >= kFewestControl) return;
    std::vector<double> tilts;
    for (const MappingPhoto& photo : set_.photos)
      if (photo.prior.attitude)
        tilts.push_back(0.5 * std::numbers::pi + photo.prior.attitude->pitch);
    if (!tilts.empty()) {
      const auto middle = tilts.begin() + static_cast<std::ptrdiff_t>(tilts.size() / 2);
      std::nth_element(tilts.begin(), middle, tilts.end());
      if (*middle > kTiltHoldsFocalRad) return;
    }
    options_.free_focal = false;
    result_.focal_held = true;
  }

  /// The start knows poses to some per cent of the flying height: the ground is a plane to it, at
  /// first strictly, then with relief.
  void settle_on_plane() {
    const double height = median_height(model(), state().ground);
    for (const double spread : {0.6, 0.3}) {
      place_on_plane(model(), state().ground, spread * height);
      AdjustmentPlan plan = plan_;
      plan.flat_sigma_m = kFlatness * height;
      plan.heavy_tail = true;
      plan.loss_px = spread * 20.0;
      plan.hold_cameras = true;
      plan.cell_share = 1;
      plan.max_iterations = 25;
      adjust(model(), state(), set_, options_, plan, stop_);
    }
  }

  /// Brings the block back onto its positions in closed form. Scale and place of a block weigh
  /// little beside ten thousand observations: an adjustment stops long before it has carried a
  /// block that its start shrank by some per cent back to its size.
  void reseat(const std::vector<std::size_t>& group) {
    if (!placement_.position || !placement_.scale || plan_.gauge_sigma_m > 0.0) return;
    std::vector<std::size_t> known;
    for (const std::size_t i : group)
      if (model().poses[i].known) known.push_back(i);
    place(model(), known, set_.photos);
    update_ground(model(), state());
  }

  void round(double gate_px, int iterations) {
    stop_.check();
    triangulate(model(), {gate_px, 1.0, 2});
    update_ground(model(), state());
    AdjustmentPlan plan = plan_;
    plan.loss_px = std::max(1.0, 0.5 * gate_px);
    plan.max_iterations = iterations;
    plan.hold_cameras = gate_px > 4.0;
    plan.free_readout = !plan.hold_cameras && is_wide_;
    plan.cell_share = gate_px > 2.0 ? 1 : 2;
    adjust(model(), state(), set_, options_, plan, stop_);
  }

  void local_round(double gate_px) {
    stop_.check();
    triangulate(model(), {gate_px, 1.0, 2});
    AdjustmentPlan plan = plan_;
    plan.loss_px = std::max(1.0, 0.5 * gate_px);
    plan.max_iterations = 10;
    plan.cell_share = 1;
    adjust(model(), state(), set_, options_, plan, stop_);
  }

  /// The photos nearest to a known one.
  std::vector<std::size_t> neighbours_of(std::size_t photo) {
    std::vector<std::pair<double, std::size_t>> others;
    for (std::size_t j = 0; j < set_.photos.size(); ++j)
      if (j != photo && model().poses[j].known)
        others.emplace_back((model().poses[j].centre - model().poses[photo].centre).norm(), j);
    std::sort(others.begin(), others.end());
    others.resize(std::min(others.size(), kNeighbours));
    std::vector<std::size_t> nearest;
    for (const auto& [distance, j] : others) nearest.push_back(j);
    return nearest;
  }

  /// Photos that their start left far from the others are found again from the others' points.
  void find_lost(const std::vector<std::size_t>& group) {
    triangulate(model(), {6.0, 1.0, 2});
    for (int pass = 0; pass < 5; ++pass) {
      stop_.check();
      const std::vector<int> count = observations_of(model());
      std::vector<std::size_t> lost;
      for (const std::size_t i : group)
        if (!model().poses[i].known || count[i] < kFewestObservations) lost.push_back(i);
      if (lost.empty() || lost.size() + 2 > group.size()) return;
      for (const std::size_t i : lost) model().poses[i].known = false;
      triangulate(model(), {6.0, 1.0, 2});
      bool found = false;
      for (const std::size_t i : lost)
        found = resect(model(), i, kFewestObservations, 8.0, seed_of(set_.photos[i].name)) || found;
      if (!found) return;
      triangulate(model(), {6.0, 1.0, 2});
    }
  }

  /// Matches once more where the poses say that partners must lie. What is found so is no evidence
  /// for the poses, and has no part in the adjustment.
  void densify() {
    std::vector<double> heights;
    for (const Landmark& landmark : model().landmarks)
      if (landmark.valid) heights.push_back(landmark.position.z());
    if (heights.size() < kFewestForGuidance) return;
    std::sort(heights.begin(), heights.end());
    const double margin = kGuidanceMargin * median_height(model(), state().ground);
    const double lowest = heights[heights.size() / 100] - margin;
    const double highest = heights[heights.size() - 1 - heights.size() / 100] + margin;
    std::vector<VerifiedPair> pairs;
    for (const VerifiedPair& pair : pairs_)
      if (pair.support() >= options_.min_pair_inliers) pairs.push_back(pair);
    rematch(model(), features_, lowest, highest, pairs, stop_);
    stop_.check();
    Model dense = model();
    dense.landmarks = landmarks_of(features_, pairs);
    triangulate(dense, {1.5, 2.0, 2});
    result_.surface = std::move(dense.landmarks);
  }

  void drop_lost() {
    triangulate(model(), {1.5, 1.0, 2});
    const std::vector<int> count = observations_of(model());
    std::vector<std::size_t> kept;
    std::vector<std::vector<std::size_t>> others;
    for (const std::size_t i : result_.components.front()) {
      if (model().poses[i].known && count[i] >= kFewestObservations) {
        kept.push_back(i);
        continue;
      }
      model().poses[i].known = false;
      others.push_back({i});
    }
    if (kept.size() < 2)
      throw Error(ErrorKind::kNoResult, "the photos do not agree with one ground", {},
                  "check focal length and positions");
    if (!others.empty()) {
      result_.components.front() = kept;
      result_.components.insert(result_.components.end(), others.begin(), others.end());
      triangulate(model(), {1.5, 1.0, 2});
    }
  }

  void finish() {
    AdjustmentPlan thinned = plan_;
    thinned.free_readout = is_wide_;
    thinned.cell_share = 1;
    stop_.check();
    result_.focal_sigma = focal_sigmas(model(), state(), set_, options_, thinned);
    if (!levelled_ && !(placement_.position && placement_.scale)) level(model());
    update_ground(model(), state());
    set_scale();
    say_uncertainty();
    densify();
  }

  void set_scale() {
    const bool control =
        std::count(state().control_known.begin(), state().control_known.end(), 1) >= 3;
    if (control) {
      result_.scale_source = ScaleSource::kControlPoints;
    } else if (placement_.position && placement_.scale && placement_.heading &&
               plan_.gauge_sigma_m == 0.0) {
      result_.scale_source = ScaleSource::kPositions;
    } else if (set_.metres_per_photo_pixel) {
      rescale(*set_.metres_per_photo_pixel);
      result_.scale_source = ScaleSource::kPhotoPixelSize;
    } else if (placement_.scale) {
      result_.scale_source = ScaleSource::kRelativeAltitude;
    } else {
      rescale(options_.resolution_m);
      result_.scale_source = ScaleSource::kNone;
    }
  }

  /// So that a pixel of the middle photo is as large on the ground.
  void rescale(double pixel_m) {
    std::vector<double> pixels;
    for (std::size_t i = 0; i < model().poses.size(); ++i)
      if (model().poses[i].known)
        pixels.push_back((model().poses[i].centre.z() - state().ground) / model().camera(i).fx);
    std::nth_element(pixels.begin(),
                     pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() / 2), pixels.end());
    const double scale = pixel_m / std::max(1e-12, pixels[pixels.size() / 2]);
    transform(model(), scale, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
    state().ground *= scale;
  }

  /// Scale and heading of a similarity fit to n points of sigma s: s / sqrt(sum d^2), d their
  /// distances from their mean.
  void say_uncertainty() {
    double information = 0.0;
    const auto add = [&](const std::vector<Eigen::Vector2d>& points,
                         const std::vector<double>& sigmas) {
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& p : points) mean += p / static_cast<double>(points.size());
      for (std::size_t k = 0; k < points.size(); ++k)
        information += (points[k] - mean).squaredNorm() / (sigmas[k] * sigmas[k]);
    };
    std::vector<Eigen::Vector2d> points;
    std::vector<double> sigmas;
    if (result_.scale_source == ScaleSource::kControlPoints) {
      for (std::size_t i = 0; i < set_.control_points.size(); ++i)
        if (state().control_known[i] != 0) {
          points.emplace_back(state().control[i].x(), state().control[i].y());
          sigmas.push_back(std::max(1e-3, set_.control_points[i].horizontal_sigma_m));
        }
    } else if (result_.scale_source == ScaleSource::kPositions) {
      for (const std::size_t i : result_.components.front())
        if (set_.photos[i].prior.position) {
          points.emplace_back(model().poses[i].centre.x(), model().poses[i].centre.y());
          sigmas.push_back(set_.photos[i].prior.horizontal_sigma_m.value_or(options_.gps_sigma_m));
        }
    } else if (result_.scale_source == ScaleSource::kRelativeAltitude) {
      result_.scale_sigma =
          options_.relative_altitude_sigma_m / median_height(model(), state().ground);
      return;
    }
    if (points.size() < 2) return;
    add(points, sigmas);
    result_.scale_sigma = result_.heading_sigma_rad = 1.0 / std::sqrt(std::max(1e-12, information));
  }

  const PhotoSet& set_;
  const std::vector<PhotoFeatures>& features_;
  const std::vector<VerifiedPair>& pairs_;
  AerialMappingOptions options_;
  const StopToken& stop_;
  Reconstruction result_;
  Placement placement_;
  AdjustmentPlan plan_;
  bool levelled_ = false;
  bool is_wide_ = false;  // positions spread in both directions
};

}  // namespace

Model start_model(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                  const std::vector<VerifiedPair>& pairs, int min_inliers) {
  Model model;
  for (const CameraPrior& prior : set.cameras) {
    CameraModel camera;
    camera.width = prior.width;
    camera.height = prior.height;
    const double assumed = 0.85 * std::max(prior.width, prior.height);
    camera.fx = camera.fy = prior.focal.focal_px > 0.0 ? prior.focal.focal_px : assumed;
    camera.cx = (prior.width - 1) / 2.0;
    camera.cy = (prior.height - 1) / 2.0;
    model.cameras.push_back(camera);
  }
  model.readout_s.assign(set.cameras.size(), 0.0);
  for (const MappingPhoto& photo : set.photos) model.camera_of.push_back(photo.camera);
  model.poses.resize(set.photos.size());
  std::vector<VerifiedPair> links;
  for (const VerifiedPair& pair : pairs)
    if (pair.support() >= min_inliers) links.push_back(pair);
  model.landmarks = landmarks_of(features, links);
  return model;
}

Reconstruction reconstruct(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                           const std::vector<VerifiedPair>& pairs,
                           const AerialMappingOptions& options, const StopToken& stop) {
  return Reconstructor(set, features, pairs, options, stop).from_matches();
}

Reconstruction reconstruct_posed(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                                 const std::vector<VerifiedPair>& pairs,
                                 const AerialMappingOptions& options, const StopToken& stop) {
  return Reconstructor(set, features, pairs, options, stop).from_given_poses();
}

Reconstruction reconstruct_next(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                                const std::vector<VerifiedPair>& pairs,
                                const AerialMappingOptions& options, const KnownPoses& known,
                                const StopToken& stop) {
  return Reconstructor(set, features, pairs, options, stop).from_known(known);
}

}  // namespace nadir::aerial
