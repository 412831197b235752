// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cuda/poses.hpp"

#include <cmath>
#include <limits>

#include "nadir/map_matching/rotated_template.hpp"

namespace nadir::cuda {
namespace {

/// The template as five lists, as the device takes them.
struct PixelLists {
  std::vector<float> x, y, value, weight, seen;
  double total_seen = 0.0;
  float mean = 0.0F;  ///< grey
};

PixelLists list_pixels(const ChannelImage& local, const PixelRole& role, double map_resolution) {
  PixelLists list;
  double grey = 0.0;
  for (int row = 0; row < local.value.height(); ++row) {
    for (int column = 0; column < local.value.width(); ++column) {
      const bool seen = local.valid.at(column, row) != 0;
      if (!seen && !role.whole_square) continue;
      const PixelCoordinate centre{column + 0.5, row + 0.5};
      const double weight = role.weighted ? pixel_weight(role.weight, centre, local.value.width(),
                                                         local.value.height())
                                          : 1.0;
      const double compared = !seen ? 0.0 : role.weighted_norms ? weight : 1.0;
      const float value = seen ? local.value.at(column, row) : kHoleGrey;
      list.x.push_back(static_cast<float>(local.geo.x_at(centre.column) / map_resolution));
      list.y.push_back(static_cast<float>(local.geo.y_at(centre.row) / map_resolution));
      list.value.push_back(value);
      list.weight.push_back(static_cast<float>(weight));
      list.seen.push_back(static_cast<float>(compared));
      list.total_seen += compared;
      grey += value;
    }
  }
  if (!list.x.empty()) list.mean = static_cast<float>(grey / static_cast<double>(list.x.size()));
  return list;
}

SampledPixels upload(DeviceMap& map, const PixelLists& list) {
  const std::size_t count = list.x.size();
  float* to = map.sampled.reserve(5 * count + 1);
  const float* at[5] = {};
  std::size_t number = 0;
  for (const auto* values : {&list.x, &list.y, &list.value, &list.weight, &list.seen}) {
    map.device->upload(to + number * count, values->data(), count * sizeof(float), 0);
    at[number] = to + number * count;
    ++number;
  }
  return {at[0], at[1], at[2], at[3], at[4], static_cast<int>(count)};
}

PixelPose pixel_pose(const GeoReference& geo, const Pose2& pose) {
  // Far outside nothing can overlap, and an integer could overflow.
  constexpr double kFarthestPx = 1e8;
  constexpr int kNowhere = -(1 << 28);
  const PixelCoordinate at = geo.pixel_at(pose.x, pose.y);
  if (!(std::abs(at.column) < kFarthestPx) || !(std::abs(at.row) < kFarthestPx) ||
      !std::isfinite(pose.yaw)) {
    return {kNowhere, kNowhere, 0.0F, 0.0F, 1.0F, 0.0F};
  }
  const double column = std::floor(at.column - 0.5);
  const double row = std::floor(at.row - 0.5);
  return {static_cast<int>(column) + Quads::kMargin,    static_cast<int>(row) + Quads::kMargin,
          static_cast<float>(at.column - 0.5 - column), static_cast<float>(at.row - 0.5 - row),
          static_cast<float>(std::cos(pose.yaw)),       static_cast<float>(std::sin(pose.yaw))};
}

}  // namespace

std::vector<PoseScore> score_poses_on(DeviceMap& on_device, const MapIndex& map,
                                      const Template& local, std::span<const Pose2> poses) {
  if (poses.empty()) return {};
  Device& device = *on_device.device;
  const GeoReference& geo = map.channel().geo;
  const PixelLists list = list_pixels(local.channel, pixel_role(map.options()), geo.resolution);
  std::vector<PixelPose> pixel_poses;
  for (const Pose2& pose : poses) pixel_poses.push_back(pixel_pose(geo, pose));

  ScorePoses kernel;
  kernel.map = on_device.quad_map;
  kernel.pixels = upload(on_device, list);
  PixelPose* to = on_device.poses.reserve(poses.size());
  device.upload(to, pixel_poses.data(), poses.size() * sizeof(PixelPose), 0);
  kernel.poses = to;
  kernel.count = static_cast<int>(poses.size());
  kernel.rule = rule_of(map.options());
  const bool shifted =
      kernel.rule.formula == Formula::kZeroMean || kernel.rule.formula == Formula::kPaper;
  if (shifted) kernel.shifts = {on_device.mean_grey, list.mean};
  kernel.total_seen = list.total_seen;
  kernel.moments = on_device.moments.reserve(poses.size());
  kernel.score = on_device.pose_scores.reserve(2 * poses.size());
  kernel.share = kernel.score + poses.size();
  device.launch(kernel, 0);
  if (kernel.rule.formula == Formula::kPaper) device.launch(ScoreDeviations{kernel}, 0);

  std::vector<double> result(2 * poses.size());
  device.download(result.data(), kernel.score, result.size() * sizeof(double), 0);
  device.wait(0);
  std::vector<PoseScore> scores;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    scores.push_back({result[i], result[poses.size() + i]});
  }
  return scores;
}

}  // namespace nadir::cuda
