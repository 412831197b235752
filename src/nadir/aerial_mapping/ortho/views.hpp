// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/ortho/ground.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/core/camera.hpp"
#include "nadir/core/photo.hpp"
#include "nadir/core/rolling_shutter.hpp"

namespace nadir::aerial {

/// A photo with its pose, as the orthomosaic needs it.
struct View {
  std::size_t photo = 0;  ///< number in the photo set
  CameraModel camera;
  Eigen::Matrix3d camera_from_map = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the middle row
  Eigen::Vector3d flown = Eigen::Vector3d::Zero();   ///< in the readout (rolling_shutter.hpp)
  std::array<float, 3> gain{1.0F, 1.0F, 1.0F};       ///< of red, green, blue
  /// The camera's pixels are shrunk by this before they are sampled, so that one is about as large
  /// as a pixel of the map.
  double shrink = 1.0;
  bool provisional = false;
  bool blurred = false;  ///< gives colour only where no sharp view does

  /// Where the view shows a point; nothing behind the camera.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const {
    return project_row_by_row(camera, camera_from_map, point - centre, flown);
  }
};

/// The pose of a view, in the frame of the views.
PhotoPose pose_of(const View& view, const std::string& name);

/// Which part of a photo is used.
struct ViewLimits {
  double max_off_nadir_rad = 0.61;
  double max_radius = 0.9;  ///< of half the diagonal
};

/// How a view sees a point of the ground.
struct Sight {
  double u = 0.0;
  double v = 0.0;
  double off_nadir_rad = 0.0;
  double edge = 0.0;  ///< distance from the border, in half widths; 0 = at the border
};

/// Nothing where the view does not see the point or may not be used there. Occlusion is not looked
/// at.
std::optional<Sight> sight_of(const View& view, const ViewLimits& limits,
                              const Eigen::Vector3d& point);

/// What stands between a point of the ground and a view.
enum class Occlusion { kNone, kByARamp, kByGround };

/// A ramp (Ground::ramp_m) says how far the top of a step may reach, not that it does.
Occlusion occlusion_of(const View& view, const Ground& ground, const Eigen::Vector3d& point);

/// Pixels of the views at the size they are sampled at, at most `budget` bytes of them at a time.
class ViewImages {
 public:
  ViewImages(const PhotoSet& set, const std::vector<View>& views, std::size_t budget)
      : set_(set), views_(views), budget_(budget) {}

  /// RGB, shrunk; may be called from several threads.
  std::shared_ptr<const cv::Mat> get(std::size_t view);

 private:
  struct Entry {
    std::shared_ptr<const cv::Mat> image;
    std::uint64_t used = 0;
  };
  const PhotoSet& set_;
  const std::vector<View>& views_;
  std::size_t budget_;
  std::size_t held_ = 0;
  std::uint64_t clock_ = 0;
  std::map<std::size_t, Entry> entries_;
  std::mutex mutex_;
};

}  // namespace nadir::aerial
