// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/simulated_drive.hpp"
#include "nadir/simulation/simulated_flight.hpp"

namespace nadir {

void declare(OptionTable& table, FlightOptions& options) {
  const std::string part = "simulation.flight_";
  table.number(part + "height_m", options.height_m, {15.0, 400.0},
               "Height of the drone's camera above the ground, metres.");
  table.number(part + "forward_overlap", options.forward_overlap, {0.0, 0.95},
               "Overlap of consecutive photos of a strip.");
  table.number(part + "side_overlap", options.side_overlap, {0.0, 0.95},
               "Overlap of neighbouring strips.");
  table.number(part + "speed_m_s", options.speed_m_s, {0.1, 30.0}, "Speed of the drone, m/s.");
  table.integer(part + "image_width", options.image_width, {64.0, 8192.0},
                "Width of a photo, pixels.");
  table.integer(part + "image_height", options.image_height, {64.0, 8192.0},
                "Height of a photo, pixels.");
  table.number(part + "focal_px", options.focal_px, {50.0, 20000.0},
               "Focal length of the drone's camera, pixels.");
  table.number(part + "k1", options.k1, {-0.3, 0.3}, "First radial coefficient of its distortion.");
  table.number(part + "k2", options.k2, {-0.3, 0.3}, "Second radial coefficient.");
  table.number(part + "tilt_deg", options.tilt_deg, {0.0, 30.0},
               "Standard deviation of the tilt that the gimbal leaves, degrees.");
  table.number(part + "readout_s", options.readout_s, {0.0, 0.2},
               "Readout time of the rolling shutter, seconds; 0 = global shutter.");
  table.number(part + "vignetting", options.vignetting, {0.0, 0.9},
               "Loss of light in the corners of a photo.");
  table.number(part + "blur_px", options.blur_px, {0.0, 5.0},
               "Standard deviation of the blur, pixels.");
  table.number(part + "noise_grey", options.noise_grey, {0.0, 50.0},
               "Standard deviation of the noise, grey levels of 255.");
  table.number(part + "exposure_drift", options.exposure_drift, {0.0, 0.5},
               "Standard deviation of the exposure between photos, share.");
  table.number(part + "white_balance_drift", options.white_balance_drift, {0.0, 0.3},
               "Standard deviation of red and blue against green, share.");
  table.flag(part + "rtk", options.rtk, "Positions by RTK rather than a consumer's receiver.");
  table.number(part + "rtk_sigma_m", options.rtk_sigma_m, {0.0, 1.0},
               "Standard deviation of an RTK position, metres; height 1.5 times.");
  table.number(part + "gps_bias_m", options.gps_bias_m, {0.0, 20.0},
               "Standard deviation of the bias of a flight without RTK, metres; height twice.");
  table.number(part + "gps_noise_m", options.gps_noise_m, {0.0, 20.0},
               "Standard deviation of a position without RTK, metres; height twice.");
  table.number(part + "gps_lag_s", options.gps_lag_s, {-1.0, 1.0},
               "How old a position is when the photo is taken, seconds.");
  table.number(part + "barometer_m", options.barometer_m, {0.0, 20.0},
               "Standard deviation of the relative altitude, metres.");
  table.number(part + "compass_bias_deg", options.compass_bias_deg, {0.0, 45.0},
               "Standard deviation of the compass's bias of a flight, degrees.");
  table.number(part + "compass_noise_deg", options.compass_noise_deg, {0.0, 45.0},
               "Standard deviation of a heading, degrees.");
}

void declare(OptionTable& table, RouteOptions& options) {
  const std::string part = "simulation.drive_";
  table.integer(part + "route", options.route, {0.0, 100.0}, "Which of the world's routes.");
  table.integer(part + "frames", options.frames, {0.0, 5000.0},
                "Frames of the drive; 0 = to the end of the route.");
  table.number(part + "step_m", options.step_m, {0.05, 20.0}, "Travel between frames, metres.");
  table.number(part + "speed_m_s", options.speed_m_s, {0.05, 30.0}, "Speed of the robot, m/s.");
  table.number(part + "start_m", options.start_m, {0.0, 1000.0},
               "Where on the route it starts, metres.");
  table.number(
      part + "lane_offset_m", options.lane_offset_m, {-10.0, 10.0},
      "Metres to the left of the middle of the road; negative = right. Not for a draped map.");
  table.number(part + "stamp_jitter_s", options.stamp_jitter_s, {0.0, 0.1},
               "Largest error of a stamp, seconds.");
  table.number(part + "shake_deg", options.shake_deg, {0.0, 5.0},
               "Standard deviation of pitch and roll against the ground, degrees.");
  table.number(part + "odometry_scale", options.odometry_scale, {-0.5, 0.5},
               "Error of the odometry's scale, share of the distance.");
  table.number(part + "odometry_noise", options.odometry_noise, {0.0, 1.0},
               "Standard deviation of the odometry, metres per root metre.");
  table.number(part + "odometry_yaw_deg_per_m", options.odometry_yaw_deg_per_m, {-5.0, 5.0},
               "Steady drift of the odometry's heading, degrees per metre.");
  table.number(part + "odometry_yaw_noise_deg", options.odometry_yaw_noise_deg, {0.0, 10.0},
               "Standard deviation of its heading, degrees per root metre.");
}

void declare(OptionTable& table, StereoOptions& options) {
  const std::string part = "simulation.stereo_";
  table.integer(part + "image_width", options.image_width, {64.0, 4096.0},
                "Width of a stereo image, pixels.");
  table.integer(part + "image_height", options.image_height, {64.0, 4096.0},
                "Height of a stereo image, pixels.");
  table.number(part + "focal_px", options.focal_px, {50.0, 10000.0},
               "Focal length of the stereo cameras, pixels.");
  table.number(part + "baseline_m", options.baseline_m, {0.02, 2.0}, "Their distance, metres.");
  table.number(part + "mast_m", options.mast_m, {0.2, 5.0},
               "Height of the cameras above the robot's ground, metres.");
  table.number(part + "pitch_deg", options.pitch_deg, {-30.0, 90.0},
               "How far they look down, degrees.");
  table.number(part + "blur_px", options.blur_px, {0.0, 5.0},
               "Standard deviation of the blur, pixels.");
  table.number(part + "noise_grey", options.noise_grey, {0.0, 50.0},
               "Standard deviation of the noise, grey levels of 255.");
  table.number(part + "vignetting", options.vignetting, {0.0, 0.9},
               "Loss of light in the corners.");
  table.number(part + "exposure_drift", options.exposure_drift, {0.0, 0.5},
               "Standard deviation of the exposure between frames, share.");
  table.number(part + "brightness", options.brightness, {0.1, 3.0},
               "Exposure against that of the drone's camera.");
  table.flag(part + "colour", options.colour, "Colour cameras; else grey ones.");
}

void declare(OptionTable& table, LidarOptions& options) {
  const std::string part = "simulation.lidar_";
  table.integer(part + "rings", options.rings, {1.0, 256.0}, "Rings of the lidar.");
  table.number(part + "lowest_deg", options.lowest_deg, {-90.0, 90.0},
               "Elevation of the lowest ring, degrees.");
  table.number(part + "highest_deg", options.highest_deg, {-90.0, 90.0},
               "Elevation of the highest ring, degrees.");
  table.integer(part + "columns", options.columns, {8.0, 8192.0}, "Points of a ring.");
  table.number(part + "mast_m", options.mast_m, {0.2, 5.0},
               "Height of the lidar above the robot's ground, metres.");
  table.number(part + "range_noise_m", options.range_noise_m, {0.0, 1.0},
               "Standard deviation of a range, metres.");
  table.number(part + "dropout", options.dropout, {0.0, 1.0},
               "Share of the points that do not come back.");
  table.number(part + "shortest_m", options.shortest_m, {0.0, 20.0}, "Shortest range, metres.");
  table.number(part + "longest_m", options.longest_m, {1.0, 500.0}, "Longest range, metres.");
  table.number(part + "sweep_s", options.sweep_s, {0.0, 1.0},
               "Time of a turn, seconds; 0 = the scan is freed of the robot's motion.");
  table.flag(part + "camera", options.camera, "A camera that looks forward beside the lidar.");
}

}  // namespace nadir
