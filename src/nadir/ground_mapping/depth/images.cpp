// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/depth/images.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"

namespace nadir::ground {
namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

cv::Mat view_of(const Raster<std::uint8_t>& raster) {
  if (raster.empty()) return {};
  return cv::_InputArray(raster.values()).getMat().reshape(raster.channels(), raster.height());
}

Raster<std::uint8_t> raster_of(const cv::Mat& image) {
  Raster<std::uint8_t> raster(image.cols, image.rows, 0, image.channels());
  for (int row = 0; row < image.rows; ++row) {
    const auto* from = image.ptr<std::uint8_t>(row);
    std::copy(from, from + raster.row(row).size(), raster.row(row).begin());
  }
  return raster;
}

cv::Mat grey_of(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

CameraModel scaled(const CameraModel& camera, double scale) {
  CameraModel result = camera;
  result.width = static_cast<int>(std::lround(camera.width * scale));
  result.height = static_cast<int>(std::lround(camera.height * scale));
  result.fx = camera.fx * scale;
  result.fy = camera.fy * scale;
  // (0, 0) is the centre of the first pixel: half a pixel in from the corner that stays in place.
  result.cx = (camera.cx + 0.5) * scale - 0.5;
  result.cy = (camera.cy + 0.5) * scale - 0.5;
  return result;
}

void check_image(const Raster<std::uint8_t>& image, const CameraModel& camera,
                 const std::string& name) {
  if (image.width() != camera.width || image.height() != camera.height) {
    throw Error(ErrorKind::kInput,
                "the " + name + " image has " + size_text(image.width(), image.height()) +
                    " pixels, its calibration says " + size_text(camera.width, camera.height),
                {}, "give the calibration of these images; a scaled image needs scaled intrinsics");
  }
  if (image.channels() != 1 && image.channels() != 3) {
    throw Error(ErrorKind::kInput,
                "the " + name + " image has " + std::to_string(image.channels()) + " channels", {},
                "convert it to grey or RGB");
  }
}

void check_camera(const CameraModel& camera, const std::string& name) {
  const bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) &&
                      std::isfinite(camera.cx) && std::isfinite(camera.cy);
  if (!finite || camera.fx <= 0.0 || camera.fy <= 0.0) {
    throw Error(ErrorKind::kInput,
                "the " + name + " camera has the focal lengths " + to_text(camera.fx) + " and " +
                    to_text(camera.fy) + " px",
                {}, "both must be above 0: check the calibration");
  }
  if (camera.width < 16 || camera.height < 16) {
    throw Error(ErrorKind::kInput,
                "the " + name + " camera has " + size_text(camera.width, camera.height) + " pixels",
                {}, "at least 16 x 16 are needed: check the calibration");
  }
}

}  // namespace nadir::ground
