// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>

#include "nadir/core/options.hpp"

namespace nadir {

/// What the photos are projected on.
enum class SurfaceKind { kSparse, kPlane };
inline constexpr std::array<std::pair<SurfaceKind, const char*>, 2> kSurfaceKindNames{
    {{SurfaceKind::kSparse, "sparse"}, {SurfaceKind::kPlane, "plane"}}};

/// How photos are joined where they meet.
enum class BlendKind { kMultiBand, kFeather, kNone };
inline constexpr std::array<std::pair<BlendKind, const char*>, 3> kBlendKindNames{
    {{BlendKind::kMultiBand, "multiband"},
     {BlendKind::kFeather, "feather"},
     {BlendKind::kNone, "none"}}};

/// Each one is declared, with unit, range, meaning and source, in options.cpp and
/// docs/options.md.
struct AerialMappingOptions {
  double resolution_m = 0.10;
  int max_image_px = 2000;
  int features_per_photo = 6000;
  int gps_neighbours = 10;
  int min_pair_inliers = 20;
  double gps_sigma_m = 1.5;
  double gimbal_sigma_deg = 1.5;
  double relative_altitude_sigma_m = 3.0;
  double distortion_prior_sigma = 0.05;
  bool free_focal = false;
  bool refine_given_poses = false;
  SurfaceKind surface = SurfaceKind::kSparse;
  double max_off_nadir_deg = 35.0;
  double max_surface_distance_m = 4.0;
  int min_views = 2;
  BlendKind blend = BlendKind::kMultiBand;
  int bands = 5;
  double gain_prior_sigma = 0.1;
  double max_megapixels = 400.0;
};

void declare(OptionTable& table, AerialMappingOptions& options);

}  // namespace nadir
