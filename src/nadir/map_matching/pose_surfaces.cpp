// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/pose_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/core/score_volume.hpp"
#include "nadir/map_matching/cpu/fft_size.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

/// Between two headings the edge of a template moves by at most so many map pixels.
constexpr double kYawStepPx = 0.75;

/// Pixels that a cubic needs beyond those beside a position.
constexpr int kMargin = 1;

/// Exactly scored poses that say by how much surfaces are off.
constexpr std::size_t kScaleSamples = 32;

/// Positions times headings that are held at most: 8 bytes each.
constexpr double kLargestVolume = 2e7;

/// Interpolated scores differ by about 2e-3 from exact ones (docs/performance.md): `auto` takes
/// them only where that buys this multiple of speed. wncc_paper has no fast exact form.
constexpr double kWorthwhile = 16.0;
constexpr double kWorthwhileOfPaper = 2.0;

// Measured on one core, nanoseconds; only their ratio decides.
constexpr double kExactNs = 1.2;       ///< a valid template pixel of a pose
constexpr double kSampledNs = 25.0;    ///< the same for scores without a closed form
constexpr double kRotateNs = 8.0;      ///< a pixel of a rotated template
constexpr double kTransformNs = 1.0;   ///< a unit of fft_cost
constexpr double kLevelsFactor = 5.0;  ///< wncc_paper correlates so many times as much

/// Far outside nothing can overlap, and an integer could overflow.
bool is_near(const PixelCoordinate& at, const Pose2& pose) {
  constexpr double kFarthestPx = 1e8;
  return std::abs(at.column) < kFarthestPx && std::abs(at.row) < kFarthestPx &&
         std::isfinite(pose.yaw);
}

/// Where poses are: pixels whose centres surround them, and evenly spaced headings.
struct Cover {
  PixelWindow window;
  double first_yaw = 0.0;
  double yaw_step = 0.0;  ///< 0 where there is one heading
  double headings = 0.0;  ///< as a number that does not overflow
  double voxels() const {
    return headings * static_cast<double>(window.width) * static_cast<double>(window.height);
  }
};

Cover cover(const MapIndex& map, const Template& local, std::span<const Pose2> poses) {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9, low = 0.0, high = 0.0;
  const Pose2* middle = nullptr;
  for (const Pose2& pose : poses) {
    const PixelCoordinate at = map.channel().geo.pixel_at(pose.x, pose.y);
    if (!is_near(at, pose)) continue;
    if (middle == nullptr) middle = &pose;
    left = std::min(left, at.column - 0.5);
    right = std::max(right, at.column - 0.5);
    top = std::min(top, at.row - 0.5);
    bottom = std::max(bottom, at.row - 0.5);
    const double turn = wrap_angle(pose.yaw - middle->yaw);
    low = std::min(low, turn);
    high = std::max(high, turn);
  }
  Cover result;
  if (middle == nullptr) return result;
  result.window.left = static_cast<int>(std::floor(left)) - kMargin;
  result.window.top = static_cast<int>(std::floor(top)) - kMargin;
  result.window.width = static_cast<int>(std::floor(right)) + 2 + kMargin - result.window.left;
  result.window.height = static_cast<int>(std::floor(bottom)) + 2 + kMargin - result.window.top;
  const ChannelImage& image = local.channel;
  const double radius_px = 0.25 * (image.value.width() + image.value.height()) *
                           image.geo.resolution / map.channel().geo.resolution;
  const double steps = std::ceil((high - low) * radius_px / kYawStepPx - 1e-9);
  result.first_yaw = middle->yaw + low;
  result.headings = steps + 1.0;
  result.yaw_step = steps > 0.0 ? (high - low) / steps : 0.0;
  return result;
}

double surface_cost(const MapIndex& map, const Template& local, const Cover& cover) {
  const double side = std::hypot(local.channel.value.width(), local.channel.value.height());
  const cpu::FftSize size =
      cpu::cheapest_fft_size(static_cast<std::size_t>(cover.window.width + side),
                             static_cast<std::size_t>(cover.window.height + side));
  // Nine column transforms of half as many columns; two real rows go as one complex row.
  const double columns = 4.5 * static_cast<double>(size.width) * cpu::fft_cost(size.height);
  const double rows = (1.5 * side + 3.0 * cover.window.height) * cpu::fft_cost(size.width);
  const double factor = map.options().score == Score::kWnccPaper ? kLevelsFactor : 1.0;
  return cover.headings * (kRotateNs * side * side + factor * kTransformNs * (columns + rows));
}

double exact_cost(const MapIndex& map, const Template& local, std::size_t poses) {
  const double pixels = local.valid_share * static_cast<double>(local.channel.value.width()) *
                        static_cast<double>(local.channel.value.height());
  return static_cast<double>(poses) * pixels *
         (map.options().score == Score::kWnccPaper ? kSampledNs : kExactNs);
}

/// Score surfaces at evenly spaced headings.
class PoseSurfaces {
 public:
  PoseSurfaces(const MapIndex& map, const Template& local, const Cover& cover,
               const StopToken& stop)
      : map_(map), cover_(cover) {
    std::vector<double> yaws;
    for (int k = 0; k < static_cast<int>(cover.headings); ++k) {
      yaws.push_back(cover.first_yaw + k * cover.yaw_step);
    }
    const std::vector<RotatedTemplate> templates = rotate_templates(
        local.channel, yaws, map.channel().geo.resolution, pixel_role(map.options()));
    surfaces_ = backend_of(map.options()).score_surfaces(map, templates, cover.window, stop);
  }

  /// Cubic in position, linear in heading. A NaN with a share of at least the smallest says that a
  /// neighbour is undefined.
  PoseScore at(const Pose2& pose) const {
    const PixelCoordinate at = map_.channel().geo.pixel_at(pose.x, pose.y);
    const Taps columns = cubic_taps(at.column - 0.5 - cover_.window.left, cover_.window.width);
    const Taps rows = cubic_taps(at.row - 0.5 - cover_.window.top, cover_.window.height);
    const Headings headings = headings_beside(pose.yaw);
    PoseScore result{0.0, 0.0};
    for (const int k : {0, 1}) {
      const double of_heading = k == 0 ? 1.0 - headings.fraction : headings.fraction;
      if (of_heading == 0.0) continue;
      const ScoreSurface& surface =
          surfaces_[static_cast<std::size_t>(headings.first) + static_cast<std::size_t>(k)];
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          const double share = of_heading * rows.share[static_cast<std::size_t>(j)] *
                               columns.share[static_cast<std::size_t>(i)];
          if (share == 0.0) continue;
          result.score +=
              share * static_cast<double>(surface.score.at(columns.first + i, rows.first + j));
          result.valid_weight += share * static_cast<double>(surface.valid_weight.at(
                                             columns.first + i, rows.first + j));
        }
      }
    }
    result.valid_weight = std::clamp(result.valid_weight, 0.0, 1.0);  // a cubic overshoots
    if (result.valid_weight < map_.options().min_valid_weight) result.score = kUndefinedScore;
    return result;
  }

 private:
  /// Four neighbours along an axis, and how much each counts.
  struct Taps {
    int first = 0;
    std::array<double, 4> share{};
  };
  /// Catmull-Rom: the kernel of Keys, 1981, with a = -1/2.
  static Taps cubic_taps(double at, int size) {
    const int left = std::clamp(static_cast<int>(std::floor(at)), kMargin, size - kMargin - 2);
    const double t = std::clamp(at - left, 0.0, 1.0);
    return {left - 1,
            {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (-5.0 + 3.0 * t),
             0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (-1.0 + t)}};
  }
  struct Headings {
    int first = 0;
    double fraction = 0.0;  ///< of the way to the next
  };
  Headings headings_beside(double yaw) const {
    if (cover_.yaw_step == 0.0) return {};
    const double span = (cover_.headings - 1.0) * cover_.yaw_step;
    const double at =
        (wrap_angle(yaw - cover_.first_yaw - 0.5 * span) + 0.5 * span) / cover_.yaw_step;
    const int first =
        std::clamp(static_cast<int>(std::floor(at)), 0, static_cast<int>(surfaces_.size()) - 2);
    return {first, std::clamp(at - first, 0.0, 1.0)};
  }

  const MapIndex& map_;
  Cover cover_;
  std::vector<ScoreSurface> surfaces_;
};

std::vector<PoseScore> score_exactly(const MapIndex& map, const Template& local,
                                     std::span<const Pose2> all, std::span<const std::size_t> which,
                                     const StopToken& stop) {
  std::vector<Pose2> poses;
  for (const std::size_t i : which) poses.push_back(all[i]);
  return backend_of(map.options()).score_poses(map, local, poses, stop);
}

/// Exact scores sample the map between its pixels; surfaces sample the template instead. Either
/// loses contrast, but not of the same image, so correlations differ by a factor (0.96 on the
/// Aero-Ground run): least squares over a few poses, with a prior of 1 +- 0.05 against residuals
/// of 2e-3 for where no pose correlates.
double exact_over_interpolated(const MapIndex& map, const Template& local,
                               std::span<const Pose2> poses, std::span<const PoseScore> scores,
                               const StopToken& stop) {
  std::vector<std::size_t> sample;
  const std::size_t stride = std::max<std::size_t>(poses.size() / kScaleSamples, 1);
  for (std::size_t i = 0; i < poses.size() && sample.size() < kScaleSamples; i += stride) {
    if (std::isfinite(scores[i].score)) sample.push_back(i);
  }
  const std::vector<PoseScore> exact = score_exactly(map, local, poses, sample, stop);
  constexpr double kPrior = (2e-3 / 0.05) * (2e-3 / 0.05);
  double products = kPrior;
  double squares = kPrior;
  for (std::size_t k = 0; k < sample.size(); ++k) {
    if (!std::isfinite(exact[k].score)) continue;
    const double interpolated = scores[sample[k]].score;
    products += exact[k].score * interpolated;
    squares += interpolated * interpolated;
  }
  return products / squares;
}

}  // namespace

bool takes_surfaces(const MapIndex& map, const Template& local,
                    std::span<const Pose2> map_from_robot) {
  const MatchingOptions& options = map.options();
  // sad has no transform, and a GPU scores any number of poses exactly.
  if (options.pose_scoring == PoseScoring::kExact || options.score == Score::kSad) return false;
  const Cover around = cover(map, local, map_from_robot);
  if (around.headings == 0.0 || around.voxels() > kLargestVolume) return false;
  if (options.pose_scoring == PoseScoring::kSurface) return true;
  const double worthwhile = options.score == Score::kWnccPaper ? kWorthwhileOfPaper : kWorthwhile;
  return options.backend == Backend::kCpu && worthwhile * surface_cost(map, local, around) <
                                                 exact_cost(map, local, map_from_robot.size());
}

std::vector<PoseScore> score_by_surfaces(const MapIndex& map, const Template& local,
                                         std::span<const Pose2> map_from_robot,
                                         const StopToken& stop) {
  const PoseSurfaces surfaces(map, local, cover(map, local, map_from_robot), stop);
  std::vector<PoseScore> scores;
  std::vector<std::size_t> left_over;
  for (const Pose2& pose : map_from_robot) {
    const bool near = is_near(map.channel().geo.pixel_at(pose.x, pose.y), pose);
    scores.push_back(near ? surfaces.at(pose) : PoseScore{kUndefinedScore, 0.0});
    if (std::isnan(scores.back().score) &&
        scores.back().valid_weight >= map.options().min_valid_weight) {
      left_over.push_back(scores.size() - 1);
    }
  }
  const double scale = exact_over_interpolated(map, local, map_from_robot, scores, stop);
  for (PoseScore& score : scores) score.score *= scale;  // a NaN stays one
  const std::vector<PoseScore> exact = score_exactly(map, local, map_from_robot, left_over, stop);
  for (std::size_t k = 0; k < left_over.size(); ++k) scores[left_over[k]] = exact[k];
  return scores;
}

}  // namespace nadir
