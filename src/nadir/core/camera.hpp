// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

namespace nadir {

/// A pinhole camera with Brown-Conrady distortion (OpenCV's order: k1, k2, p1, p2, k3). Pixel
/// coordinates are OpenCV's: (0, 0) is the CENTRE of the first pixel, unlike those of a
/// geo-reference; u grows to the right, v downwards.
struct CameraModel {
  int width = 0;    ///< pixels
  int height = 0;   ///< pixels
  double fx = 0.0;  ///< pixels
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;

  bool has_distortion() const {
    return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0;
  }

  /// Distorts normalised coordinates (x / z, y / z).
  Eigen::Vector2d distort(const Eigen::Vector2d& n) const {
    const double r2 = n.squaredNorm();
    const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {n.x() * radial + 2.0 * p1 * n.x() * n.y() + p2 * (r2 + 2.0 * n.x() * n.x()),
            n.y() * radial + p1 * (r2 + 2.0 * n.y() * n.y()) + 2.0 * p2 * n.x() * n.y()};
  }

  /// The pixel of a point of the camera frame; nothing where it is not in front of the camera.
  /// The pixel may lie outside the image.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_in_camera) const {
    if (!(p_in_camera.z() > 0.0)) return std::nullopt;
    const Eigen::Vector2d d =
        distort({p_in_camera.x() / p_in_camera.z(), p_in_camera.y() / p_in_camera.z()});
    return Eigen::Vector2d{fx * d.x() + cx, fy * d.y() + cy};
  }

  /// The ray (x, y, 1) of a pixel in the camera frame; the distortion is undone by fixed-point
  /// iteration, to 1e-9 of the normalised plane for the distortion of ordinary lenses.
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d distorted{(pixel.x() - cx) / fx, (pixel.y() - cy) / fy};
    Eigen::Vector2d n = distorted;
    if (has_distortion()) {
      for (int i = 0; i < 50; ++i) {
        const Eigen::Vector2d step = distorted - distort(n);
        n += step;
        if (step.squaredNorm() < 1e-20) break;
      }
    }
    return {n.x(), n.y(), 1.0};
  }

  bool operator==(const CameraModel&) const = default;
};

}  // namespace nadir
