// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/pose_start.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "nadir/aerial_mapping/detail/median.hpp"

namespace nadir::aerial {
namespace {

using Complex = std::complex<double>;

constexpr int kMatchesOfPair = 60;  // enough for a similarity, and no pair outweighs another
constexpr int kReweightings = 8;
constexpr double kSteep = 0.35;  // a ray flatter than 20 degrees says nothing of the ground

/// The camera turned so that its upper edge points north, tilted as its gimbal says.
Eigen::Matrix3d levelled_rotation(const PhotoPrior& prior) {
  PhotoAttitude attitude;
  if (prior.attitude) attitude = *prior.attitude;
  attitude.yaw = std::numbers::pi / 2.0;
  return map_from_camera_rotation(attitude);
}

/// One match: the ground in the units of either photo's height, below its camera.
struct PlanarMatch {
  std::size_t first;
  std::size_t second;
  Complex p;
  Complex q;
  double weight;
};

std::optional<Complex> on_ground(const Eigen::Matrix3d& rotation, const CameraModel& camera,
                                 const Feature& feature) {
  const Eigen::Vector3d ray =
      rotation * camera.ray({static_cast<double>(feature.u), static_cast<double>(feature.v)});
  if (ray.z() > -kSteep * ray.norm()) return std::nullopt;
  return Complex(ray.x() / -ray.z(), ray.y() / -ray.z());
}

std::vector<PlanarMatch> planar_matches(const Model& model, const std::vector<int>& slot,
                                        const std::vector<MappingPhoto>& photos,
                                        const std::vector<PhotoFeatures>& features,
                                        const std::vector<VerifiedPair>& pairs) {
  std::vector<PlanarMatch> matches;
  for (const VerifiedPair& pair : pairs) {
    if (slot[pair.first] < 0 || slot[pair.second] < 0) continue;
    const Eigen::Matrix3d r1 = levelled_rotation(photos[pair.first].prior);
    const Eigen::Matrix3d r2 = levelled_rotation(photos[pair.second].prior);
    const std::size_t step = std::max<std::size_t>(1, pair.inliers.size() / kMatchesOfPair);
    const std::size_t begin = matches.size();
    for (std::size_t k = 0; k < pair.inliers.size(); k += step) {
      const auto& [i, j] = pair.inliers[k];
      const auto p = on_ground(r1, model.camera(pair.first),
                               features[pair.first].points[static_cast<std::size_t>(i)]);
      const auto q = on_ground(r2, model.camera(pair.second),
                               features[pair.second].points[static_cast<std::size_t>(j)]);
      if (p && q)
        matches.push_back({static_cast<std::size_t>(slot[pair.first]),
                           static_cast<std::size_t>(slot[pair.second]), *p, *q, 1.0});
    }
    // More matches make a pair surer, but not in proportion: their errors are common ones.
    const auto count = static_cast<double>(matches.size() - begin);
    for (std::size_t k = begin; k < matches.size(); ++k)
      matches[k].weight = std::sqrt(count) / std::max(count, 1.0);
  }
  return matches;
}

/// min sum w |t_i + a_i p - t_j - a_j q|^2 with the anchor at t = 0, a = 1: the unknowns are
/// t_0, a_0, t_1, a_1, ...; their normal equations are Hermitian.
Eigen::VectorXcd solve_layout(const std::vector<PlanarMatch>& matches,
                              const std::vector<double>& robust, std::size_t photos,
                              std::size_t anchor) {
  const auto n = static_cast<Eigen::Index>(2 * photos);
  Eigen::MatrixXcd normal = Eigen::MatrixXcd::Zero(n, n);
  Eigen::VectorXcd right = Eigen::VectorXcd::Zero(n);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const PlanarMatch& m = matches[k];
    const auto i = static_cast<Eigen::Index>(2 * m.first);
    const auto j = static_cast<Eigen::Index>(2 * m.second);
    const std::array<std::pair<Eigen::Index, Complex>, 4> row{
        {{i, 1.0}, {i + 1, m.p}, {j, -1.0}, {j + 1, -m.q}}};
    const double w = m.weight * robust[k];
    for (const auto& [a, x] : row)
      for (const auto& [b, y] : row) normal(a, b) += w * std::conj(x) * y;
  }
  const auto a0 = static_cast<Eigen::Index>(2 * anchor);
  const double held = 1e6 * normal.diagonal().real().maxCoeff();
  normal(a0, a0) += held;
  normal(a0 + 1, a0 + 1) += held;
  right(a0 + 1) += held;
  return normal.ldlt().solve(right);
}

void set_pose(Pose& pose, const Eigen::Matrix3d& map_from_camera, const Eigen::Vector3d& centre) {
  pose.camera_from_map = map_from_camera.transpose();
  pose.centre = centre;
  pose.known = true;
}

/// Similarity of the plane, z = s * x + c, that brings `from` to `to`; weights by Cauchy, so that
/// single wrong positions lose theirs.
struct PlaneSimilarity {
  Complex scale{1.0, 0.0};
  Complex shift{0.0, 0.0};
};

PlaneSimilarity fit_similarity(const std::vector<Complex>& from, const std::vector<Complex>& to,
                               bool scale_and_turn) {
  PlaneSimilarity fit;
  std::vector<double> weights(from.size(), 1.0);
  for (int pass = 0; pass < kReweightings; ++pass) {
    Complex from_mean{};
    Complex to_mean{};
    double sum = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) {
      from_mean += weights[k] * from[k];
      to_mean += weights[k] * to[k];
      sum += weights[k];
    }
    from_mean /= sum;
    to_mean /= sum;
    if (scale_and_turn) {
      Complex cross{};
      double norm = 0.0;
      for (std::size_t k = 0; k < from.size(); ++k) {
        cross += weights[k] * std::conj(from[k] - from_mean) * (to[k] - to_mean);
        norm += weights[k] * std::norm(from[k] - from_mean);
      }
      if (norm > 0.0) fit.scale = cross / norm;
    }
    fit.shift = to_mean - fit.scale * from_mean;
    std::vector<double> residuals;
    for (std::size_t k = 0; k < from.size(); ++k)
      residuals.push_back(std::abs(fit.scale * from[k] + fit.shift - to[k]));
    const double sigma = std::max(1e-9, 2.0 * median_of(residuals));
    for (std::size_t k = 0; k < from.size(); ++k)
      weights[k] = 1.0 / (1.0 + residuals[k] * residuals[k] / (sigma * sigma));
  }
  return fit;
}

/// Extent of points: root mean square distance from their mean.
double extent_of(const std::vector<Complex>& points) {
  Complex mean{};
  for (const Complex& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double sum = 0.0;
  for (const Complex& p : points) sum += std::norm(p - mean);
  return std::sqrt(sum / static_cast<double>(points.size()));
}

/// Turn that brings the cameras' headings to those of their gimbals: the mean direction.
std::optional<double> heading_correction(const Model& model, const std::vector<std::size_t>& group,
                                         const std::vector<MappingPhoto>& photos) {
  Complex sum{};
  for (const std::size_t i : group) {
    if (!photos[i].prior.attitude) continue;
    const double yaw = yaw_of_camera(model.poses[i].camera_from_map.transpose());
    sum += std::polar(1.0, photos[i].prior.attitude->yaw - yaw);
  }
  if (std::abs(sum) < 1e-6) return std::nullopt;
  return std::arg(sum);
}

}  // namespace

void lay_out(Model& model, const std::vector<std::size_t>& group,
             const std::vector<MappingPhoto>& photos, const std::vector<PhotoFeatures>& features,
             const std::vector<VerifiedPair>& pairs, const StopToken& stop) {
  std::vector<int> slot(photos.size(), -1);
  for (std::size_t k = 0; k < group.size(); ++k) slot[group[k]] = static_cast<int>(k);
  const std::vector<PlanarMatch> matches = planar_matches(model, slot, photos, features, pairs);
  std::vector<double> links(group.size(), 0.0);
  for (const PlanarMatch& m : matches) {
    links[m.first] += m.weight;
    links[m.second] += m.weight;
  }
  const auto anchor =
      static_cast<std::size_t>(std::max_element(links.begin(), links.end()) - links.begin());

  std::vector<double> robust(matches.size(), 1.0);
  Eigen::VectorXcd layout;
  for (int pass = 0; pass < kReweightings; ++pass) {
    stop.check();
    layout = solve_layout(matches, robust, group.size(), anchor);
    std::vector<double> residuals;
    for (const PlanarMatch& m : matches) {
      const auto i = static_cast<Eigen::Index>(2 * m.first);
      const auto j = static_cast<Eigen::Index>(2 * m.second);
      // Relative to the size of the photo: small photos must not look better than large ones.
      const double size = std::max(1e-9, 0.5 * (std::abs(layout(i + 1)) + std::abs(layout(j + 1))));
      residuals.push_back(
          std::abs(layout(i) + layout(i + 1) * m.p - layout(j) - layout(j + 1) * m.q) / size);
    }
    const double sigma = std::max(1e-4, 1.5 * median_of(residuals));
    for (std::size_t k = 0; k < matches.size(); ++k)
      robust[k] = 1.0 / (1.0 + residuals[k] * residuals[k] / (sigma * sigma));
  }
  for (std::size_t k = 0; k < group.size(); ++k) {
    const Complex t = layout(static_cast<Eigen::Index>(2 * k));
    const Complex a = layout(static_cast<Eigen::Index>(2 * k + 1));
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(std::arg(a), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    set_pose(model.poses[group[k]], turn * levelled_rotation(photos[group[k]].prior),
             {t.real(), t.imag(), std::max(std::abs(a), 1e-6)});
  }
}

Placement place(Model& model, const std::vector<std::size_t>& group,
                const std::vector<MappingPhoto>& photos) {
  Placement placement;
  std::vector<Complex> from;
  std::vector<Complex> to;
  std::vector<double> heights;
  for (const std::size_t i : group) {
    const Pose& pose = model.poses[i];
    if (photos[i].prior.position) {
      from.emplace_back(pose.centre.x(), pose.centre.y());
      to.emplace_back(photos[i].prior.position->x, photos[i].prior.position->y);
    }
    if (photos[i].prior.relative_altitude_m && *photos[i].prior.relative_altitude_m > 1.0 &&
        pose.centre.z() > 0.0)
      heights.push_back(*photos[i].prior.relative_altitude_m / pose.centre.z());
  }
  // Positions of a drone that hovers say nothing of scale and heading.
  constexpr double kFewMetres = 3.0;
  const bool spread = from.size() >= 2 && extent_of(to) > kFewMetres;
  double scale = 1.0;
  double turn = 0.0;
  if (spread) {
    const PlaneSimilarity fit = fit_similarity(from, to, true);
    scale = std::abs(fit.scale);
    turn = std::arg(fit.scale);
    placement = {true, true, true};
  } else {
    if (!heights.empty()) scale = median_of(heights);
    placement.scale = !heights.empty();
    const auto correction = heading_correction(model, group, photos);
    turn = correction.value_or(0.0);
    placement.heading = correction.has_value();
    placement.position = !from.empty();
  }
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  transform(model, scale, rotation, Eigen::Vector3d::Zero());
  if (!placement.position) return placement;

  const Complex factor = std::polar(scale, turn);
  for (Complex& p : from) p *= factor;
  const Complex shift = fit_similarity(from, to, false).shift;
  std::vector<double> up;
  for (const std::size_t i : group)
    if (photos[i].prior.position)
      up.push_back(photos[i].prior.position->z - model.poses[i].centre.z());
  placement.ground = median_of(up);
  transform(model, 1.0, Eigen::Matrix3d::Identity(),
            {shift.real(), shift.imag(), placement.ground});
  return placement;
}

std::optional<std::pair<double, double>> widths_of_positions(
    const std::vector<std::size_t>& group, const std::vector<MappingPhoto>& photos) {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const std::size_t i : group)
    if (photos[i].prior.position) {
      points.emplace_back(photos[i].prior.position->x, photos[i].prior.position->y);
      mean += points.back();
    }
  if (points.size() < 2) return std::nullopt;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) moments += (p - mean) * (p - mean).transpose();
  moments /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moments);
  return std::pair(std::sqrt(std::max(0.0, solver.eigenvalues()[1])),
                   std::sqrt(std::max(0.0, solver.eigenvalues()[0])));
}

void transform(Model& model, double scale, const Eigen::Matrix3d& rotation,
               const Eigen::Vector3d& shift) {
  for (Pose& pose : model.poses) {
    if (!pose.known) continue;
    pose.camera_from_map = pose.camera_from_map * rotation.transpose();
    pose.centre = scale * (rotation * pose.centre) + shift;
    pose.flown = scale * (rotation * pose.flown);
  }
  for (Landmark& landmark : model.landmarks)
    landmark.position = scale * (rotation * landmark.position) + shift;
}

void level(Model& model) {
  // z = a + b x + c y by reweighted least squares.
  std::vector<Eigen::Vector3d> points;
  for (const Landmark& landmark : model.landmarks)
    if (landmark.valid) points.push_back(landmark.position);
  if (points.size() < 10) return;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  std::vector<double> weights(points.size(), 1.0);
  for (int pass = 0; pass < kReweightings; ++pass) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity() * 1e-12;
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector3d row{1.0, points[k].x() - mean.x(), points[k].y() - mean.y()};
      a += weights[k] * row * row.transpose();
      b += weights[k] * row * (points[k].z() - mean.z());
    }
    plane = a.ldlt().solve(b);
    std::vector<double> residuals;
    for (const Eigen::Vector3d& p : points)
      residuals.push_back(std::abs(p.z() - mean.z() - plane.x() - plane.y() * (p.x() - mean.x()) -
                                   plane.z() * (p.y() - mean.y())));
    const double sigma = std::max(1e-9, 1.5 * median_of(residuals));
    for (std::size_t k = 0; k < points.size(); ++k)
      weights[k] = 1.0 / (1.0 + residuals[k] * residuals[k] / (sigma * sigma));
  }
  const Eigen::Vector3d normal = Eigen::Vector3d(-plane.y(), -plane.z(), 1.0).normalized();
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond::FromTwoVectors(normal, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d foot{mean.x(), mean.y(), mean.z() + plane.x()};
  transform(model, 1.0, rotation, -(rotation * foot));
}

std::optional<Pose> pose_of_prior(const PhotoPrior& prior) {
  if (!prior.position || !prior.attitude) return std::nullopt;
  Pose pose;
  set_pose(pose, map_from_camera_rotation(*prior.attitude), prior.position->vector());
  return pose;
}

}  // namespace nadir::aerial
