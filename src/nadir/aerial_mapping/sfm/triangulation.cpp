// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/triangulation.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace nadir::aerial {
namespace {

constexpr int kPasses = 3;  // of leaving out what disagrees
constexpr int kRefinements = 4;

/// The point nearest to all rays (sum of squared distances), by its 3 x 3 normal equations.
bool nearest_to_rays(const Model& model, const Landmark& landmark,
                     const std::vector<Eigen::Vector3d>& rays, Eigen::Vector3d& point) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (landmark.used[k] == 0) continue;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - rays[k] * rays[k].transpose();
    a += across;
    b += across * model.centre_at(landmark.track[k].photo, landmark.track[k].v);
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(a);
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < 1e-9) return false;
  point = solver.solve(b);
  return point.allFinite();
}

/// Gauss-Newton on the pixel errors, with the derivative of the undistorted projection.
void refine(const Model& model, const Landmark& landmark, Eigen::Vector3d& point) {
  for (int pass = 0; pass < kRefinements; ++pass) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < landmark.track.size(); ++k) {
      if (landmark.used[k] == 0) continue;
      const Observation& seen = landmark.track[k];
      const Pose& pose = model.poses[seen.photo];
      const CameraModel& camera = model.camera(seen.photo);
      const Eigen::Vector3d p =
          pose.camera_from_map * (point - model.centre_at(seen.photo, seen.v));
      const auto pixel = camera.project(p);
      if (!pixel) return;
      Eigen::Matrix<double, 2, 3> j;
      j << camera.fx / p.z(), 0.0, -camera.fx * p.x() / (p.z() * p.z()), 0.0, camera.fy / p.z(),
          -camera.fy * p.y() / (p.z() * p.z());
      j = (j * pose.camera_from_map).eval();
      a += j.transpose() * j;
      b += j.transpose() * (Eigen::Vector2d(seen.u, seen.v) - *pixel);
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(a);
    if (solver.info() != Eigen::Success) return;
    const Eigen::Vector3d step = solver.solve(b);
    if (!step.allFinite()) return;
    point += step;
  }
}

double widest_angle(const Landmark& landmark, const std::vector<Eigen::Vector3d>& rays) {
  double smallest_cosine = 1.0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t j = i + 1; j < rays.size(); ++j)
      if (landmark.used[i] != 0 && landmark.used[j] != 0)
        smallest_cosine = std::min(smallest_cosine, rays[i].dot(rays[j]));
  return std::acos(std::clamp(smallest_cosine, -1.0, 1.0));
}

void triangulate_one(const Model& model, const TriangulationGates& gates, Landmark& landmark) {
  landmark.valid = false;
  landmark.used.assign(landmark.track.size(), 0);
  std::vector<Eigen::Vector3d> rays(landmark.track.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const Observation& seen = landmark.track[k];
    if (!model.poses[seen.photo].known) continue;
    landmark.used[k] = 1;
    rays[k] = model.direction(seen.photo, seen.u, seen.v);
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    if (landmark.used_count() < gates.min_views) return;
    if (!nearest_to_rays(model, landmark, rays, landmark.position)) return;
    refine(model, landmark, landmark.position);
    // One bad observation spoils the others' errors too: only the worst goes, until all agree.
    double worst = 0.0;
    std::size_t worst_index = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      if (landmark.used[k] == 0) continue;
      const double error = model.error_px(landmark.track[k], landmark.position);
      if (error > worst) {
        worst = error;
        worst_index = k;
      }
    }
    if (worst <= gates.max_error_px) {
      landmark.valid =
          widest_angle(landmark, rays) * 180.0 / std::numbers::pi >= gates.min_angle_deg;
      return;
    }
    landmark.used[worst_index] = 0;
  }
}

}  // namespace

double Model::error_px(const Observation& seen, const Eigen::Vector3d& point) const {
  const auto pixel = project(seen.photo, point);
  if (!pixel) return std::numeric_limits<double>::infinity();
  return std::hypot(pixel->x() - seen.u, pixel->y() - seen.v);
}

void triangulate(Model& model, const TriangulationGates& gates) {
  tbb::parallel_for(std::size_t{0}, model.landmarks.size(),
                    [&](std::size_t i) { triangulate_one(model, gates, model.landmarks[i]); });
}

void place_on_plane(Model& model, double ground, double spread) {
  for (Landmark& landmark : model.landmarks) {
    landmark.valid = false;
    landmark.used.assign(landmark.track.size(), 0);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> feet;
    for (std::size_t k = 0; k < landmark.track.size(); ++k) {
      const Observation& seen = landmark.track[k];
      if (!model.poses[seen.photo].known) continue;
      const Eigen::Vector3d ray = model.direction(seen.photo, seen.u, seen.v);
      if (ray.z() > -0.1) continue;  // near the horizon
      const Eigen::Vector3d centre = model.centre_at(seen.photo, seen.v);
      feet.emplace_back(centre + ray * ((ground - centre.z()) / ray.z()));
      sum += feet.back();
      landmark.used[k] = 1;
    }
    if (feet.size() < 2) continue;
    landmark.position = sum / static_cast<double>(feet.size());
    landmark.valid = std::all_of(feet.begin(), feet.end(), [&](const Eigen::Vector3d& foot) {
      return (foot - landmark.position).norm() < spread;
    });
  }
}

ReprojectionError reprojection_error(const Model& model) {
  ReprojectionError result;
  std::vector<double> errors;
  double sum = 0.0;
  for (const Landmark& landmark : model.landmarks) {
    if (!landmark.valid) continue;
    ++result.points;
    for (std::size_t k = 0; k < landmark.track.size(); ++k) {
      if (landmark.used[k] == 0) continue;
      const double error = model.error_px(landmark.track[k], landmark.position);
      if (!std::isfinite(error)) continue;
      errors.push_back(error);
      sum += error * error;
    }
  }
  result.observations = static_cast<int>(errors.size());
  if (errors.empty()) return result;
  result.rms = std::sqrt(sum / static_cast<double>(errors.size()));
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  result.median = *middle;
  return result;
}

}  // namespace nadir::aerial
