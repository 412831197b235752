// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "nadir/aerial_mapping/options.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/aerial_mapping/sfm/model.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// Standard deviations of the tilts that gimbals say, along the rows of the image (sideward) and
/// across them (forward, the pitch of a gimbal); 0 = not used.
struct GimbalSigma {
  double sideward_rad = 0.0;
  double forward_rad = 0.0;
};

/// Which terms an adjustment has; those of the priors follow from the photos and the options.
struct AdjustmentPlan {
  double loss_px = 1.0;       ///< where the errors of an observation begin to weigh less
  bool heavy_tail = false;    ///< Cauchy instead of Huber: for a rough start
  double flat_sigma_m = 0.0;  ///< holds the points near the ground; 0 = off
  bool hold_cameras = false;  ///< focal length and distortion stay as they are
  bool free_readout = false;  ///< of rolling shutters; else the poses keep what they flew in it
  bool use_positions = true;
  bool use_heading = false;  ///< the gimbals' yaw: only where nothing else gives the heading
  GimbalSigma gimbal_sigma;
  /// Sigma of a vertical optical axis where no gimbal says better, degrees; 0 = off.
  double nadir_sigma_deg = 0.0;
  double gauge_sigma_m = 0.0;      ///< holds all cameras softly where they are; 0 = off
  std::vector<std::uint8_t> held;  ///< a flag a photo: its pose stays; empty = none
  int max_iterations = 30;
  int cell_share = 3;  ///< points that a 1/16 x 1/12 cell of a photo needs
};

/// What is adjusted beside the model.
struct AdjustmentState {
  double time_offset_s = 0.0;
  Eigen::Vector3d position_bias = Eigen::Vector3d::Zero();  ///< with control points
  double ground = 0.0;                                      ///< mean height of the points
  std::vector<Eigen::Vector3d> control;  ///< adjusted control points, as in the set
  std::vector<std::uint8_t> control_known;
  int iterations = 0;
};

/// Ground velocity of each photo (m/s) by its neighbours in time of the same camera; zero where
/// unknown.
std::vector<Eigen::Vector3d> velocities_of(const std::vector<MappingPhoto>& photos);

/// What the gimbals of the known photos leave of an adjustment's attitudes: 1.48 medians of the
/// magnitudes; nothing where fewer than `fewest` have said something.
std::optional<GimbalSigma> gimbal_residuals(const Model& model, const PhotoSet& set, int fewest);

/// Least squares over poses, cameras and points: equations 2 to 7 of docs/aerial-mapping.md. Only
/// known poses and valid landmarks take part. Throws Stopped between two iterations; nothing has
/// changed then.
void adjust(Model& model, AdjustmentState& state, const PhotoSet& set,
            const AerialMappingOptions& options, const AdjustmentPlan& plan,
            const StopToken& stop = {});

/// Standard deviation of ln f of each camera, from the covariance of the adjustment of a thinned
/// set of points; 0 where it cannot be had.
std::vector<double> focal_sigmas(const Model& model, const AdjustmentState& state,
                                 const PhotoSet& set, const AerialMappingOptions& options,
                                 const AdjustmentPlan& plan);

}  // namespace nadir::aerial
