// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "nadir/aerial_mapping/sfm/adjustment_terms.hpp"

namespace nadir::aerial {
namespace {

// The errors of neighbouring observations are common ones (lens, rolling shutter, relief of the
// feature itself): a photo's observations weigh as much as this many independent ones of 1 px.
// Without that bound a slightly wrong lens model outvotes every prior (the report of section 2).
constexpr double kIndependent = 200.0;
constexpr double kHeadingSigma = 10.0 * std::numbers::pi / 180.0;  // compass
constexpr double kTimeOffsetSigma = 0.5;                           // s
constexpr double kReadoutSigma = 0.03;                             // s: of common sensors
constexpr double kBiasSigma = 100.0;                               // m: another vertical datum
constexpr double kUnheldFocalSigma = 10.0;                         // of ln f: no prior
constexpr double kPositionTail = 3.0;                              // sigma
constexpr int kColumns = 16;
constexpr int kRows = 12;
constexpr std::size_t kDenseLimit = 60;  // photos
constexpr int kFewestForOffset = 6;

struct Blocks {
  std::vector<std::array<double, 6>> poses;
  std::vector<std::array<double, 3>> lenses;
  std::vector<double> readouts;  // of the cameras, s
  std::vector<std::array<double, 3>> points;
  std::vector<std::size_t> landmarks;  // of `points`
  std::vector<std::array<double, 3>> control;
  double offset = 0.0;
  std::array<double, 3> bias{};
  double ground = 0.0;
};

int cell_of(const CameraModel& camera, const Observation& seen) {
  const int column =
      std::clamp(static_cast<int>(seen.u / camera.width * kColumns), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>(seen.v / camera.height * kRows), 0, kRows - 1);
  return row * kColumns + column;
}

/// The longest tracks first, as long as a cell of one of their photos still wants them.
std::vector<std::size_t> choose_landmarks(const Model& model, int share) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < model.landmarks.size(); ++i)
    if (model.landmarks[i].valid) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return model.landmarks[a].used_count() > model.landmarks[b].used_count();
  });
  std::vector<std::array<int, static_cast<std::size_t>(kColumns * kRows)>> taken(
      model.poses.size());
  for (auto& cells : taken) cells.fill(0);
  std::vector<std::size_t> chosen;
  for (const std::size_t i : order) {
    const Landmark& landmark = model.landmarks[i];
    bool wanted = false;
    for (std::size_t k = 0; k < landmark.track.size(); ++k) {
      if (landmark.used[k] == 0) continue;
      const Observation& seen = landmark.track[k];
      const int cell = cell_of(model.camera(seen.photo), seen);
      int& count = taken[seen.photo][static_cast<std::size_t>(cell)];
      wanted = wanted || count < share;
    }
    if (!wanted) continue;
    chosen.push_back(i);
    for (std::size_t k = 0; k < landmark.track.size(); ++k)
      if (landmark.used[k] != 0) {
        const Observation& seen = landmark.track[k];
        ++taken[seen.photo][static_cast<std::size_t>(cell_of(model.camera(seen.photo), seen))];
      }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Blocks blocks_of(const Model& model, const AdjustmentState& state,
                 const std::vector<std::size_t>& landmarks) {
  Blocks blocks;
  blocks.poses.resize(model.poses.size());
  for (std::size_t i = 0; i < model.poses.size(); ++i) {
    const Pose& pose = model.poses[i];
    const Eigen::AngleAxisd turn(pose.camera_from_map);
    const Eigen::Vector3d vector = turn.angle() * turn.axis();
    blocks.poses[i] = {vector.x(),      vector.y(),      vector.z(),
                       pose.centre.x(), pose.centre.y(), pose.centre.z()};
  }
  for (const CameraModel& camera : model.cameras)
    blocks.lenses.push_back({std::log(camera.fx), camera.k1, camera.k2});
  blocks.readouts = model.readout_s;
  blocks.landmarks = landmarks;
  for (const std::size_t i : landmarks) {
    const Eigen::Vector3d& p = model.landmarks[i].position;
    blocks.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const Eigen::Vector3d& p : state.control) blocks.control.push_back({p.x(), p.y(), p.z()});
  blocks.offset = state.time_offset_s;
  blocks.bias = {state.position_bias.x(), state.position_bias.y(), state.position_bias.z()};
  blocks.ground = state.ground;
  return blocks;
}

/// Ends a solution between two iterations: what Ceres calls may not throw.
class StopBetweenIterations : public ceres::IterationCallback {
 public:
  explicit StopBetweenIterations(const StopToken& stop) : stop_(stop) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return stop_.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const StopToken& stop_;
};

/// Builds and solves one problem over the blocks.
class Adjustment {
 public:
  Adjustment(const Model& model, const AdjustmentState& state, const PhotoSet& set,
             const AerialMappingOptions& options, const AdjustmentPlan& plan)
      : model_(model),
        state_(state),
        set_(set),
        options_(options),
        plan_(plan),
        velocities_(velocities_of(set.photos)),
        blocks_(blocks_of(model, state, choose_landmarks(model, plan.cell_share))) {
    add_observations();
    add_readouts();
    add_positions();
    add_attitudes();
    add_ground();
    add_lenses();
    add_control();
    hold();
  }

  int solve(const StopToken& stop) {
    ceres::Solver::Options options;
    StopBetweenIterations callback(stop);
    options.callbacks = {&callback};
    options.linear_solver_type =
        model_.poses.size() < kDenseLimit ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
    options.max_num_iterations = plan_.max_iterations;
    options.num_threads = 1;  // sums of several threads would depend on their order
    options.function_tolerance = 1e-7;
    options.logging_type = ceres::SILENT;
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    std::vector<double*> all;
    problem_.GetParameterBlocks(&all);
    for (double* block : all) options.linear_solver_ordering->AddElementToGroup(block, 1);
    for (auto& point : blocks_.points)
      if (problem_.HasParameterBlock(point.data()))
        options.linear_solver_ordering->AddElementToGroup(point.data(), 0);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    stop.check();
    return static_cast<int>(summary.iterations.size());
  }

  std::vector<double> focal_sigmas() {
    std::vector<double> sigmas(blocks_.lenses.size(), 0.0);
    ceres::Covariance::Options options;
    options.num_threads = 1;
    ceres::Covariance covariance(options);
    std::vector<std::pair<const double*, const double*>> wanted;
    for (const auto& lens : blocks_.lenses)
      if (problem_.HasParameterBlock(lens.data()) &&
          !problem_.IsParameterBlockConstant(lens.data()))
        wanted.emplace_back(lens.data(), lens.data());
    if (wanted.empty() || !covariance.Compute(wanted, &problem_)) return sigmas;
    for (std::size_t i = 0; i < sigmas.size(); ++i) {
      const double* lens = blocks_.lenses[i].data();
      Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block;
      if (problem_.HasParameterBlock(lens) &&
          covariance.GetCovarianceBlock(lens, lens, block.data()))
        sigmas[i] = std::sqrt(std::max(0.0, block(0, 0)));
    }
    return sigmas;
  }

  const Blocks& blocks() const { return blocks_; }
  const Eigen::Vector3d& velocity(std::size_t photo) const { return velocities_[photo]; }

 private:
  ceres::LossFunction* loss(double weight) const {
    ceres::LossFunction* tail =
        plan_.heavy_tail ? static_cast<ceres::LossFunction*>(new ceres::CauchyLoss(plan_.loss_px))
                         : new ceres::HuberLoss(plan_.loss_px);
    return new ceres::ScaledLoss(tail, weight, ceres::TAKE_OWNERSHIP);
  }

  void add_observations() {
    std::vector<int> count(model_.poses.size(), 0);
    for (const std::size_t i : blocks_.landmarks)
      for (std::size_t k = 0; k < model_.landmarks[i].track.size(); ++k)
        if (model_.landmarks[i].used[k] != 0) ++count[model_.landmarks[i].track[k].photo];
    for (const int seen : count) weight_.push_back(std::min(1.0, kIndependent / std::max(1, seen)));
    for (std::size_t n = 0; n < blocks_.landmarks.size(); ++n) {
      const Landmark& landmark = model_.landmarks[blocks_.landmarks[n]];
      for (std::size_t k = 0; k < landmark.track.size(); ++k) {
        if (landmark.used[k] == 0) continue;
        const Observation& seen = landmark.track[k];
        const CameraModel& camera = model_.camera(seen.photo);
        const std::size_t of = model_.camera_of[seen.photo];
        problem_.AddResidualBlock(
            ReprojectionTerm::create(seen.u, seen.v, camera, motion(seen.photo)),
            loss(weight_[seen.photo]), blocks_.poses[seen.photo].data(), blocks_.lenses[of].data(),
            blocks_.points[n].data(), readout(of));
      }
    }
  }

  /// Metres for each second of readout(); where that is not adjusted, for the whole of it.
  const Eigen::Vector3d& motion(std::size_t photo) const {
    return plan_.free_readout ? velocities_[photo] : model_.poses[photo].flown;
  }
  double* readout(std::size_t camera) {
    return plan_.free_readout ? &blocks_.readouts[camera] : &whole_readout_;
  }

  void add_readouts() {
    if (problem_.HasParameterBlock(&whole_readout_))
      problem_.SetParameterBlockConstant(&whole_readout_);
    for (double& readout : blocks_.readouts)
      if (problem_.HasParameterBlock(&readout))
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<SoftHold<1>, 1, 1>(
                new SoftHold<1>{Eigen::Matrix<double, 1, 1>::Zero(),
                                Eigen::Matrix<double, 1, 1>::Constant(kReadoutSigma), 0}),
            nullptr, &readout);
  }

  bool takes_part(std::size_t photo) const {
    return problem_.HasParameterBlock(blocks_.poses[photo].data());
  }

  void add_positions() {
    if (!plan_.use_positions) return;
    int with_velocity = 0;
    for (std::size_t i = 0; i < set_.photos.size(); ++i) {
      const PhotoPrior& prior = set_.photos[i].prior;
      if (!prior.position || !takes_part(i)) continue;
      const double xy = prior.horizontal_sigma_m.value_or(options_.gps_sigma_m);
      const double z = prior.vertical_sigma_m.value_or(3.0 * xy);
      if (velocities_[i].norm() > 0.5) ++with_velocity;
      problem_.AddResidualBlock(
          PositionTerm::create(prior.position->vector(), velocities_[i], {xy, xy, z}),
          new ceres::CauchyLoss(kPositionTail), blocks_.poses[i].data(), &blocks_.offset,
          blocks_.bias.data());
    }
    if (!problem_.HasParameterBlock(&blocks_.offset)) return;
    const Eigen::Matrix<double, 1, 1> zero = Eigen::Matrix<double, 1, 1>::Zero();
    problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<SoftHold<1>, 1, 1>(
            new SoftHold<1>{zero, Eigen::Matrix<double, 1, 1>::Constant(kTimeOffsetSigma), 0}),
        nullptr, &blocks_.offset);
    if (with_velocity < kFewestForOffset) problem_.SetParameterBlockConstant(&blocks_.offset);
    const bool surveyed =
        std::count(state_.control_known.begin(), state_.control_known.end(), 1) >= 3;
    if (surveyed)
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<SoftHold<3>, 3, 3>(
              new SoftHold<3>{Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(kBiasSigma), 0}),
          nullptr, blocks_.bias.data());
    else
      problem_.SetParameterBlockConstant(blocks_.bias.data());
  }

  void add_attitudes() {
    for (std::size_t i = 0; i < set_.photos.size(); ++i) {
      const auto& attitude = set_.photos[i].prior.attitude;
      if (!takes_part(i)) continue;
      if (attitude && plan_.gimbal_sigma.sideward_rad > 0.0) {
        const Eigen::Matrix3d camera_from_map = map_from_camera_rotation(*attitude).transpose();
        problem_.AddResidualBlock(VerticalTerm::create(-camera_from_map.col(2), plan_.gimbal_sigma),
                                  new ceres::CauchyLoss(kPositionTail), blocks_.poses[i].data());
      }
      if (!attitude && plan_.nadir_sigma_deg > 0.0) {
        const double sigma = plan_.nadir_sigma_deg * std::numbers::pi / 180.0;
        problem_.AddResidualBlock(VerticalTerm::create(Eigen::Vector3d::UnitZ(), {sigma, sigma}),
                                  new ceres::CauchyLoss(kPositionTail), blocks_.poses[i].data());
      }
      if (attitude && plan_.use_heading) {
        const Eigen::Matrix3d map_from_camera = map_from_camera_rotation(*attitude);
        problem_.AddResidualBlock(
            HeadingTerm::create(Eigen::Vector3d::UnitX(), map_from_camera.col(0), kHeadingSigma),
            new ceres::CauchyLoss(kPositionTail), blocks_.poses[i].data());
      }
      if (plan_.gauge_sigma_m > 0.0) {
        const double s = plan_.gauge_sigma_m;
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<SoftHold<3>, 3, 6>(
                new SoftHold<3>{model_.poses[i].centre, Eigen::Vector3d::Constant(s), 3}),
            nullptr, blocks_.poses[i].data());
      }
    }
  }

  void add_ground() {
    if (plan_.flat_sigma_m > 0.0)
      for (auto& point : blocks_.points)
        problem_.AddResidualBlock(GroundTerm::create(plan_.flat_sigma_m), nullptr, point.data(),
                                  &blocks_.ground);
    if (options_.relative_altitude_sigma_m <= 0.0) return;
    const std::vector<std::optional<std::size_t>> middle = middle_points();
    std::vector<std::size_t> with_altitude;
    for (std::size_t i = 0; i < set_.photos.size(); ++i)
      if (middle[i] && set_.photos[i].prior.relative_altitude_m.value_or(0.0) > 1.0)
        with_altitude.push_back(i);
    // One residual for the block: its square is the mean of the photos'. Against points, not
    // against a mean height that the points would be tied to: that tie rewards a block for having
    // less relief, which a smaller block has.
    const double each =
        options_.relative_altitude_sigma_m * std::sqrt(static_cast<double>(with_altitude.size()));
    for (const std::size_t i : with_altitude)
      problem_.AddResidualBlock(
          RelativeAltitudeTerm::create(*set_.photos[i].prior.relative_altitude_m, each), nullptr,
          blocks_.poses[i].data(), blocks_.points[*middle[i]].data());
  }

  /// Of each photo the point, among those it sees, of the middle height.
  std::vector<std::optional<std::size_t>> middle_points() const {
    std::vector<std::vector<std::pair<double, std::size_t>>> seen(model_.poses.size());
    for (std::size_t n = 0; n < blocks_.landmarks.size(); ++n) {
      const Landmark& landmark = model_.landmarks[blocks_.landmarks[n]];
      for (std::size_t k = 0; k < landmark.track.size(); ++k)
        if (landmark.used[k] != 0)
          seen[landmark.track[k].photo].emplace_back(landmark.position.z(), n);
    }
    std::vector<std::optional<std::size_t>> middle(seen.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i].empty()) continue;
      const auto at = seen[i].begin() + static_cast<std::ptrdiff_t>(seen[i].size() / 2);
      std::nth_element(seen[i].begin(), at, seen[i].end());
      middle[i] = at->second;
    }
    return middle;
  }

  void add_lenses() {
    for (std::size_t i = 0; i < blocks_.lenses.size(); ++i) {
      double* lens = blocks_.lenses[i].data();
      if (!problem_.HasParameterBlock(lens)) continue;
      if (plan_.hold_cameras) {
        problem_.SetParameterBlockConstant(lens);
        continue;
      }
      const FocalPrior& prior = set_.cameras[i].focal;
      const bool known = prior.focal_px > 0.0 && !options_.free_focal;
      const double sigma = known ? std::max(1e-6, prior.relative_sigma) : kUnheldFocalSigma;
      const double log_focal = prior.focal_px > 0.0 ? std::log(prior.focal_px) : lens[0];
      const double distortion = options_.distortion_prior_sigma;
      problem_.AddResidualBlock(
          LensTerm::create(log_focal, sigma, distortion > 0.0 ? distortion : 1.0), nullptr, lens);
      if (distortion <= 0.0) problem_.SetManifold(lens, new ceres::SubsetManifold(3, {1, 2}));
    }
  }

  void add_control() {
    for (std::size_t i = 0; i < set_.control_points.size(); ++i) {
      if (i >= state_.control_known.size() || state_.control_known[i] == 0) continue;
      const GroundControlPoint& point = set_.control_points[i];
      for (const GroundControlPoint::Mark& mark : point.marks) {
        const auto photo = std::find_if(set_.photos.begin(), set_.photos.end(),
                                        [&](const auto& p) { return p.name == mark.photo; });
        if (photo == set_.photos.end()) continue;
        const auto n = static_cast<std::size_t>(photo - set_.photos.begin());
        if (!takes_part(n)) continue;
        const CameraModel& camera = model_.camera(n);
        const std::size_t of = model_.camera_of[n];
        problem_.AddResidualBlock(ReprojectionTerm::create(mark.u, mark.v, camera, motion(n)),
                                  new ceres::HuberLoss(2.0), blocks_.poses[n].data(),
                                  blocks_.lenses[of].data(), blocks_.control[i].data(),
                                  readout(of));
      }
      if (!problem_.HasParameterBlock(blocks_.control[i].data())) continue;
      const double xy = std::max(1e-4, point.horizontal_sigma_m);
      const double z = std::max(1e-4, point.vertical_sigma_m);
      problem_.AddResidualBlock(ControlTerm::create(point.position.vector(), {xy, xy, z}),
                                new ceres::CauchyLoss(kPositionTail), blocks_.control[i].data());
    }
  }

  void hold() {
    for (std::size_t i = 0; i < plan_.held.size(); ++i)
      if (plan_.held[i] != 0 && takes_part(i))
        problem_.SetParameterBlockConstant(blocks_.poses[i].data());
  }

  const Model& model_;
  const AdjustmentState& state_;
  const PhotoSet& set_;
  const AerialMappingOptions& options_;
  const AdjustmentPlan& plan_;
  std::vector<Eigen::Vector3d> velocities_;
  Blocks blocks_;
  double whole_readout_ = 1.0;
  ceres::Problem problem_;
  std::vector<double> weight_;
};

}  // namespace

std::vector<Eigen::Vector3d> velocities_of(const std::vector<MappingPhoto>& photos) {
  std::vector<Eigen::Vector3d> velocities(photos.size(), Eigen::Vector3d::Zero());
  std::map<std::size_t, std::vector<std::size_t>> by_camera;
  for (std::size_t i = 0; i < photos.size(); ++i)
    if (photos[i].prior.position && photos[i].prior.taken_at)
      by_camera[photos[i].camera].push_back(i);
  constexpr double kLongestGap = 20.0;  // s: beyond, it is another strip or another flight
  constexpr double kTurn = 0.5;         // change of velocity, in velocities, that is a turn
  for (auto& [camera, order] : by_camera) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return *photos[a].prior.taken_at < *photos[b].prior.taken_at;
    });
    // Mean velocity from the k-th photo to the next.
    std::vector<std::optional<Eigen::Vector3d>> legs(order.size());
    for (std::size_t k = 0; k + 1 < order.size(); ++k) {
      const PhotoPrior& from = photos[order[k]].prior;
      const PhotoPrior& to = photos[order[k + 1]].prior;
      const double seconds = to.taken_at->seconds() - from.taken_at->seconds();
      if (seconds > 0.5 && seconds < kLongestGap)
        legs[k] = (to.position->vector() - from.position->vector()) / seconds;
    }
    const auto leg = [&](std::size_t k) {
      return k < legs.size() ? legs[k] : std::optional<Eigen::Vector3d>{};
    };
    const auto go_on = [&](const std::optional<Eigen::Vector3d>& a,
                           const std::optional<Eigen::Vector3d>& b) {
      return a && b && (*a - *b).norm() < kTurn * std::max(a->norm(), b->norm());
    };
    for (std::size_t k = 0; k < order.size(); ++k) {
      Eigen::Vector3d& velocity = velocities[order[k]];
      const auto before = leg(k - 1);  // k - 1 of the first wraps: no such leg
      const auto after = leg(k);
      // At the end of a strip one of the two legs is the turn: the strip's is the one that goes
      // on as the leg beyond it.
      const bool strip_before = go_on(before, leg(k - 2));
      const bool strip_after = go_on(after, leg(k + 1));
      if (before && after && go_on(before, after))
        velocity = 0.5 * (*before + *after);
      else if (before && (!after || (strip_before && !strip_after)))
        velocity = *before;
      else if (after && (!before || (strip_after && !strip_before)))
        velocity = *after;
    }
  }
  return velocities;
}

std::optional<GimbalSigma> gimbal_residuals(const Model& model, const PhotoSet& set, int fewest) {
  std::vector<double> roll;
  std::vector<double> pitch;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    const auto& attitude = set.photos[i].prior.attitude;
    if (!attitude || !model.poses[i].known) continue;
    const Eigen::Matrix3d said = map_from_camera_rotation(*attitude).transpose();
    const Eigen::Vector3d left = said.col(2) - model.poses[i].camera_from_map.col(2);
    roll.push_back(std::abs(left.x()));
    pitch.push_back(std::hypot(left.y(), left.z()));
  }
  if (static_cast<int>(roll.size()) < fewest) return std::nullopt;
  const auto sigma = [](std::vector<double>& magnitudes) {
    const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
    std::nth_element(magnitudes.begin(), middle, magnitudes.end());
    return 1.4826 * *middle;  // of normal errors
  };
  return GimbalSigma{sigma(roll), sigma(pitch)};
}

void adjust(Model& model, AdjustmentState& state, const PhotoSet& set,
            const AerialMappingOptions& options, const AdjustmentPlan& plan,
            const StopToken& stop) {
  stop.check();
  Adjustment adjustment(model, state, set, options, plan);
  if (adjustment.blocks().points.empty()) return;
  state.iterations += adjustment.solve(stop);
  const Blocks& blocks = adjustment.blocks();
  for (std::size_t i = 0; i < model.poses.size(); ++i) {
    if (!model.poses[i].known) continue;
    const auto& b = blocks.poses[i];
    const Eigen::Vector3d vector{b[0], b[1], b[2]};
    const double angle = vector.norm();
    model.poses[i].camera_from_map =
        angle > 0.0 ? Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix()
                    : Eigen::Matrix3d::Identity();
    model.poses[i].centre = {b[3], b[4], b[5]};
    if (plan.free_readout)
      model.poses[i].flown = blocks.readouts[model.camera_of[i]] * adjustment.velocity(i);
  }
  model.readout_s = blocks.readouts;
  for (std::size_t i = 0; i < model.cameras.size(); ++i) {
    model.cameras[i].fx = model.cameras[i].fy = std::exp(blocks.lenses[i][0]);
    model.cameras[i].k1 = blocks.lenses[i][1];
    model.cameras[i].k2 = blocks.lenses[i][2];
  }
  for (std::size_t n = 0; n < blocks.landmarks.size(); ++n)
    model.landmarks[blocks.landmarks[n]].position = {blocks.points[n][0], blocks.points[n][1],
                                                     blocks.points[n][2]};
  for (std::size_t i = 0; i < state.control.size(); ++i)
    state.control[i] = {blocks.control[i][0], blocks.control[i][1], blocks.control[i][2]};
  state.time_offset_s = blocks.offset;
  state.position_bias = {blocks.bias[0], blocks.bias[1], blocks.bias[2]};
  state.ground = blocks.ground;
}

std::vector<double> focal_sigmas(const Model& model, const AdjustmentState& state,
                                 const PhotoSet& set, const AerialMappingOptions& options,
                                 const AdjustmentPlan& plan) {
  Adjustment adjustment(model, state, set, options, plan);
  return adjustment.focal_sigmas();
}

}  // namespace nadir::aerial
