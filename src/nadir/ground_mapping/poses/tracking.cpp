// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/poses/tracking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace nadir::ground {
namespace {

constexpr int kPatch = 6;    ///< pixels on each side of its centre
constexpr int kSearch = 16;  ///< likewise, of the places that are tried
constexpr int kWideSearch = 40;
constexpr double kLeastCorrelation = 0.8;
constexpr double kSureCorrelation = 0.9;
/// A patch that is enlarged or shrunk more does not look the same.
constexpr double kMostMagnification = 1.7;

/// A square around a pixel, `magnification` times as large as it is in the image; empty where it
/// reaches over the edge.
cv::Mat patch_around(const cv::Mat& image, const Eigen::Vector2i& pixel, double magnification) {
  const int reach = std::max(2, cvRound(kPatch / magnification));
  const cv::Rect square(pixel.x() - reach, pixel.y() - reach, 2 * reach + 1, 2 * reach + 1);
  if ((square & cv::Rect({}, image.size())) != square) return {};
  if (reach == kPatch) return image(square);
  cv::Mat patch;
  cv::resize(image(square), patch, {2 * kPatch + 1, 2 * kPatch + 1}, 0.0, 0.0, cv::INTER_LINEAR);
  return patch;
}

/// The vertex of the parabola through three values about the largest, -0.5 .. 0.5.
double vertex(float before, float at, float after) {
  const double bend = 2.0 * static_cast<double>(at) - before - after;
  return bend > 0.0 ? 0.5 * (static_cast<double>(after) - before) / bend : 0.0;
}

struct Found {
  Eigen::Vector2d pixel;
  double correlation = 0.0;
};

/// Where in the image the patch is, at most `reach` pixels from `place`.
std::optional<Found> search(const cv::Mat& image, const cv::Mat& patch,
                            const Eigen::Vector2d& place, int reach) {
  const cv::Rect whole({}, image.size());
  const cv::Rect2d inside(whole);
  if (patch.empty() || !inside.contains({place.x(), place.y()})) return std::nullopt;
  const int around = kPatch + reach;
  const cv::Rect window = whole & cv::Rect(cvRound(place.x()) - around, cvRound(place.y()) - around,
                                           2 * around + 1, 2 * around + 1);
  if (window.width < patch.cols + 2 || window.height < patch.rows + 2) return std::nullopt;
  cv::Mat correlation;
  cv::matchTemplate(image(window), patch, correlation, cv::TM_CCOEFF_NORMED);
  double best = 0.0;
  cv::Point at;
  cv::minMaxLoc(correlation, nullptr, &best, nullptr, &at);
  const bool at_edge =
      at.x == 0 || at.y == 0 || at.x + 1 == correlation.cols || at.y + 1 == correlation.rows;
  if (!(best >= kLeastCorrelation) || at_edge) return std::nullopt;
  const auto value = [&](int dx, int dy) { return correlation.at<float>(at.y + dy, at.x + dx); };
  return Found{{window.x + at.x + kPatch + vertex(value(-1, 0), value(0, 0), value(1, 0)),
                window.y + at.y + kPatch + vertex(value(0, -1), value(0, 0), value(0, 1))},
               best};
}

/// The landmark in the second image: at its place by the poses, or where it was if it looks more
/// like itself there.
std::optional<Found> find(const Landmark& landmark, const Sighting& first, const Sighting& second,
                          const CameraStep& expected) {
  const Eigen::Vector3d& p = landmark.p_in_camera;
  const Eigen::Vector3d there = moved(expected, p);
  const double magnification = p.z() / there.z();
  std::optional<Found> found;
  if (const auto pixel = second.camera.project(there);
      pixel && magnification < kMostMagnification && magnification > 1.0 / kMostMagnification) {
    const cv::Mat patch = patch_around(first.grey, landmark.pixel, magnification);
    found = search(second.grey, patch, *pixel, kSearch);
  }
  if (found && found->correlation > kSureCorrelation) return found;
  const cv::Mat patch = patch_around(first.grey, landmark.pixel, 1.0);
  const auto unmoved = search(second.grey, patch, second.camera.project(p).value(), kWideSearch);
  return unmoved && (!found || unmoved->correlation > found->correlation) ? unmoved : found;
}

}  // namespace

std::vector<Track> track(const Sighting& first, const Sighting& second,
                         const CameraStep& expected) {
  std::vector<Track> tracks;
  for (const Landmark& landmark : first.landmarks) {
    if (const auto found = find(landmark, first, second, expected)) {
      tracks.push_back({landmark.p_in_camera, found->pixel});
    }
  }
  return tracks;
}

double offset_of(const std::vector<Track>& tracks, const CameraModel& camera,
                 const CameraStep& step, double share) {
  if (tracks.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> offsets;
  for (const Track& found : tracks) {
    const auto pixel = camera.project(moved(step, found.p_in_first));
    const double most = camera.width;
    offsets.push_back(pixel ? std::min(most, (*pixel - found.pixel).norm()) : most);
  }
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(offsets.size()));
  std::nth_element(offsets.begin(), offsets.begin() + rank, offsets.end());
  return offsets[static_cast<std::size_t>(rank)];
}

}  // namespace nadir::ground
