// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/peaks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace nadir {
namespace {

/// A voxel of the volume.
struct Voxel {
  int column = 0;
  int row = 0;
  std::size_t yaw = 0;
  float score = 0.0F;
};

std::optional<float> score_at(const ScoreVolume& volume, int column, int row, std::size_t yaw) {
  if (yaw >= volume.score.size() || !volume.score[yaw].contains(column, row)) return std::nullopt;
  const float score = volume.score[yaw].at(column, row);
  if (std::isnan(score)) return std::nullopt;
  return score;
}

/// No neighbour in the same surface is better; of equal ones the first counts.
bool is_local_maximum(const ScoreVolume& volume, const Voxel& voxel) {
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const auto other = score_at(volume, voxel.column + i, voxel.row + j, voxel.yaw);
      if (!other || (i == 0 && j == 0)) continue;
      const bool earlier = j < 0 || (j == 0 && i < 0);
      if (*other > voxel.score || (earlier && *other == voxel.score)) return false;
    }
  }
  return true;
}

std::vector<Voxel> local_maxima(const ScoreVolume& volume) {
  std::vector<Voxel> maxima;
  for (std::size_t yaw = 0; yaw < volume.score.size(); ++yaw) {
    for (int row = 0; row < volume.score[yaw].height(); ++row) {
      for (int column = 0; column < volume.score[yaw].width(); ++column) {
        const Voxel voxel{column, row, yaw, volume.score[yaw].at(column, row)};
        if (!std::isnan(voxel.score) && is_local_maximum(volume, voxel)) maxima.push_back(voxel);
      }
    }
  }
  std::stable_sort(maxima.begin(), maxima.end(),
                   [](const Voxel& a, const Voxel& b) { return a.score > b.score; });
  return maxima;
}

/// The vertex of the parabola through (-1, before), (0, at), (1, after): where, and how high above
/// `at`. At the border, and where there is no maximum, the middle itself.
struct Vertex {
  double offset = 0.0;
  double rise = 0.0;
};
Vertex parabola_vertex(std::optional<float> before, float at, std::optional<float> after) {
  if (!before || !after) return {};
  const double slope = 0.5 * (static_cast<double>(*after) - *before);
  const double curvature = static_cast<double>(*after) - 2.0 * at + *before;
  if (curvature >= 0.0) return {};
  const double offset = std::clamp(-slope / curvature, -0.5, 0.5);
  return {offset, slope * offset + 0.5 * curvature * offset * offset};
}

MatchCandidate refine(const ScoreVolume& volume, const Voxel& voxel) {
  const auto neighbour = [&](int i, int j, int k) -> std::optional<float> {
    if (k < 0 && voxel.yaw == 0) return std::nullopt;
    return score_at(volume, voxel.column + i, voxel.row + j,
                    k < 0 ? voxel.yaw - 1 : voxel.yaw + static_cast<std::size_t>(k));
  };
  const Vertex x = parabola_vertex(neighbour(-1, 0, 0), voxel.score, neighbour(1, 0, 0));
  const Vertex y = parabola_vertex(neighbour(0, -1, 0), voxel.score, neighbour(0, 1, 0));
  const Vertex yaw = parabola_vertex(neighbour(0, 0, -1), voxel.score, neighbour(0, 0, 1));
  const double yaw_step = volume.yaws.size() > 1 ? volume.yaws[1] - volume.yaws[0] : 0.0;

  MatchCandidate candidate;
  candidate.map_from_robot = {volume.geo.x_at(voxel.column + 0.5 + x.offset),
                              volume.geo.y_at(voxel.row + 0.5 + y.offset),
                              wrap_angle(volume.yaws[voxel.yaw] + yaw.offset * yaw_step)};
  candidate.score = voxel.score + x.rise + y.rise + yaw.rise;
  candidate.valid_weight = volume.valid_weight[voxel.yaw].at(voxel.column, voxel.row);
  return candidate;
}

double median_score(const ScoreVolume& volume) {
  std::vector<float> scores;
  for (const Raster<float>& surface : volume.score) {
    for (const float score : surface.values()) {
      if (!std::isnan(score)) scores.push_back(score);
    }
  }
  if (scores.empty()) return 0.0;
  const auto middle = scores.begin() + static_cast<std::ptrdiff_t>(scores.size() / 2);
  std::nth_element(scores.begin(), middle, scores.end());
  return *middle;
}

}  // namespace

std::vector<MatchCandidate> find_peaks(const ScoreVolume& volume, const MatchingOptions& options) {
  std::vector<MatchCandidate> peaks;
  for (const Voxel& voxel : local_maxima(volume)) {
    if (peaks.size() >= static_cast<std::size_t>(options.candidates)) break;
    const MatchCandidate candidate = refine(volume, voxel);
    const bool separate = std::all_of(peaks.begin(), peaks.end(), [&](const MatchCandidate& peak) {
      return distance(peak.map_from_robot, candidate.map_from_robot) >= options.peak_separation_m;
    });
    if (separate) peaks.push_back(candidate);
  }
  std::stable_sort(
      peaks.begin(), peaks.end(),
      [](const MatchCandidate& a, const MatchCandidate& b) { return a.score > b.score; });
  return peaks;
}

double peak_ratio(const ScoreVolume& volume, const std::vector<MatchCandidate>& candidates) {
  if (candidates.size() < 2) return 0.0;
  const double floor = median_score(volume);
  const double best = candidates[0].score - floor;
  if (best <= 0.0) return 1.0;
  return std::clamp((candidates[1].score - floor) / best, 0.0, 1.0);
}

}  // namespace nadir
