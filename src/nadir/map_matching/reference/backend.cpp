// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include "nadir/core/score_volume.hpp"
#include "nadir/map_matching/reference/scores.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

/// Pairs of one placement, and how much of the template's weight they are.
struct Placement {
  reference::PixelPairs pairs;
  double seen_on_map = 0.0;  ///< weight of seen template pixels on valid map pixels
  double seen = 0.0;         ///< weight of all seen template pixels
};

PoseScore score_of(const Placement& placement, const MatchingOptions& options) {
  const double share = placement.seen > 0.0 ? placement.seen_on_map / placement.seen : 0.0;
  if (share < options.min_valid_weight) return {kUndefinedScore, share};
  return {reference::score(options.score, placement.pairs), share};
}

/// The map below a rotated template, pixel on pixel.
Placement place(const ChannelImage& map, const RotatedTemplate& local, const PixelRole& role,
                int robot_column, int robot_row) {
  Placement placement;
  for (int row = 0; row < local.value.height(); ++row) {
    for (int column = 0; column < local.value.width(); ++column) {
      if (local.mask.at(column, row) == 0.0F) continue;
      const int u = robot_column + local.left + column;
      const int v = robot_row + local.top + row;
      const bool on_map = map.value.contains(u, v) && map.valid.at(u, v) != 0;
      placement.seen += local.seen.at(column, row);
      if (on_map) placement.seen_on_map += local.seen.at(column, row);
      if (!on_map && !role.whole_square) continue;
      placement.pairs.map.push_back(on_map ? map.value.at(u, v) : kHoleGrey);
      placement.pairs.local.push_back(local.value.at(column, row));
      placement.pairs.weight.push_back(local.weight.at(column, row));
    }
  }
  return placement;
}

/// Bilinear; nothing where one of the four map pixels is a hole, unless holes are white.
std::optional<double> sample_map(const ChannelImage& map, PixelCoordinate at, bool white_holes) {
  const double column = at.column - 0.5;
  const double row = at.row - 0.5;
  const double left = std::floor(column);
  const double top = std::floor(row);
  double sum = 0.0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const double share = (i == 0 ? 1.0 - (column - left) : column - left) *
                           (j == 0 ? 1.0 - (row - top) : row - top);
      const int u = static_cast<int>(left) + i;
      const int v = static_cast<int>(top) + j;
      const bool valid = map.value.contains(u, v) && map.valid.at(u, v) != 0;
      if (!valid && !white_holes) return std::nullopt;
      sum += share * (valid ? map.value.at(u, v) : kHoleGrey);
    }
  }
  return sum;
}

/// The map sampled under every pixel of the template.
Placement place(const ChannelImage& map, const ChannelImage& local, const PixelRole& role,
                const Pose2& map_from_robot) {
  Placement placement;
  for (int row = 0; row < local.value.height(); ++row) {
    for (int column = 0; column < local.value.width(); ++column) {
      const bool seen = local.valid.at(column, row) != 0;
      if (!seen && !role.whole_square) continue;
      const PixelCoordinate centre{column + 0.5, row + 0.5};
      const double weight = role.weighted ? pixel_weight(role.weight, centre, local.value.width(),
                                                         local.value.height())
                                          : 1.0;
      const Point2<frames::Map> point =
          map_from_robot *
          Point2<frames::Robot>{local.geo.x_at(centre.column), local.geo.y_at(centre.row)};
      const PixelCoordinate below = map.geo.pixel_at(point.x, point.y);
      const bool on_map = sample_map(map, below, false).has_value();
      const double compared = role.weighted_norms ? weight : 1.0;
      if (seen) placement.seen += compared;
      if (seen && on_map) placement.seen_on_map += compared;
      if (!on_map && !role.whole_square) continue;
      placement.pairs.map.push_back(*sample_map(map, below, role.whole_square));
      placement.pairs.local.push_back(seen ? local.value.at(column, row) : kHoleGrey);
      placement.pairs.weight.push_back(weight);
    }
  }
  return placement;
}

class ReferenceBackend : public MatchingBackend {
 public:
  std::vector<ScoreSurface> score_surfaces(const MapIndex& map,
                                           std::span<const RotatedTemplate> templates,
                                           const PixelWindow& window,
                                           const StopToken& stop) const override {
    const PixelRole role = pixel_role(map.options());
    std::vector<ScoreSurface> surfaces;
    for (const RotatedTemplate& local : templates) {
      ScoreSurface surface{Raster<float>(window.width, window.height),
                           Raster<float>(window.width, window.height)};
      for (int row = 0; row < window.height; ++row) {
        for (int column = 0; column < window.width; ++column) {
          stop.check();
          const PoseScore score =
              score_of(place(map.channel(), local, role, window.left + column, window.top + row),
                       map.options());
          surface.score.at(column, row) = static_cast<float>(score.score);
          surface.valid_weight.at(column, row) = static_cast<float>(score.valid_weight);
        }
      }
      surfaces.push_back(std::move(surface));
    }
    return surfaces;
  }

  std::vector<PoseScore> score_poses(const MapIndex& map, const Template& local,
                                     std::span<const Pose2> map_from_robot,
                                     const StopToken& stop) const override {
    const PixelRole role = pixel_role(map.options());
    std::vector<PoseScore> scores;
    for (const Pose2& pose : map_from_robot) {
      stop.check();
      scores.push_back(score_of(place(map.channel(), local.channel, role, pose), map.options()));
    }
    return scores;
  }
};

}  // namespace

const MatchingBackend& reference_backend() {
  static const ReferenceBackend backend;
  return backend;
}

}  // namespace nadir
