// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/pose_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/core/score_volume.hpp"
#include "nadir/map_matching/cpu/fft_size.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

/// Between two headings the edge of a template moves by at most so many map pixels.
constexpr double kYawStepPx = 0.75;

/// Positions times headings that are held at most: 8 bytes each.
constexpr double kLargestVolume = 2e7;

/// Interpolated scores differ by about 3e-3 from exact ones (docs/performance.md): `auto` takes
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
  result.window.left = static_cast<int>(std::floor(left));
  result.window.top = static_cast<int>(std::floor(top));
  result.window.width = static_cast<int>(std::floor(right)) - result.window.left + 2;
  result.window.height = static_cast<int>(std::floor(bottom)) - result.window.top + 2;
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
  PoseSurfaces(const MapIndex& map, const Template& local, const Cover& cover)
      : map_(map), cover_(cover) {
    std::vector<double> yaws;
    for (int k = 0; k < static_cast<int>(cover.headings); ++k) {
      yaws.push_back(cover.first_yaw + k * cover.yaw_step);
    }
    const std::vector<RotatedTemplate> templates = rotate_templates(
        local.channel, yaws, map.channel().geo.resolution, pixel_role(map.options()));
    surfaces_ = backend_of(map.options()).score_surfaces(map, templates, cover.window);
  }

  /// Trilinear. A NaN with a share of at least the smallest says that a neighbour is undefined.
  PoseScore at(const Pose2& pose) const {
    const PixelCoordinate at = map_.channel().geo.pixel_at(pose.x, pose.y);
    const Cell column = cell(at.column - 0.5 - cover_.window.left, cover_.window.width);
    const Cell row = cell(at.row - 0.5 - cover_.window.top, cover_.window.height);
    const double turn = cover_.yaw_step > 0.0
                            ? wrap_angle(pose.yaw - cover_.first_yaw - 0.5 * span()) + 0.5 * span()
                            : 0.0;
    const Cell heading = cell(cover_.yaw_step > 0.0 ? turn / cover_.yaw_step : 0.0,
                              static_cast<int>(surfaces_.size()));
    PoseScore result{0.0, 0.0};
    for (const int k : {0, 1}) {
      if (heading.share(k) == 0.0) continue;
      const ScoreSurface& surface =
          surfaces_[static_cast<std::size_t>(heading.index) + static_cast<std::size_t>(k)];
      for (const int j : {0, 1}) {
        for (const int i : {0, 1}) {
          const double share = heading.share(k) * row.share(j) * column.share(i);
          if (share == 0.0) continue;
          const int u = column.index + i;
          const int v = row.index + j;
          result.score += share * static_cast<double>(surface.score.at(u, v));
          result.valid_weight += share * static_cast<double>(surface.valid_weight.at(u, v));
        }
      }
    }
    if (result.valid_weight < map_.options().min_valid_weight) result.score = kUndefinedScore;
    return result;
  }

 private:
  /// Two neighbours along an axis and how much the second counts.
  struct Cell {
    int index = 0;
    double fraction = 0.0;
    double share(int which) const { return which == 0 ? 1.0 - fraction : fraction; }
  };
  static Cell cell(double at, int size) {
    const int index = std::clamp(static_cast<int>(std::floor(at)), 0, std::max(size - 2, 0));
    return {index, size > 1 ? std::clamp(at - index, 0.0, 1.0) : 0.0};
  }
  double span() const { return (cover_.headings - 1.0) * cover_.yaw_step; }

  const MapIndex& map_;
  Cover cover_;
  std::vector<ScoreSurface> surfaces_;
};

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
                                         std::span<const Pose2> map_from_robot) {
  const PoseSurfaces surfaces(map, local, cover(map, local, map_from_robot));
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
  std::vector<Pose2> poses;
  for (const std::size_t i : left_over) poses.push_back(map_from_robot[i]);
  const std::vector<PoseScore> exact = backend_of(map.options()).score_poses(map, local, poses);
  for (std::size_t k = 0; k < left_over.size(); ++k) scores[left_over[k]] = exact[k];
  return scores;
}

}  // namespace nadir
