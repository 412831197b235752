// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/matching.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "nadir/core/error.hpp"
#include "nadir/map_matching/channel.hpp"
#include "nadir/map_matching/coarse_search.hpp"
#include "nadir/map_matching/height_channel.hpp"
#include "nadir/map_matching/peaks.hpp"
#include "nadir/map_matching/pose_surfaces.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

/// The headings of a search: evenly spaced, the middle one among them; a full turn has no heading
/// twice.
std::vector<double> headings(const SearchRegion& region, double step) {
  const double half_range = std::min(std::abs(region.yaw_half_range_rad), kPi);
  if (half_range >= kPi - 1e-12) {
    const auto count = static_cast<int>(std::lround(std::ceil(2.0 * kPi / step - 1e-9)));
    const int middle = count / 2;
    std::vector<double> yaws;
    for (int i = 0; i < count; ++i) {
      yaws.push_back(region.yaw_rad + 2.0 * kPi * (i - middle) / count);
    }
    return yaws;
  }
  const int steps = static_cast<int>(std::floor(half_range / step + 1e-9));
  std::vector<double> yaws;
  for (int i = -steps; i <= steps; ++i) yaws.push_back(region.yaw_rad + i * step);
  return yaws;
}

PixelWindow pixel_window(const ChannelImage& map, const SearchRegion& region) {
  if (!region.centre) return {0, 0, map.value.width(), map.value.height()};
  // Beyond it nothing can overlap, and an integer could overflow.
  constexpr double kFarthestPx = 1e8;
  PixelCoordinate centre = map.geo.pixel_at(region.centre->x, region.centre->y);
  centre.column = std::clamp(centre.column, -kFarthestPx, kFarthestPx);
  centre.row = std::clamp(centre.row, -kFarthestPx, kFarthestPx);
  const double half = region.half_size_m / map.geo.resolution;
  const auto first = [half](double middle) { return static_cast<int>(std::floor(middle - half)); };
  const auto count = [half](double middle) {
    return static_cast<int>(std::floor(middle + half)) -
           static_cast<int>(std::floor(middle - half)) + 1;
  };
  return {first(centre.column), first(centre.row), count(centre.column), count(centre.row)};
}

void check(const SearchRegion& region, double step) {
  const bool finite =
      std::isfinite(region.yaw_rad) && std::isfinite(region.yaw_half_range_rad) &&
      std::isfinite(region.half_size_m) &&
      (!region.centre || (std::isfinite(region.centre->x) && std::isfinite(region.centre->y)));
  if (!finite || region.half_size_m < 0.0 || !(step > 0.0)) {
    throw Error(ErrorKind::kUsage,
                "the search region needs a finite centre, heading and range, a size that is not "
                "negative and a positive yaw step");
  }
  constexpr double kLargestHalfSize = 1e4;  // metres
  if (region.centre && region.half_size_m > kLargestHalfSize) {
    throw Error(ErrorKind::kUsage, "the search window is larger than 20 km", {},
                "leave out its centre to search the whole map");
  }
}

/// A score and a share are held for each position at each heading.
void check_volume(const PixelWindow& window, std::size_t headings) {
  constexpr double kBytes = 2.0 * sizeof(float);
  constexpr double kMostGb = 16.0;
  const double gb = 1e-9 * kBytes * static_cast<double>(headings) * window.width * window.height;
  if (gb <= kMostGb) return;
  throw Error(ErrorKind::kUsage,
              "the scores of " + std::to_string(headings) + " headings at " +
                  std::to_string(window.width) + " x " + std::to_string(window.height) +
                  " positions would take " + std::to_string(std::lround(gb)) + " GB of memory",
              {},
              "search a smaller window or fewer headings, or leave map_matching.search at auto, "
              "which begins at a quarter of the resolution");
}

Template as_template(ChannelImage channel) {
  Template result{std::move(channel)};
  const auto& valid = result.channel.valid.values();
  const auto seen = std::count_if(valid.begin(), valid.end(), [](auto v) { return v != 0; });
  result.valid_share = static_cast<double>(seen) / static_cast<double>(valid.size());
  return result;
}

/// Every position of the region at every heading.
ScoreVolume score_volume(const MapIndex& map, const Template& local, const SearchRegion& region,
                         double step, const StopToken& stop) {
  const PixelWindow window = pixel_window(map.channel(), region);
  const GeoReference& geo = map.channel().geo;
  ScoreVolume volume;
  volume.geo = geo;
  volume.geo.west = geo.x_at(window.left);
  volume.geo.north = geo.y_at(window.top);
  volume.yaws = headings(region, step);
  check_volume(window, volume.yaws.size());
  const std::vector<RotatedTemplate> templates =
      rotate_templates(local.channel, volume.yaws, geo.resolution, pixel_role(map.options()));
  stop.check();
  for (ScoreSurface& surface :
       backend_of(map.options()).score_surfaces(map, templates, window, stop)) {
    volume.score.push_back(std::move(surface.score));
    volume.valid_weight.push_back(std::move(surface.valid_weight));
  }
  return volume;
}

bool goes_coarse_to_fine(const MapIndex& map, const Template& local, const SearchRegion& region,
                         double step) {
  constexpr double kLargeVolume = 1e7;   // positions x headings: 80 MB of scores
  constexpr int kSmallestTemplate = 32;  // pixels a side: 8 at a quarter of the resolution
  const MatchingOptions& options = map.options();
  if (options.search != Search::kAuto) return options.search == Search::kCoarseToFine;
  if (options.score != Score::kZncc && options.score != Score::kZwncc) return false;
  if (std::min(local.channel.value.width(), local.channel.value.height()) < kSmallestTemplate) {
    return false;
  }
  const PixelWindow window = pixel_window(map.channel(), region);
  return static_cast<double>(window.width) * window.height *
             static_cast<double>(headings(region, step).size()) >
         kLargeVolume;
}

/// Why nothing was scored: too little overlap everywhere, or too little contrast.
MatchStatus failure(const ScoreVolume& volume, double min_valid_weight) {
  for (const Raster<float>& surface : volume.valid_weight) {
    for (const float share : surface.values()) {
      if (share >= static_cast<float>(min_valid_weight)) return MatchStatus::kNoTexture;
    }
  }
  return MatchStatus::kNoOverlap;
}

}  // namespace

const MatchingBackend& backend_of(const MatchingOptions& options) {
  switch (options.backend) {
    case Backend::kCuda:
      return cuda_backend();
    case Backend::kReference:
      return reference_backend();
    case Backend::kCpu:
      break;
  }
  return cpu_backend();
}

std::string to_string(MatchStatus status) {
  switch (status) {
    case MatchStatus::kOk:
      return "ok";
    case MatchStatus::kAmbiguous:
      return "ambiguous";
    case MatchStatus::kNoOverlap:
      return "no_overlap";
    case MatchStatus::kNoTexture:
      return "no_texture";
  }
  return {};
}

struct MapIndex::Coarser {
  std::once_flag once;
  std::unique_ptr<const MapIndex> index;
};

MapIndex::MapIndex(const Orthomosaic& map, const MatchingOptions& options)
    : MapIndex(options, make_channel(map, options, "the map")) {}

MapIndex::MapIndex(const ElevationMap& surface, const MatchingOptions& options)
    : MapIndex(options.for_heights(),
               make_height_channel(surface, options, "the surface of the map")) {}

MapIndex::MapIndex(const MatchingOptions& options, ChannelImage channel)
    : options_(options), channel_(std::move(channel)) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < channel_.value.values().size(); ++i) {
    sum += channel_.value.values()[i];
    count += channel_.valid.values()[i];
  }
  if (count == 0.0) {
    throw Error(ErrorKind::kInput, "the map has no valid pixel", {},
                "check its mask, alpha band or nodata value");
  }
  mean_grey_ = sum / count;
  quads_ = pack_quads(channel_.value, channel_.valid);
  coarser_ = std::make_shared<Coarser>();
  prepared_ = backend_of(options_).prepare(*this);
}

const MapIndex& MapIndex::coarser() const {
  std::call_once(coarser_->once, [this] {
    MatchingOptions options = options_;
    options.resolution_m *= 2.0;
    options.min_valid_weight *= 0.93;  // coarse pixels are lost at the edges of holes
    coarser_->index.reset(new MapIndex(options, halved(channel_)));
  });
  return *coarser_->index;
}

Template make_template(const Orthomosaic& local, const MatchingOptions& options) {
  return as_template(make_channel(local, options, "the local map"));
}

Template make_template(const ElevationMap& local, const MatchingOptions& options) {
  return as_template(make_height_channel(local, options, "the local heights"));
}

MatchResult match(const MapIndex& map, const Template& local, const SearchRegion& region,
                  const StopToken& stop) {
  const double step = region.yaw_step_rad.value_or(radians(map.options().yaw_step_deg));
  check(region, step);
  MatchResult result;
  if (goes_coarse_to_fine(map, local, region, step)) {
    const MapIndex& quarter = map.coarser().coarser();
    const Template coarse{halved(halved(local.channel)), local.valid_share};
    const double coarse_step =
        std::max(step, coarse_yaw_step(local.channel, map.channel().geo.resolution));
    result.volume = score_volume(quarter, coarse, region, coarse_step, stop);
    result.candidates = refine_coarse(map, local, result.volume, stop);
  } else {
    result.volume = score_volume(map, local, region, step, stop);
    stop.check();
    result.candidates = find_peaks(result.volume, map.options());
    for (MatchCandidate& candidate : result.candidates) {
      candidate = climb(map, local, candidate, result.volume.yaws.size() > 1, stop);
    }
    std::stable_sort(
        result.candidates.begin(), result.candidates.end(),
        [](const MatchCandidate& a, const MatchCandidate& b) { return a.score > b.score; });
  }
  if (result.candidates.empty()) {
    result.status = failure(result.volume, map.options().min_valid_weight);
    return result;
  }
  result.peak_ratio = peak_ratio(result.volume, result.candidates);
  result.status = result.peak_ratio >= map.options().ambiguous_peak_ratio ? MatchStatus::kAmbiguous
                                                                          : MatchStatus::kOk;
  return result;
}

std::vector<PoseScore> score_poses(const MapIndex& map, const Template& local,
                                   std::span<const Pose2> map_from_robot, const StopToken& stop) {
  if (takes_surfaces(map, local, map_from_robot)) {
    return score_by_surfaces(map, local, map_from_robot, stop);
  }
  return backend_of(map.options()).score_poses(map, local, map_from_robot, stop);
}

}  // namespace nadir
