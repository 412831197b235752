// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/coarse_search.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/map_matching/peaks.hpp"
#include "nadir/map_matching/resample.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

constexpr int kCoarsePlaces = 192;
/// Of full resolution, or as many as candidates are asked for. Neighbours on a ridge stay apart:
/// the best of one at half the resolution need not be its best.
constexpr int kFinePlaces = 48;
constexpr int kClimbedPlaces = 16;
/// Of the climbed ones, the surroundings are searched once more: along a road scores form a ridge,
/// whose highest point need not stand out from it at a quarter of the resolution.
constexpr int kRidges = 3;
constexpr int kRidgeReach = 10;   ///< pixels of half the resolution to each side
constexpr int kRidgePlaces = 16;  ///< of each, at full resolution
constexpr int kClimbedRidgePlaces = 4;

/// The best of `places`, best first, no two of which are closer than both limits.
std::vector<MatchCandidate> best_places(std::vector<MatchCandidate> places, std::size_t count,
                                        double separation, double yaw_separation) {
  std::stable_sort(
      places.begin(), places.end(),
      [](const MatchCandidate& a, const MatchCandidate& b) { return a.score > b.score; });
  std::vector<MatchCandidate> best;
  for (const MatchCandidate& place : places) {
    if (best.size() >= count) break;
    const bool separate = std::all_of(best.begin(), best.end(), [&](const MatchCandidate& other) {
      return distance(place.map_from_robot, other.map_from_robot) >= separation ||
             std::abs(wrap_angle(place.map_from_robot.yaw - other.map_from_robot.yaw)) >
                 yaw_separation;
    });
    if (separate) best.push_back(place);
  }
  return best;
}

/// A grid of poses around a place.
struct Grid {
  int positions = 0;  ///< steps to each side along x and y
  double step = 0.0;  ///< metres
  int headings = 0;   ///< steps to each side
  double yaw_step = 0.0;
};

/// The poses of the grids around `places` with their exact scores, grid after grid.
std::vector<MatchCandidate> score_around(const MapIndex& map, const Template& local,
                                         const std::vector<MatchCandidate>& places,
                                         const Grid& grid, const StopToken& stop) {
  std::vector<Pose2> poses;
  for (const MatchCandidate& place : places) {
    for (int k = -grid.headings; k <= grid.headings; ++k) {
      for (int j = -grid.positions; j <= grid.positions; ++j) {
        for (int i = -grid.positions; i <= grid.positions; ++i) {
          poses.push_back({place.map_from_robot.x + i * grid.step,
                           place.map_from_robot.y + j * grid.step,
                           wrap_angle(place.map_from_robot.yaw + k * grid.yaw_step)});
        }
      }
    }
  }
  const std::vector<PoseScore> scores =
      backend_of(map.options()).score_poses(map, local, poses, stop);
  std::vector<MatchCandidate> scored;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    scored.push_back({poses[i], scores[i].score, scores[i].valid_weight});
  }
  return scored;
}

/// Every place moved to the best exact score of the grid around it; places without any are dropped.
std::vector<MatchCandidate> best_around(const MapIndex& map, const Template& local,
                                        const std::vector<MatchCandidate>& places, const Grid& grid,
                                        const StopToken& stop) {
  const std::vector<MatchCandidate> scored = score_around(map, local, places, grid, stop);
  const std::size_t per_place = places.empty() ? 1 : scored.size() / places.size();
  std::vector<MatchCandidate> best;
  for (std::size_t begin = 0; begin < scored.size(); begin += per_place) {
    const MatchCandidate* top = &scored[begin];
    for (std::size_t i = begin; i < begin + per_place; ++i) {
      if (scored[i].score > top->score || std::isnan(top->score)) top = &scored[i];
    }
    if (!std::isnan(top->score)) best.push_back(*top);
  }
  return best;
}

/// The best `count` of `places` after a grid of full resolution around each, climbed.
std::vector<MatchCandidate> climbed(const MapIndex& map, const Template& local,
                                    std::vector<MatchCandidate> places, std::size_t count,
                                    double yaw_step, const StopToken& stop) {
  const double resolution = map.channel().geo.resolution;
  const bool turns = yaw_step > 0.0;
  places = best_around(
      map, local, places,
      {.positions = 2, .step = resolution, .headings = turns ? 2 : 0, .yaw_step = yaw_step / 6.0},
      stop);
  places = best_places(std::move(places), count, 2.0 * resolution, 0.2 * yaw_step);
  for (MatchCandidate& place : places) place = climb(map, local, place, turns, stop);
  return places;
}

}  // namespace

ChannelImage halved(const ChannelImage& channel) {
  GreyImage grey{Raster<float>(channel.value.width(), channel.value.height()), channel.valid,
                 channel.geo};
  std::copy(channel.value.values().begin(), channel.value.values().end(),
            grey.value.values().begin());
  grey = resample(grey, 2.0 * channel.geo.resolution);
  ChannelImage half{Raster<std::uint8_t>(grey.value.width(), grey.value.height()),
                    std::move(grey.valid), grey.geo};
  for (std::size_t i = 0; i < half.value.values().size(); ++i) {
    if (half.valid.values()[i] == 0) continue;
    half.value.values()[i] =
        static_cast<std::uint8_t>(std::lround(std::clamp(grey.value.values()[i], 1.0F, 255.0F)));
  }
  return half;
}

double coarse_yaw_step(const ChannelImage& local, double resolution) {
  const double radius = 0.25 * (local.value.width() + local.value.height()) * local.geo.resolution;
  return std::min(1.2 * 4.0 * resolution / radius, kPi / 8.0);
}

std::vector<MatchCandidate> refine_coarse(const MapIndex& map, const Template& local,
                                          const ScoreVolume& volume, const StopToken& stop) {
  const MapIndex& half_map = map.coarser();
  const Template half{halved(local.channel), local.valid_share};
  const double resolution = map.channel().geo.resolution;
  const double yaw_step = volume.yaws.size() > 1 ? volume.yaws[1] - volume.yaws[0] : 0.0;
  const int turns = volume.yaws.size() > 1 ? 1 : 0;

  MatchingOptions many = map.options();
  many.candidates = 16 * kCoarsePlaces;
  many.peak_separation_m = 0.0;
  std::vector<MatchCandidate> places =
      best_places(find_peaks(volume, many), kCoarsePlaces, 2.0 * 4.0 * resolution, 2.5 * yaw_step);
  places = best_around(
      half_map, half, places,
      {.positions = 2, .step = 2.0 * resolution, .headings = turns, .yaw_step = yaw_step / 3.0},
      stop);
  const auto fine = static_cast<std::size_t>(std::max(kFinePlaces, map.options().candidates));
  places = best_places(std::move(places), fine, 3.0 * resolution, 0.5 * yaw_step);
  const auto most = static_cast<std::size_t>(std::max(kClimbedPlaces, map.options().candidates));
  places = climbed(map, local, std::move(places), most, yaw_step, stop);

  const double separation = map.options().peak_separation_m;
  const Grid ridge{.positions = kRidgeReach,
                   .step = 2.0 * resolution,
                   .headings = 3 * turns,
                   .yaw_step = yaw_step / 3.0};
  for (const MatchCandidate& top : best_places(places, kRidges, separation, kPi)) {
    std::vector<MatchCandidate> around = score_around(half_map, half, {top}, ridge, stop);
    std::erase_if(around, [](const MatchCandidate& pose) { return std::isnan(pose.score); });
    around = best_places(std::move(around), kRidgePlaces, 4.0 * resolution, 0.5 * yaw_step);
    around = climbed(map, local, std::move(around), kClimbedRidgePlaces, yaw_step, stop);
    places.insert(places.end(), around.begin(), around.end());
  }
  return best_places(std::move(places), static_cast<std::size_t>(map.options().candidates),
                     separation, kPi);
}

}  // namespace nadir
