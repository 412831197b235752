// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/pose_alignment.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

using Points = Eigen::Matrix3Xd;

/// Middle over largest extent of a cloud of points.
double flatness(const Points& points) {
  const Points centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d extents =
      Eigen::JacobiSVD<Eigen::Matrix3d>(centred * centred.transpose()).singularValues().cwiseSqrt();
  return extents[0] > 0.0 ? extents[1] / extents[0] : 0.0;
}

}  // namespace

double align_poses(std::vector<PhotoPose>& poses, std::span<const MappingPhoto> photos) {
  constexpr double kLine = 0.02;
  std::vector<Eigen::Vector3d> model;
  std::vector<Eigen::Vector3d> given;
  for (const PhotoPose& pose : poses) {
    const auto photo =
        std::ranges::find(photos, pose.name, [](const MappingPhoto& p) { return p.name; });
    if (photo == photos.end() || !photo->prior.position) continue;
    model.push_back(pose.map_from_camera.translation);
    given.push_back(photo->prior.position->vector());
  }
  if (model.size() < 3) {
    throw Error(ErrorKind::kUsage,
                "the poses are in a frame of their own, and only " + std::to_string(model.size()) +
                    " of their photos have a position",
                {}, "give --positions for three photos at least");
  }
  Points from(3, static_cast<Eigen::Index>(model.size()));
  Points to(3, static_cast<Eigen::Index>(model.size()));
  for (std::size_t i = 0; i < model.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = model[i];
    to.col(static_cast<Eigen::Index>(i)) = given[i];
  }
  if (flatness(to) < kLine || flatness(from) < kLine) {
    throw Error(ErrorKind::kUsage,
                "the photos lie on a line: poses in a frame of their own could turn about it", {},
                "give poses with a georeference, or a flight of two strips");
  }
  const Eigen::Matrix4d similarity = Eigen::umeyama(from, to, true);
  const Eigen::Matrix3d scaled = similarity.topLeftCorner<3, 3>();
  const double scale = std::cbrt(scaled.determinant());
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(scaled / scale));
  for (PhotoPose& pose : poses) {
    auto& p = pose.map_from_camera;
    p.translation = scaled * p.translation + similarity.topRightCorner<3, 1>();
    p.rotation = (rotation * p.rotation).normalized();
    pose.flown_in_readout = scaled * pose.flown_in_readout;
  }
  const Points residual =
      (scaled * from).colwise() + Eigen::Vector3d(similarity.topRightCorner<3, 1>()) - to;
  return std::sqrt(residual.squaredNorm() / static_cast<double>(model.size()));
}

}  // namespace nadir
