// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/trajectory.hpp"

namespace nadir {

/// A site: the sequence folder of docs/formats.md, opened. `sequence.yaml` has been read and every
/// file that it names exists; images are read when asked for.
struct Sequence {
  struct LocalMap {
    int number = 0;  ///< the frame number that `--frame` and `--frames` take
    Stamp stamp;
    std::filesystem::path image;
    /// Heights of the same place, where the site has them.
    std::optional<std::filesystem::path> elevation = std::nullopt;
  };

  std::filesystem::path folder;
  std::string name;
  std::optional<std::filesystem::path> map;      ///< the global orthomosaic, where the site has one
  std::optional<std::filesystem::path> surface;  ///< heights of the map: a surface model
  std::vector<LocalMap> local_maps;              ///< by increasing stamp and number
  std::optional<Odometry> odometry;
  std::optional<Trajectory> truth;                   ///< map_from_robot
  std::optional<std::filesystem::path> calibration;  ///< handed on as it is, never read here
};

/// Opens a site. Throws Error (input) that names file and line: no sequence.yaml, unknown key,
/// missing file, a path that leaves the folder, no local map, stamps or numbers that do not
/// increase.
Sequence read_sequence(const std::filesystem::path& folder);

/// Reads one frame: its local map, its heights where it has them, and the odometry pose of its
/// stamp, where there is one. Between two samples at most 0.5 s apart the pose is interpolated;
/// otherwise the nearest sample within 0.01 s is taken. Throws Error (input) as read_orthomosaic
/// and read_elevation_map do.
Frame read_frame(const Sequence& sequence, const Sequence::LocalMap& local_map);

/// Writes a site file by file; `finish` writes sequence.yaml last, so that a folder without it is
/// unfinished: an older sequence.yaml is removed at the start. No single file is left half-written.
/// Throws Error (processing) where a file cannot be written, or a local map does not follow the one
/// before in number and stamp.
class SequenceWriter {
 public:
  SequenceWriter(std::filesystem::path folder, std::string name);
  void write_map(const Orthomosaic& map);
  void write_surface(const ElevationMap& surface);
  void write_local_map(int number, Stamp stamp, const Orthomosaic& local,
                       const std::optional<ElevationMap>& elevation = std::nullopt);
  void write_odometry(const Odometry& odometry);
  void write_truth(const Trajectory& truth);
  /// Copies the file into the site.
  void write_calibration(const std::filesystem::path& source);
  void finish();

 private:
  Sequence sequence_;
};

}  // namespace nadir
