// SPDX-License-Identifier: Apache-2.0
#include "peers/baselines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace nadir::bench {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// One position, as one would write the definition down.
double score_at(BruteForce score, const ChannelImage& map, const ChannelImage& local,
                const std::vector<double>& weights, int left, int top) {
  const int width = local.value.width();
  const int height = local.value.height();
  double difference = 0.0, count = 0.0, product = 0.0, map_norm = 0.0, local_norm = 0.0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      if (local.valid.at(column, row) == 0 || map.valid.at(left + column, top + row) == 0) continue;
      const double r = map.value.at(left + column, top + row);
      const double p = local.value.at(column, row);
      if (score == BruteForce::kSad || score == BruteForce::kSsd) {
        difference += score == BruteForce::kSad ? std::abs(r - p) : (r - p) * (r - p);
        count += 1.0;
        continue;
      }
      double w = 1.0;
      if (score == BruteForce::kWncc) {
        w = pixel_weight(PaperWeight::kNormalised, {column + 0.5, row + 0.5}, width, height);
      } else if (score == BruteForce::kWnccTable) {
        w = weights[static_cast<std::size_t>(row * width + column)];
      }
      product += w * r * p;
      map_norm += r * r;
      local_norm += p * p;
    }
  }
  if (score == BruteForce::kSad || score == BruteForce::kSsd) return -difference / count;
  return product / std::sqrt(map_norm * local_norm);
}

/// A copy with half a template of invalid pixels around, so that its first position has the robot
/// on the first pixel of the map.
template <class T>
cv::Mat padded(const Raster<T>& raster, const RotatedTemplate& local) {
  const cv::Mat image(raster.height(), raster.width(), cv::DataType<T>::type,
                      const_cast<T*>(raster.values().data()));
  cv::Mat grey;
  image.convertTo(grey, CV_32F);
  cv::Mat result;
  cv::copyMakeBorder(grey, result, -local.top, local.top + local.value.height() - 1, -local.left,
                     local.left + local.value.width() - 1, cv::BORDER_CONSTANT, 0.0);
  return result;
}

cv::Mat view(const Raster<float>& raster) {
  return {raster.height(), raster.width(), CV_32F, const_cast<float*>(raster.values().data())};
}

Raster<float> to_raster(const cv::Mat& image) {
  Raster<float> raster(image.cols, image.rows);
  image.copyTo(view(raster));
  return raster;
}

}  // namespace

std::size_t brute_force_positions(const ChannelImage& map, const ChannelImage& local, int stride) {
  const auto along = [stride](int whole, int part) {
    return static_cast<std::size_t>((whole - part) / stride + 1);
  };
  return along(map.value.width(), local.value.width()) *
         along(map.value.height(), local.value.height());
}

std::vector<double> brute_force(BruteForce score, const ChannelImage& map,
                                const ChannelImage& local, int stride) {
  std::vector<double> weights;
  for (int row = 0; row < local.value.height(); ++row) {
    for (int column = 0; column < local.value.width(); ++column) {
      weights.push_back(pixel_weight(PaperWeight::kNormalised, {column + 0.5, row + 0.5},
                                     local.value.width(), local.value.height()));
    }
  }
  std::vector<double> scores;
  for (int top = 0; top + local.value.height() <= map.value.height(); top += stride) {
    for (int left = 0; left + local.value.width() <= map.value.width(); left += stride) {
      scores.push_back(score_at(score, map, local, weights, left, top));
    }
  }
  return scores;
}

std::vector<double> warp_and_loop(const ChannelImage& map, const ChannelImage& local,
                                  std::span<const Pose2> poses, double min_valid_weight) {
  const int width = local.value.width();
  const int height = local.value.height();
  const int side = static_cast<int>(std::ceil(std::hypot(width, height))) + 1;
  cv::Mat value;
  cv::Mat weight(height, width, CV_32F);
  cv::Mat(height, width, CV_8U, const_cast<std::uint8_t*>(local.value.values().data()))
      .convertTo(value, CV_32F);
  double total = 0.0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double w =
          local.valid.at(column, row) == 0
              ? 0.0
              : pixel_weight(PaperWeight::kNormalised, {column + 0.5, row + 0.5}, width, height);
      weight.at<float>(row, column) = static_cast<float>(w);
      value.at<float>(row, column) *= static_cast<float>(w);
      total += w;
    }
  }
  std::vector<double> scores;
  cv::Mat turned_value, turned_weight;
  for (const Pose2& pose : poses) {
    cv::Mat turn = cv::getRotationMatrix2D(
        {0.5F * static_cast<float>(width - 1), 0.5F * static_cast<float>(height - 1)},
        pose.yaw * 180.0 / kPi, 1.0);
    turn.at<double>(0, 2) += 0.5 * (side - width);
    turn.at<double>(1, 2) += 0.5 * (side - height);
    cv::warpAffine(value, turned_value, turn, {side, side});
    cv::warpAffine(weight, turned_weight, turn, {side, side});
    const PixelCoordinate at = map.geo.pixel_at(pose.x, pose.y);
    const int left = static_cast<int>(std::lround(at.column - 0.5 * side));
    const int top = static_cast<int>(std::lround(at.row - 0.5 * side));
    double a = 0.0, r = 0.0, rr = 0.0, p = 0.0, pp = 0.0, rp = 0.0;
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        const double w = turned_weight.at<float>(row, column);
        const int u = left + column;
        const int v = top + row;
        if (w <= 0.0 || !map.value.contains(u, v) || map.valid.at(u, v) == 0) continue;
        const double grey = turned_value.at<float>(row, column) / w;
        const double under = map.value.at(u, v);
        a += w;
        r += w * under;
        rr += w * under * under;
        p += w * grey;
        pp += w * grey * grey;
        rp += w * under * grey;
      }
    }
    scores.push_back(a < min_valid_weight * total
                         ? kUndefined
                         : (rp - r * p / a) / std::sqrt((rr - r * r / a) * (pp - p * p / a)));
  }
  return scores;
}

ScoreSurface six_ccorr(const ChannelImage& map, const RotatedTemplate& local,
                       double min_valid_weight, double map_shift) {
  cv::Mat mask = padded(map.valid, local);
  cv::Mat value = padded(map.value, local);
  value = (value - map_shift).mul(mask) / 64.0;
  const cv::Mat squares = value.mul(value);
  const cv::Mat& a = view(local.weight);
  const double local_mean = cv::sum(view(local.value).mul(view(local.mask)))[0] /
                            std::max(cv::sum(view(local.mask))[0], 1.0);
  const cv::Mat unit = cv::Mat((view(local.value) - local_mean) / 64.0);
  const cv::Mat ap = a.mul(unit);
  const cv::Mat app = ap.mul(unit);
  cv::Mat sum[6];
  const std::pair<const cv::Mat*, const cv::Mat*> products[] = {
      {&mask, &a}, {&value, &a}, {&squares, &a}, {&mask, &ap}, {&mask, &app}, {&value, &ap}};
  for (int k = 0; k < 6; ++k) {
    cv::matchTemplate(*products[k].first, *products[k].second, sum[k], cv::TM_CCORR);
  }
  ScoreSurface surface{
      Raster<float>(sum[0].cols, sum[0].rows, std::numeric_limits<float>::quiet_NaN()),
      Raster<float>(sum[0].cols, sum[0].rows)};
  for (int row = 0; row < sum[0].rows; ++row) {
    for (int column = 0; column < sum[0].cols; ++column) {
      const auto at = [&](int k) { return static_cast<double>(sum[k].at<float>(row, column)); };
      const double share = std::clamp(at(0) / local.total_seen, 0.0, 1.0);
      surface.valid_weight.at(column, row) = static_cast<float>(share);
      if (share < min_valid_weight) continue;
      const double map_norm = at(2) - at(1) * at(1) / at(0);
      const double local_norm = at(4) - at(3) * at(3) / at(0);
      surface.score.at(column, row) =
          static_cast<float>((at(5) - at(1) * at(3) / at(0)) / std::sqrt(map_norm * local_norm));
    }
  }
  return surface;
}

Raster<float> opencv_coeff(const ChannelImage& map, const RotatedTemplate& local, bool masked) {
  const cv::Mat image = padded(map.value, local);
  cv::Mat result;
  if (masked) {
    cv::Mat mask;
    cv::sqrt(view(local.weight), mask);
    cv::matchTemplate(image, view(local.value), result, cv::TM_CCOEFF_NORMED, mask);
  } else {
    cv::matchTemplate(image, view(local.value), result, cv::TM_CCOEFF_NORMED);
  }
  return to_raster(result);
}

}  // namespace nadir::bench
