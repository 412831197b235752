// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <opencv2/core.hpp>

#include "nadir/io/detail/camera_yaml.hpp"
#include "nadir/io/detail/drive_layout.hpp"
#include "nadir/io/detail/kitti_calibration.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

struct StoredMatrix {
  cv::Mat values;
  std::string where;
};

/// The matrices of several files of OpenCV's by their names.
class StoredMatrices {
 public:
  explicit StoredMatrices(const std::vector<path>& files) {
    for (const path& file : files) {
      files_ += (files_.empty() ? "" : ", ") + file.string();
      read(file);
    }
  }

  /// The first of these names that is there, of `count` values or more (0 = as it is).
  std::vector<double> find(const std::vector<std::string>& names, std::size_t count) const {
    for (const std::string& name : names) {
      const auto found = matrices_.find(name);
      if (found == matrices_.end()) continue;
      std::vector<double> values(found->second.values.begin<double>(),
                                 found->second.values.end<double>());
      if (values.size() < count) {
        throw Error(ErrorKind::kInput,
                    fmt::format("'{}' has {} numbers instead of {}", name, values.size(), count),
                    found->second.where, "give the calibration as OpenCV wrote it");
      }
      return values;
    }
    return {};
  }

  std::vector<double> require(const std::vector<std::string>& names, std::size_t count) const {
    std::vector<double> values = find(names, count);
    if (!values.empty()) return values;
    throw Error(ErrorKind::kInput, "the stereo calibration has no '" + names.front() + "'", files_,
                "M1, D1, M2, D2, R and T, or P1 and P2, are needed");
  }

  const std::string& files() const { return files_; }

 private:
  void read(const path& file) {
    try {
      const cv::FileStorage storage(read_file(file),
                                    cv::FileStorage::READ | cv::FileStorage::MEMORY);
      const cv::FileNode root = storage.root();
      for (const cv::FileNode& node : root) {
        if (!node.isMap() || node["data"].empty()) continue;
        cv::Mat matrix = node.mat();
        matrix.convertTo(matrix, CV_64F);
        matrices_[node.name()] = {matrix, file.string()};
      }
    } catch (const cv::Exception& exception) {
      throw input_error(file, "is not OpenCV's YAML: " + exception.err, "correct the file");
    }
  }

  std::map<std::string, StoredMatrix> matrices_;
  std::string files_;
};

CameraModel camera_of(const StoredMatrices& matrices, int number) {
  const auto k = matrices.require({fmt::format("M{}", number), fmt::format("K{}", number),
                                   fmt::format("cameraMatrix{}", number)},
                                  9);
  auto d = matrices.find({fmt::format("D{}", number), fmt::format("distCoeffs{}", number)}, 0);
  for (std::size_t i = 5; i < d.size(); ++i) {
    if (d[i] == 0.0) continue;
    throw Error(ErrorKind::kInput, fmt::format("D{} has more than five coefficients", number),
                matrices.files(), "calibrate without the rational, thin prism or tilted model");
  }
  d.resize(5, 0.0);
  CameraModel model;
  model.fx = k[0];
  model.fy = k[4];
  model.cx = k[2];
  model.cy = k[5];
  model.k1 = d[0];
  model.k2 = d[1];
  model.p1 = d[2];
  model.p2 = d[3];
  model.k3 = d[4];
  return model;
}

StereoRig rectified_rig(const std::vector<double>& p1, const std::vector<double>& p2) {
  StereoRig rig;
  for (auto [camera, p] : {std::pair{&rig.left, &p1}, std::pair{&rig.right, &p2}}) {
    camera->fx = (*p)[0];
    camera->fy = (*p)[5];
    camera->cx = (*p)[2];
    camera->cy = (*p)[6];
  }
  rig.right_from_left.translation = {p2[3] / p2[0] - p1[3] / p1[0], 0.0, 0.0};
  rig.rectified = rig.left == rig.right;
  return rig;
}

}  // namespace

bool is_opencv_yaml(const path& file) { return read_file(file).starts_with("%YAML:1.0"); }

StereoRig read_opencv_rig(const std::vector<path>& files) {
  const StoredMatrices matrices(files);
  StereoRig rig;
  if (matrices.find({"M1", "K1", "cameraMatrix1"}, 9).empty()) {
    rig = rectified_rig(matrices.require({"P1"}, 12), matrices.require({"P2"}, 12));
  } else {
    rig.left = camera_of(matrices, 1);
    rig.right = camera_of(matrices, 2);
    using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const std::vector<double> r = matrices.require({"R"}, 9);
    const std::vector<double> t = matrices.require({"T"}, 3);
    rig.right_from_left = rigid<frames::RightCamera, frames::Camera>(
        Eigen::Map<const Rows>(r.data()), {t[0], t[1], t[2]}, matrices.files());
  }
  check_rig(rig, matrices.files());
  return rig;
}

}  // namespace nadir
