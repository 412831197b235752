// SPDX-License-Identifier: Apache-2.0
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "nadir/core/score_volume.hpp"
#include "nadir/map_matching/cpu/closed_form_surface.hpp"
#include "nadir/map_matching/cpu/map_cache.hpp"
#include "nadir/map_matching/cpu/paper_surface.hpp"
#include "nadir/map_matching/cpu/pose_scorer.hpp"
#include "nadir/map_matching/cpu/region.hpp"
#include "nadir/map_matching/cpu/sad_surface.hpp"
#include "nadir/map_matching/cpu/sampled_score.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

/// Far outside nothing can overlap, and an integer could overflow.
bool is_near(const MapIndex& map, const Pose2& pose) {
  constexpr double kFarthestPx = 1e8;
  const PixelCoordinate at = map.channel().geo.pixel_at(pose.x, pose.y);
  return std::abs(at.column) < kFarthestPx && std::abs(at.row) < kFarthestPx &&
         std::isfinite(pose.yaw);
}

/// Scores every pose near the map by `score`, in parallel; the others are undefined.
template <class ScorePose>
std::vector<PoseScore> score_each(const MapIndex& map, std::span<const Pose2> poses,
                                  const StopToken& stop, const ScorePose& score) {
  constexpr std::size_t kGrain = 16;
  std::vector<PoseScore> scores(poses.size(), {kUndefinedScore, 0.0});
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, poses.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      stop.check();
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        if (is_near(map, poses[i])) scores[i] = score(poses[i]);
                      }
                    });
  return scores;
}

PoseScore closed_form_score(const MapIndex& map, const cpu::PixelList& pixels, const Pose2& pose) {
  PoseScore result{kUndefinedScore, 0.0};
  if (pixels.total_seen <= 0.0) return result;
  const PixelCoordinate at = map.channel().geo.pixel_at(pose.x, pose.y);
  const cpu::Sums sums = cpu::sum_at(
      map.quads(), pixels, {at.column - 0.5, at.row - 0.5, std::cos(pose.yaw), std::sin(pose.yaw)});
  result.valid_weight = sums.a / pixels.total_seen;
  if (result.valid_weight < map.options().min_valid_weight) return result;
  result.score = cpu::score_from_sums(map.options().score, sums, pixels.shifts);
  return result;
}

class CpuBackend : public MatchingBackend {
 public:
  std::shared_ptr<PreparedMap> prepare(const MapIndex& /*map*/) const override {
    return std::make_shared<cpu::MapCache>();
  }

  std::vector<ScoreSurface> score_surfaces(const MapIndex& map,
                                           std::span<const RotatedTemplate> templates,
                                           const PixelWindow& window,
                                           const StopToken& stop) const override {
    if (templates.empty() || window.width <= 0 || window.height <= 0) return {};
    const MatchingOptions& options = map.options();
    if (cpu::is_closed_form(options.score)) {
      return cpu::closed_form_surfaces(map, templates, window, stop);
    }
    const cpu::Region region = cpu::cut_region(
        map.channel(),
        cpu::place_region(map.channel(), templates, window, cpu::RegionExtent::kWhole), window,
        pixel_role(options).whole_square);
    if (options.score == Score::kSad) {
      return cpu::sad_surfaces(options, region, templates, window, stop);
    }
    return cpu::paper_surfaces(options, region, templates, window, stop);
  }

  std::vector<PoseScore> score_poses(const MapIndex& map, const Template& local,
                                     std::span<const Pose2> poses,
                                     const StopToken& stop) const override {
    const MatchingOptions& options = map.options();
    if (!cpu::is_closed_form(options.score) || pixel_role(options).whole_square) {
      return score_each(map, poses, stop, cpu::SampledScorer(map, local));
    }
    const cpu::PixelList pixels =
        cpu::list_pixels(local.channel, options, map.channel().geo.resolution, map.mean_grey());
    return score_each(map, poses, stop,
                      [&](const Pose2& pose) { return closed_form_score(map, pixels, pose); });
  }
};

}  // namespace

const MatchingBackend& cpu_backend() {
  static const CpuBackend backend;
  return backend;
}

}  // namespace nadir
