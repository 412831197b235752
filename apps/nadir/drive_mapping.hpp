// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/drive_options.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/ground_mapping/mapper.hpp"
#include "nadir/ground_mapping/self_check.hpp"

namespace nadir::cli {

/// What became of one frame of a drive.
struct MappedFrame {
  int number = 0;
  Stamp stamp;
  std::optional<OdomPose3> odom_from_robot;  ///< without it the frame was left out
  FrameStatistics statistics;
  double decode_ms = 0.0;
};

/// A local map and when it was rendered.
struct RenderedMap {
  int number = 0;  ///< of the last frame in it
  LocalMap map;
  double render_ms = 0.0;
};

/// Maps a drive frame by frame; the frames at which a local map is due are known beforehand.
class DriveMapping {
 public:
  struct Options {
    GroundMappingOptions mapping;
    RenderOptions local_map;
    Spacing every;
    bool self_check = false;
  };

  /// `drive` must outlive it. Throws Error (input) where the drive has no poses, with what is
  /// needed; as GroundMapper does.
  DriveMapping(const Drive& drive, const Options& options);

  /// Positions in drive.frames after which a local map is due; the last one is the last frame with
  /// a pose.
  const std::vector<std::size_t>& due() const { return due_; }

  /// Takes the frames up to and with this position, calling `progress(frames done)` after each, and
  /// renders; nothing where no frame so far had a point. Positions must increase. Throws
  /// Stopped, and Error (input) where the poses plainly do not fit the images.
  std::optional<RenderedMap> map_at(std::size_t position,
                                    const std::function<void(int)>& progress = {});

  const std::vector<MappedFrame>& frames() const { return frames_; }
  PoseFit pose_fit() const { return mapper_.pose_fit(); }
  /// All that was seen within 18 m around the last pose, walls and hedges included; nothing where
  /// the grid cannot hold that, or before any frame.
  std::optional<LocalMap> last_square() const;
  /// Of odd and even frames; only with self_check, after two frames.
  std::optional<MapComparison> comparison() const;
  /// What is worth a warning, each once with how often it was so; the doubts are apart.
  std::vector<std::string> warnings() const;
  /// Why the local maps must not be relied on unseen, `compared` as comparison() gave it; nothing
  /// where they may.
  std::vector<std::string> doubts(const std::optional<MapComparison>& compared = {}) const;

 private:
  void take(const DriveFrame& frame);
  void plan(const Spacing& every);
  void refuse_wrong_poses() const;

  const Drive& drive_;
  Options options_;
  std::vector<std::size_t> due_;
  GroundMapper mapper_;
  std::unique_ptr<OddEvenCheck> check_;
  std::size_t next_ = 0;
  bool any_ = false;  ///< a frame reached the map
  std::vector<MappedFrame> frames_;
  std::vector<std::string> notes_;  ///< of reading
};

/// The local map as the localizer takes it.
Frame to_frame(const LocalMap& map);

}  // namespace nadir::cli
