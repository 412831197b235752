// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/photo.hpp"
#include "nadir/core/raster.hpp"

namespace nadir {

/// Where the scale of a map comes from.
enum class ScaleSource {
  kControlPoints,
  kPositions,         ///< GPS
  kRelativeAltitude,  ///< height above take-off taken as height above ground
  kPhotoPixelSize,    ///< PhotoSet::metres_per_photo_pixel
  kGivenPoses,
  kNone  ///< arbitrary: the map's "metres" are none
};
inline constexpr std::array<std::pair<ScaleSource, const char*>, 6> kScaleSourceNames{
    {{ScaleSource::kControlPoints, "control_points"},
     {ScaleSource::kPositions, "positions"},
     {ScaleSource::kRelativeAltitude, "relative_altitude"},
     {ScaleSource::kPhotoPixelSize, "photo_pixel_size"},
     {ScaleSource::kGivenPoses, "given_poses"},
     {ScaleSource::kNone, "none"}}};
std::string to_string(ScaleSource source);

/// What became of one photo.
struct PhotoReport {
  std::string name;
  bool registered = false;
  int observations = 0;                ///< of triangulated points
  double reprojection_px = 0.0;        ///< root mean square
  double ground_below_camera_m = 0.0;  ///< height of the camera above the surface
  double off_nadir_deg = 0.0;          ///< of the optical axis
  double gain = 1.0;                   ///< that its grey levels were multiplied with
  /// Adjusted minus given position, metres, the time offset taken out.
  std::optional<std::array<double, 3>> position_residual_m;
};

struct ControlPointReport {
  std::string name;
  int marks = 0;
  std::array<double, 3> residual_m{};  ///< adjusted minus given
  double reprojection_px = 0.0;
  bool outlier = false;  ///< does not agree with the others: its weight was taken back
};

/// The adjusted intrinsics of one camera.
struct CameraReport {
  std::string name;
  CameraModel model;
  double prior_focal_px = 0.0;
  double focal_sigma = 0.0;  ///< of ln f, after the adjustment
  double readout_s = 0.0;    ///< of its rolling shutter, first row to last; 0 = none or not known
  std::string focal_source;
};

/// Two photos that were compared.
struct PairReport {
  std::string first;
  std::string second;
  int matches = 0;
  int epipolar_inliers = 0;
  int homography_inliers = 0;
};

struct AdjustmentReport {
  std::vector<PhotoReport> photos;  ///< sorted by name
  int registered = 0;
  /// Photos that join each other, the largest group first; a photo that joins none is a group of
  /// its own. The map shows the first group.
  std::vector<std::vector<std::string>> components;
  std::vector<PairReport> pairs;
  std::vector<CameraReport> cameras;
  std::vector<ControlPointReport> control_points;
  int points = 0;
  int observations = 0;
  double reprojection_px = 0.0;  ///< root mean square of all observations that were kept
  /// Root mean square of the position residuals: x, y, z; and the horizontal norm.
  std::optional<std::array<double, 3>> position_rms_m;
  std::optional<double> position_residual_m;
  std::optional<double> time_offset_s;  ///< positions are those of this much later
  double ground_below_camera_m = 0.0;   ///< median
  double photo_pixel_m = 0.0;           ///< median size of a photo's pixel on the ground
  ScaleSource scale_source = ScaleSource::kNone;
  double scale_sigma = 0.0;        ///< relative; 0 where the scale is arbitrary
  double heading_sigma_deg = 0.0;  ///< 0 where the heading is arbitrary
  std::vector<std::string> warnings;
  /// Those of the warnings for which the map must not be relied on unseen.
  std::vector<std::string> doubts;
  std::vector<std::pair<std::string, double>> seconds;  ///< by stage, in order
};

/// The map and what it was made of. All rasters share size and geo-reference of the orthomosaic,
/// the surface has its own.
struct AerialMap {
  Orthomosaic ortho;  ///< RGB
  ElevationMap surface;
  Raster<std::uint8_t> view_count;  ///< photos that see the pixel, at most 255
  /// 0 = no map, 1 = seen from straight above by many; at most kProvisionalQuality where a photo
  /// was placed by its position alone.
  Raster<float> quality;
  /// Photo that gives the pixel its colour, index into `poses`; 65535 = none.
  Raster<std::uint16_t> source;
  std::vector<PhotoPose> poses;  ///< registered photos, sorted by name
  AdjustmentReport report;
};

inline constexpr float kProvisionalQuality = 0.1F;

}  // namespace nadir
