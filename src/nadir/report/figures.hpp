// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/frames.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/core/score_volume.hpp"
#include "nadir/core/trajectory.hpp"

namespace nadir {

/// A figure: 8-bit RGB. The same input gives the same bytes.
using Figure = Raster<std::uint8_t>;

struct Track {
  std::string name;  ///< for the legend
  Trajectory trajectory;
};

/// What a figure shows around its tracks.
struct Surroundings {
  bool whole_map = false;   ///< else the part around the tracks
  bool north_arrow = true;  ///< false where the y axis is not north, as in the odometry's frame
};

/// The map with tracks on it (the paper's Fig. 9), cropped to what is of interest; legend, scale
/// bar, north arrow. The first track is drawn last, on top; those beneath are wider. Poses that are
/// not finite interrupt their track. Every figure has its axes in metres of the map frame, y up.
Figure draw_trajectories(const Orthomosaic& map, const std::vector<Track>& tracks,
                         const std::string& title, const Surroundings& surroundings = {});

struct Swarm {
  std::string label;  ///< e.g. "frame 170"
  std::vector<Pose2> particles;
  std::vector<double> weights;  ///< same length; sum 1
  Pose2 estimate;
  std::optional<Pose2> truth;
};

/// The particle swarm at several instants on one map (the paper's Fig. 8), with an inset per
/// instant that is large enough to see the cloud: dots with their headings, coloured by weight
/// relative to the swarm's largest; estimate and truth as arrows.
Figure draw_swarms(const Orthomosaic& map, const std::vector<Swarm>& swarms,
                   const std::string& title);

/// The outline of a local map at a pose: width and height in metres of the square seen, in the
/// robot frame's geo-reference.
struct Footprint {
  Pose2 map_from_robot;
  GeoReference geo;  ///< of the local map, robot frame
  int width = 0;     ///< pixels
  int height = 0;
};

struct HeatMap {
  const ScoreVolume* volume = nullptr;  ///< best over headings is drawn
  Footprint found;                      ///< white
  std::optional<Footprint> truth;       ///< blue
  bool whole_map = false;               ///< no red search window where the whole map was searched
  std::string title;
};

/// The score heat map over the map with search window (red), truth (blue) and found place (white)
/// as boxes, colour bar, scale bar (the paper's Figs. 6 and 7); beside it the local map, the map
/// patch under the found pose, and both as a checkerboard. A box is the outline of the local map;
/// its wedge looks ahead. Undefined scores (NaN) leave the map bare; a null or empty volume is said
/// so.
Figure draw_heat_map(const Orthomosaic& map, const Orthomosaic& local, const HeatMap& heat_map);

/// A local map and where it was found.
struct Comparison {
  std::string label;  ///< e.g. "frame 170"
  Orthomosaic local;
  Pose2 map_from_robot;
};

/// Local maps beside what the map shows at their poses, and both as a checkerboard: a row each,
/// upright in the robot's frame, with an arrow to the north and a scale bar.
Figure draw_comparisons(const Orthomosaic& map, const std::vector<Comparison>& comparisons,
                        const std::string& title);

/// What a local map shows of the ground.
struct SeenGround {
  Footprint outline;
  Raster<std::uint8_t> valid;  ///< cells that tile the outline, row 0 its top; 0: mostly holes
};

/// Of a local map at the pose of its robot, in cells of 4 x 4 pixels (less at the rims), valid
/// where at least half of the pixels are. The pose may be NaN.
SeenGround seen_ground(const Orthomosaic& local, const Pose2& map_from_robot);

/// How many of the local maps show each place, over the map: what they have seen at their poses,
/// holes left out; colour bar, scale bar, north arrow. NaN poses are not drawn.
Figure draw_coverage(const Orthomosaic& map, const std::vector<SeenGround>& local_maps,
                     const std::string& title);

/// One curve of a time plot.
struct Curve {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;  ///< same length as x; NaN leaves a gap
};

/// What lies between two bounds over time, as two standard deviations do.
struct Band {
  std::string name;
  std::vector<double> x;
  std::vector<double> low;   ///< same length as x; NaN leaves a gap
  std::vector<double> high;  ///< same length as x
};

/// Stacked panels that share their x axis: error, yaw error, N_eff, …
struct Panel {
  std::string y_label;
  std::vector<Curve> curves;
  std::vector<Band> bands = {};  ///< drawn below the curves
};
/// Each panel has its own y axis, with its label at the left above it and its legend at the right.
Figure draw_panels(const std::vector<Panel>& panels, const std::string& x_label,
                   const std::string& title);

/// The frames and raster conventions of docs/conventions.md.
Figure draw_conventions();

}  // namespace nadir
