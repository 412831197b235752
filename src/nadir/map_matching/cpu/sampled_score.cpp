// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/sampled_score.hpp"

#include <cmath>

#include "nadir/core/score_volume.hpp"
#include "nadir/map_matching/rotated_template.hpp"

namespace nadir::cpu {

SampledScorer::SampledScorer(const MapIndex& map, const Template& local) : map_(map) {
  const PixelRole role = pixel_role(map.options());
  whole_square_ = role.whole_square;
  const ChannelImage& channel = map.channel();
  filled_ = Raster<float>(channel.value.width(), channel.value.height(), kHoleGrey);
  for (std::size_t i = 0; i < filled_.values().size(); ++i) {
    if (channel.valid.values()[i] != 0) filled_.values()[i] = channel.value.values()[i];
  }

  const ChannelImage& image = local.channel;
  for (int row = 0; row < image.value.height(); ++row) {
    for (int column = 0; column < image.value.width(); ++column) {
      const bool seen = image.valid.at(column, row) != 0;
      if (!seen && !whole_square_) continue;
      const PixelCoordinate centre{column + 0.5, row + 0.5};
      const double weight = role.weighted ? pixel_weight(role.weight, centre, image.value.width(),
                                                         image.value.height())
                                          : 1.0;
      const double compared = !seen ? 0.0 : (role.weighted_norms ? weight : 1.0);
      pixels_.push_back({image.geo.x_at(centre.column), image.geo.y_at(centre.row),
                         seen ? image.value.at(column, row) : kHoleGrey, weight, compared});
      total_compared_ += compared;
    }
  }
}

PoseScore SampledScorer::operator()(const Pose2& map_from_robot) const {
  const Quads& quads = map_.quads();
  const GeoReference& geo = map_.channel().geo;
  const double cosine = std::cos(map_from_robot.yaw);
  const double sine = std::sin(map_from_robot.yaw);
  const PixelCoordinate robot = geo.pixel_at(map_from_robot.x, map_from_robot.y);
  const auto grey_at = [&](int u, int v) {
    return static_cast<double>(filled_.contains(u, v) ? filled_.at(u, v) : kHoleGrey);
  };

  reference::PixelPairs pairs;
  for (auto* values : {&pairs.map, &pairs.local, &pairs.weight}) values->reserve(pixels_.size());
  double compared = 0.0;
  for (const Pixel& pixel : pixels_) {
    const double column = robot.column - 0.5 + (cosine * pixel.x - sine * pixel.y) / geo.resolution;
    const double row = robot.row - 0.5 - (sine * pixel.x + cosine * pixel.y) / geo.resolution;
    const int u = static_cast<int>(std::floor(column));
    const int v = static_cast<int>(std::floor(row));
    const bool on_map = quads.words.contains(u + Quads::kMargin, v + Quads::kMargin) &&
                        quads.words.at(u + Quads::kMargin, v + Quads::kMargin) != 0;
    if (on_map) compared += pixel.compared;
    if (!on_map && !whole_square_) continue;
    const double across = column - u;
    const double down = row - v;
    const double upper = grey_at(u, v) + across * (grey_at(u + 1, v) - grey_at(u, v));
    const double lower = grey_at(u, v + 1) + across * (grey_at(u + 1, v + 1) - grey_at(u, v + 1));
    pairs.map.push_back(upper + down * (lower - upper));
    pairs.local.push_back(pixel.grey);
    pairs.weight.push_back(pixel.weight);
  }
  const double share = total_compared_ > 0.0 ? compared / total_compared_ : 0.0;
  if (share < map_.options().min_valid_weight) {
    return {kUndefinedScore, share};
  }
  return {reference::score(map_.options().score, pairs), share};
}

}  // namespace nadir::cpu
