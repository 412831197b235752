// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <string_view>

#include "nadir/io/detail/yaml_file.hpp"
#include "nadir/io/drives/detail/camera_yaml.hpp"
#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/drives/detail/kitti_calibration.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

constexpr std::string_view kOpencvYaml = "%YAML:1.0";

struct StoredMatrix {
  std::vector<double> values;  ///< by rows
  std::string where;
};

/// The numbers of a matrix, by rows.
std::vector<double> values_of(const YAML::Node& node, const std::string& name, const path& file) {
  constexpr int kLargest = 1000;  // a calibration has none above 4 x 4 or 14 x 1
  const std::string where = place_of(node, file);
  const auto side = [&](const char* key) {
    return checked_integer(number_in_file(text_at(node, key, file), key, where), key, where, 1,
                           kLargest);
  };
  const auto count =
      static_cast<std::size_t>(side("rows")) * static_cast<std::size_t>(side("cols"));
  std::vector<double> values = numbers_in(node["data"], name, file);
  if (values.size() != count) {
    throw Error(ErrorKind::kInput,
                fmt::format("the matrix '{}' does not hold rows x cols numbers", name), where,
                "give the calibration as OpenCV wrote it");
  }
  return values;
}

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
      const std::vector<double>& values = found->second.values;
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
  /// By yaml-cpp: OpenCV's own parser goes round for ever, ends the stack or makes room for
  /// matrices that are not there. Its files are YAML but for the first line.
  void read(const path& file) {
    std::string text = read_file(file);
    if (!text.starts_with(kOpencvYaml)) {
      throw input_error(file, "does not begin with %YAML:1.0", "give the YAML that OpenCV wrote");
    }
    text.front() = '#';
    reading_yaml(text, file, ErrorKind::kInput, [&](const YAML::Node& root) {
      for (const auto& entry : root) {
        const YAML::Node& node = entry.second;
        if (!entry.first || !node.IsMap() || !node["data"] || !node["data"].IsSequence()) continue;
        const std::string name = entry.first.Scalar();
        matrices_[name] = {values_of(node, name, file), place_of(node, file)};
      }
    });
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

bool is_opencv_yaml(const path& file) { return read_file(file).starts_with(kOpencvYaml); }

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
