// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/pose_alignment.hpp"

#include <gtest/gtest.h>

#include "support/expect_error.hpp"

namespace nadir {
namespace {

using test::expect_error;

struct Block {
  std::vector<PhotoPose> poses;      ///< of a frame of their own
  std::vector<PhotoPose> truth;      ///< in the map
  std::vector<MappingPhoto> photos;  ///< with the true positions
};

/// Photos in `rows` strips; the model is the truth, turned, shrunk and shifted.
Block block(int rows) {
  Block result;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, -2, 0.5).normalized()));
  for (int i = 0; i < 5 * rows; ++i) {
    PhotoPose pose{"p" + std::to_string(i), {}, {}};
    pose.map_from_camera.translation = {576000.0 + 10.0 * (i % 5), 5188000.0 + 20.0 * (i / 5),
                                        rows > 1 ? 200.0 + 0.3 * (i % 3) : 200.0};
    pose.map_from_camera.rotation = Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitX());
    result.truth.push_back(pose);
    MappingPhoto photo;
    photo.name = pose.name;
    photo.prior.position = Point3<frames::Map>::from(pose.map_from_camera.translation);
    result.photos.push_back(photo);
    auto& p = pose.map_from_camera;
    p.translation = turn * (p.translation - Eigen::Vector3d(576000, 5188000, 190)) / 37.0 +
                    Eigen::Vector3d(1, 2, 3);
    p.rotation = turn * p.rotation;
    result.poses.push_back(pose);
  }
  return result;
}

TEST(PoseAlignment, FindsTheSimilarity) {
  Block b = block(3);
  EXPECT_LT(align_poses(b.poses, b.photos), 1e-6);
  for (std::size_t i = 0; i < b.poses.size(); ++i) {
    const auto& found = b.poses[i].map_from_camera;
    const auto& truth = b.truth[i].map_from_camera;
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-6);
    EXPECT_LT(found.rotation.angularDistance(truth.rotation), 1e-7);
  }
}

TEST(PoseAlignment, PhotosWithoutPositionAreMovedToo) {
  Block b = block(3);
  b.photos[4].prior.position.reset();
  align_poses(b.poses, b.photos);
  EXPECT_LT(
      (b.poses[4].map_from_camera.translation - b.truth[4].map_from_camera.translation).norm(),
      1e-6);
}

TEST(PoseAlignment, RefusesALineAndTooFew) {
  Block line = block(1);
  expect_error(ErrorKind::kUsage, {"lie on a line"}, [&] { align_poses(line.poses, line.photos); });
  Block few = block(3);
  few.photos.resize(2);
  expect_error(ErrorKind::kUsage, {"only 2 of their photos"},
               [&] { align_poses(few.poses, few.photos); });
}

}  // namespace
}  // namespace nadir
