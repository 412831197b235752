// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/options.hpp"

namespace nadir {

void declare(OptionTable& table, AerialMappingOptions& options) {
  const std::string stage = "aerial_mapping.";
  table.number(stage + "resolution_m", options.resolution_m, {0.005, 10.0},
               "Metres per pixel of the orthomosaic.", "paper, section II");
  table.integer(stage + "max_image_px", options.max_image_px, {400, 6000},
                "Longer side of the photos at their working size, pixels.");
  table.integer(stage + "features_per_photo", options.features_per_photo, {500, 20000},
                "How many SIFT features of a photo are kept at most.");
  table.integer(stage + "gps_neighbours", options.gps_neighbours, {4, 30},
                "With how many of the nearest photos by position a photo is matched.");
  table.integer(stage + "min_pair_inliers", options.min_pair_inliers, {12, 100},
                "Smallest number of geometrically consistent matches that joins two photos.");
  table.number(stage + "gps_sigma_m", options.gps_sigma_m, {0.005, 100.0},
               "Horizontal standard deviation of a position that does not say its own, metres; "
               "three times that vertically.",
               "consumer GPS, within one flight");
  table.number(stage + "gimbal_sigma_deg", options.gimbal_sigma_deg, {0.0, 20.0},
               "Standard deviation of the gimbal's tilts, degrees, at most: less where they agree "
               "with the block; 0 = not used.");
  table.number(stage + "relative_altitude_sigma_m", options.relative_altitude_sigma_m, {0.0, 100.0},
               "Standard deviation of the height above take-off as height above ground, metres, "
               "once for the block; 0 = not used.");
  table.number(stage + "distortion_prior_sigma", options.distortion_prior_sigma, {0.0, 1.0},
               "Standard deviation of k1 and k2 around zero; 0 = no distortion.");
  table.flag(stage + "free_focal", options.free_focal,
             "Adjust the focal length without its prior: only for oblique photos or with control "
             "points.");
  table.flag(stage + "refine_given_poses", options.refine_given_poses,
             "Adjust poses that are given with the photos instead of taking them as they are.");
  table.choice<SurfaceKind>(
      stage + "surface", options.surface, kSurfaceKindNames,
      "Ground that the photos are projected on: triangulated features, or one plane.");
  table.number(stage + "max_off_nadir_deg", options.max_off_nadir_deg, {5.0, 80.0},
               "Largest angle between a used ray and the vertical, degrees; wider by the tilt of "
               "the block where its photos are oblique.");
  table.number(stage + "max_surface_distance_m", options.max_surface_distance_m, {0.1, 1000.0},
               "Farthest from a triangulated point that a pixel of the map is called valid, "
               "metres.");
  table.integer(stage + "min_views", options.min_views, {1, 10},
                "Smallest number of photos that must see a valid pixel.");
  table.choice<BlendKind>(stage + "blend", options.blend, kBlendKindNames,
                          "How photos are joined at the seams.");
  table.integer(stage + "bands", options.bands, {1, 8},
                "Number of frequency bands of the multi-band blending.");
  table.number(stage + "gain_prior_sigma", options.gain_prior_sigma, {0.001, 1.0},
               "Standard deviation of the logarithm of a photo's gain around what its exposure "
               "says.");
  table.number(stage + "max_megapixels", options.max_megapixels, {0.1, 100000.0},
               "Largest orthomosaic that is begun, millions of pixels.");
}

}  // namespace nadir
