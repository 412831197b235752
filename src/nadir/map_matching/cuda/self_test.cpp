// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "nadir/core/random.hpp"
#include "nadir/map_matching/cuda/backend.hpp"
#include "nadir/map_matching/rotated_template.hpp"

namespace nadir::cuda {
namespace {

constexpr double kTolerance = 1e-3;  // relative: this tells wrong from right, not good from better

Orthomosaic noise(std::uint64_t seed, int width, int height, const GeoReference& geo) {
  const RandomStream random(seed, 1);
  Orthomosaic image{Raster<std::uint8_t>(width, height), Raster<std::uint8_t>(width, height), geo};
  for (std::size_t i = 0; i < image.image.values().size(); ++i) {
    image.image.values()[i] = static_cast<std::uint8_t>(random.uniform(2 * i, 1.0, 256.0));
    image.valid.values()[i] = random.uniform(2 * i + 1) < 0.1 ? 0 : 255;
  }
  return image;
}

bool same(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) == std::isnan(b);
  return std::abs(a - b) <= kTolerance * (1.0 + std::abs(b));
}

bool same_surfaces(const MatchingBackend& backend, const MapIndex& map, const Template& local) {
  std::vector<RotatedTemplate> templates;
  for (const double yaw : {0.0, 0.7}) {
    templates.push_back(rotate_template(local.channel, yaw, map.channel().geo.resolution,
                                        pixel_role(map.options())));
  }
  const PixelWindow window{-4, -4, map.channel().value.width(), map.channel().value.height()};
  const auto tested = backend.score_surfaces(map, templates, window);
  const auto expected = reference_backend().score_surfaces(map, templates, window);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    for (std::size_t i = 0; i < expected[k].score.values().size(); ++i) {
      const double limit = map.options().min_valid_weight;
      if (std::abs(expected[k].valid_weight.values()[i] - limit) < 1e-4) continue;
      if (!same(tested[k].score.values()[i], expected[k].score.values()[i])) return false;
    }
  }
  return true;
}

bool same_poses(const MatchingBackend& backend, const MapIndex& map, const Template& local) {
  const std::vector<Pose2> poses = {{2.13, 1.71, 0.31}, {2.51, 2.02, -2.2}, {90.0, 0.0, 0.0}};
  const auto tested = backend.score_poses(map, local, poses);
  const auto expected = reference_backend().score_poses(map, local, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!same(tested[i].score, expected[i].score)) return false;
  }
  return true;
}

}  // namespace

std::string self_test(const MatchingBackend& backend) {
  for (const Score score : {Score::kZwncc, Score::kWncc, Score::kSad, Score::kWnccPaper}) {
    MatchingOptions options;
    options.score = score;
    options.channel = Channel::kGrey;
    options.min_valid_weight = 0.55;
    const MapIndex map(noise(1, 44, 36, {0.0, 3.6, 0.1, {}}), options);
    const Template local = make_template(noise(2, 15, 11, {-0.7, 0.5, 0.1, {}}), options);
    if (!same_surfaces(backend, map, local)) {
      return "its score surfaces of " + to_string(score) + " are not the reference's";
    }
    if (!same_poses(backend, map, local)) {
      return "its pose scores of " + to_string(score) + " are not the reference's";
    }
  }
  return {};
}

}  // namespace nadir::cuda
