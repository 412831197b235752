// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/exposure.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "nadir/aerial_mapping/detail/median.hpp"

namespace nadir::aerial {
namespace {

constexpr double kMostCells = 400.0;  // more do not make a mean surer: its error is common
// Of the ratio of two photos' means: ground looks brighter from one side than from the other, the
// same way all along a strip. Trusted more, such ratios add up to a gain of 1.5 at its end.
constexpr double kRatioSigma = 0.08;
constexpr double kFewestCells = 12.0;
constexpr double kChromaSigma = 0.02;
constexpr double kChromaLimit = 0.05;
constexpr double kGamma = 2.2;
constexpr std::uint8_t kDarkest = 4;  // grey levels: nothing is said by what is cut off
constexpr std::uint8_t kBrightest = 250;
constexpr std::array<double, 3> kLuminance{0.299, 0.587, 0.114};  // ITU-R BT.601

double luminance(const std::array<double, 3>& rgb) {
  return kLuminance[0] * rgb[0] + kLuminance[1] * rgb[1] + kLuminance[2] * rgb[2];
}

bool is_exposed(const cv::Vec3b& rgb) {
  const auto [low, high] = std::minmax({rgb[0], rgb[1], rgb[2]});
  return low >= kDarkest && high <= kBrightest;
}

/// min sum n_ij (x_i - x_j + d_ij)^2 / s^2 + sum (x_i - e_i)^2 / prior^2
template <class Difference>
Eigen::VectorXd solve(const std::vector<Overlap>& overlaps, const Eigen::VectorXd& expected,
                      double prior_sigma, const Difference& difference) {
  const Eigen::Index n = expected.size();
  const double held = 1.0 / (prior_sigma * prior_sigma);
  Eigen::MatrixXd a = held * Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd b = held * expected;
  for (const Overlap& o : overlaps) {
    const auto i = static_cast<Eigen::Index>(o.first);
    const auto j = static_cast<Eigen::Index>(o.second);
    const double w = std::min(o.cells / kMostCells, 1.0) / (kRatioSigma * kRatioSigma);
    const double d = difference(o);
    a(i, i) += w;
    a(j, j) += w;
    a(i, j) -= w;
    a(j, i) -= w;
    b(i) -= w * d;
    b(j) += w * d;
  }
  return a.ldlt().solve(b);
}

}  // namespace

std::vector<Overlap> overlaps_of(const std::vector<ViewCells>& cells, const StopToken& stop) {
  std::vector<Overlap> overlaps;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    stop.check();
    for (std::size_t j = i + 1; j < cells.size(); ++j) {
      const cv::Rect common = cells[i].rect & cells[j].rect;
      Overlap overlap;
      overlap.first = i;
      overlap.second = j;
      for (int row = common.y; row < common.y + common.height; ++row)
        for (int column = common.x; column < common.x + common.width; ++column) {
          const cv::Point a(column - cells[i].rect.x, row - cells[i].rect.y);
          const cv::Point b(column - cells[j].rect.x, row - cells[j].rect.y);
          if (!std::isfinite(cells[i].cost.at<float>(a)) ||
              !std::isfinite(cells[j].cost.at<float>(b)))
            continue;
          const auto& p = cells[i].colour.at<cv::Vec3b>(a);
          const auto& q = cells[j].colour.at<cv::Vec3b>(b);
          if (!is_exposed(p) || !is_exposed(q)) continue;
          overlap.cells += 1.0;
          for (int k = 0; k < 3; ++k) {
            overlap.first_mean[static_cast<std::size_t>(k)] += p[k];
            overlap.second_mean[static_cast<std::size_t>(k)] += q[k];
          }
        }
      if (overlap.cells < kFewestCells) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        overlap.first_mean[k] /= overlap.cells;
        overlap.second_mean[k] /= overlap.cells;
      }
      overlaps.push_back(overlap);
    }
  }
  return overlaps;
}

std::vector<std::array<float, 3>> balance(const std::vector<Overlap>& overlaps,
                                          const std::vector<std::optional<double>>& exposures,
                                          double prior_sigma) {
  const auto n = static_cast<Eigen::Index>(exposures.size());
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(n);
  std::vector<double> known;
  for (const auto& exposure : exposures)
    if (exposure && *exposure > 0.0) known.push_back(*exposure);
  if (!known.empty()) {
    const double middle = median_of(known);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& exposure = exposures[static_cast<std::size_t>(i)];
      if (exposure && *exposure > 0.0) expected(i) = std::log(middle / *exposure) / kGamma;
    }
  }
  Eigen::VectorXd gain = solve(overlaps, expected, prior_sigma, [](const Overlap& o) {
    return std::log(luminance(o.first_mean) / luminance(o.second_mean));
  });
  if (n > 0) gain.array() -= median_of({gain.data(), gain.data() + n});

  std::vector<std::array<float, 3>> gains(exposures.size());
  for (std::size_t channel = 0; channel < 3; ++channel) {
    Eigen::VectorXd chroma =
        solve(overlaps, Eigen::VectorXd::Zero(n), kChromaSigma, [&](const Overlap& o) {
          return std::log(o.first_mean[channel] / luminance(o.first_mean)) -
                 std::log(o.second_mean[channel] / luminance(o.second_mean));
        });
    for (Eigen::Index i = 0; i < n; ++i)
      gains[static_cast<std::size_t>(i)][channel] =
          static_cast<float>(std::exp(gain(i) + std::clamp(chroma(i), std::log(1.0 - kChromaLimit),
                                                           std::log(1.0 + kChromaLimit))));
  }
  return gains;
}

}  // namespace nadir::aerial
