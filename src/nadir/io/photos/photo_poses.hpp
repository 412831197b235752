// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "nadir/core/photo.hpp"
#include "nadir/io/maps/metric_frame.hpp"

namespace nadir {

/// The frame that imported poses are given in.
enum class PhotoPoseFrame {
  kModel,        ///< arbitrary origin, axes and scale
  kTopocentric,  ///< east, north, up of a reference point
  kGeocentric,   ///< earth-centred
  kMap           ///< that of `crs`
};

/// Poses of photos that another program found; cameras with pixels of the size that it worked at.
struct ImportedPoses {
  std::vector<PhotoPose> poses;
  PhotoPoseFrame frame = PhotoPoseFrame::kModel;
  GeodeticPosition reference;  ///< of kTopocentric
  std::string crs;             ///< of kMap; may be empty: local metres
  std::vector<std::string> warnings;
};

/// Reads, by what is there: a folder with a COLMAP text model (cameras.txt, images.txt), OpenSfM's
/// reconstruction.json (its largest reconstruction), Metashape's cameras.xml, or the poses that
/// `write_photo_poses` wrote. Throws Error (input), with file and line or item, for anything else
/// and for camera models that the pinhole with Brown-Conrady distortion cannot express.
ImportedPoses read_photo_poses(const std::filesystem::path& path);

/// Earth-bound poses in the map frame; throws Error (processing) for those of kModel.
std::vector<PhotoPose> in_map_frame(const ImportedPoses& imported, const MetricFrame& frame);

/// JSON: reference system, cameras, and a position and quaternion (x, y, z, w) of map_from_camera
/// for every photo. Atomic. Throws Error (processing).
void write_photo_poses(const std::filesystem::path& path, std::span<const PhotoPose> poses,
                       const std::string& crs);

/// The same camera for photos of another size.
CameraModel resized(const CameraModel& camera, int width, int height);

}  // namespace nadir
