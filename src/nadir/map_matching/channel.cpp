// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/channel.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nadir/core/error.hpp"
#include "nadir/map_matching/resample.hpp"

namespace nadir {
namespace {

/// Grey value that stands for "as bright as its surroundings" in the high-pass.
constexpr float kHighPassOffset = 128.0F;

// ITU-R BT.601 luma.
constexpr float kRed = 0.299F;
constexpr float kGreen = 0.587F;
constexpr float kBlue = 0.114F;

void check(const Orthomosaic& orthomosaic, const std::string& what) {
  if (orthomosaic.image.empty()) throw Error(ErrorKind::kInput, what + " is an empty image");
  if (!orthomosaic.image.same_size(orthomosaic.valid)) {
    throw Error(ErrorKind::kInput,
                what + " has an image of " + std::to_string(orthomosaic.width()) + " x " +
                    std::to_string(orthomosaic.height()) + " px, but a mask of " +
                    std::to_string(orthomosaic.valid.width()) + " x " +
                    std::to_string(orthomosaic.valid.height()) + " px");
  }
  if (!(orthomosaic.geo.resolution > 0.0) || !std::isfinite(orthomosaic.geo.resolution)) {
    throw Error(ErrorKind::kInput, what + " has no positive resolution");
  }
}

GreyImage to_grey(const Orthomosaic& orthomosaic) {
  const Raster<std::uint8_t>& image = orthomosaic.image;
  GreyImage grey{Raster<float>(image.width(), image.height()),
                 Raster<std::uint8_t>(image.width(), image.height()), orthomosaic.geo};
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      if (orthomosaic.valid.at(column, row) == 0) continue;
      grey.valid.at(column, row) = 1;
      grey.value.at(column, row) = image.channels() >= 3
                                       ? kRed * static_cast<float>(image.at(column, row, 0)) +
                                             kGreen * static_cast<float>(image.at(column, row, 1)) +
                                             kBlue * static_cast<float>(image.at(column, row, 2))
                                       : static_cast<float>(image.at(column, row));
    }
  }
  return grey;
}

/// Subtracts the Gaussian mean of the valid surroundings: G*(I m) / G*m (normalised convolution,
/// Knutsson and Westin, 1993), so that neither holes nor borders leave an edge.
void apply_high_pass(GreyImage& grey, double sigma_px) {
  const int width = grey.value.width();
  const int height = grey.value.height();
  const cv::Mat value(height, width, CV_32F, grey.value.values().data());
  cv::Mat mask;
  cv::Mat(height, width, CV_8U, grey.valid.values().data()).convertTo(mask, CV_32F);
  cv::Mat smooth_value;
  cv::Mat smooth_mask;
  cv::GaussianBlur(value, smooth_value, {}, sigma_px, sigma_px, cv::BORDER_CONSTANT);
  cv::GaussianBlur(mask, smooth_mask, {}, sigma_px, sigma_px, cv::BORDER_CONSTANT);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      if (grey.valid.at(column, row) == 0) continue;
      const float mean =
          smooth_value.at<float>(row, column) / std::max(smooth_mask.at<float>(row, column), 1e-6F);
      grey.value.at(column, row) += kHighPassOffset - mean;
    }
  }
}

}  // namespace

ChannelImage make_channel(const Orthomosaic& orthomosaic, const MatchingOptions& options,
                          const std::string& what) {
  check(orthomosaic, what);
  GreyImage grey = resample(to_grey(orthomosaic), options.resolution_m);
  if (options.effective_channel() == Channel::kHighPass) {
    apply_high_pass(grey, options.high_pass_sigma_m / options.resolution_m);
  }
  ChannelImage channel{Raster<std::uint8_t>(grey.value.width(), grey.value.height()),
                       std::move(grey.valid), grey.geo};
  for (std::size_t i = 0; i < channel.value.values().size(); ++i) {
    if (channel.valid.values()[i] == 0) continue;
    // 1 .. 255: zero is left to holes, so that fast paths can tell them apart in the value alone.
    channel.value.values()[i] =
        static_cast<std::uint8_t>(std::lround(std::clamp(grey.value.values()[i], 1.0F, 255.0F)));
  }
  return channel;
}

}  // namespace nadir
