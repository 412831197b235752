// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "nadir/core/camera.hpp"
#include "nadir/core/raster.hpp"

namespace nadir::ground {

/// The pixels of a raster as OpenCV sees them, without a copy: not to be written to.
cv::Mat view_of(const Raster<std::uint8_t>& raster);

Raster<std::uint8_t> raster_of(const cv::Mat& image);

/// Grey of a grey or RGB image.
cv::Mat grey_of(const cv::Mat& image);

/// The camera whose image is scaled by `scale`.
CameraModel scaled(const CameraModel& camera, double scale);

/// Throws Error (input) where the image is not of the camera's size, or neither grey nor RGB.
void check_image(const Raster<std::uint8_t>& image, const CameraModel& camera,
                 const std::string& name);

/// Throws Error (input) for a camera without size or focal length.
void check_camera(const CameraModel& camera, const std::string& name);

}  // namespace nadir::ground
