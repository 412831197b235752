// SPDX-License-Identifier: Apache-2.0
// Times of map matching on a synthetic place of the size of the Aero-Ground run (400 x 1150 px,
// local maps of 180 x 180 px). Results are compared with the reference before a time counts.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "map_matching/random_maps.hpp"
#include "nadir/localizer.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

const test::Texture kTexture(1);
const Pose2 kTruth{20.0, 57.0, radians(-94.0)};

const Orthomosaic& map_image() {
  static const Orthomosaic image =
      test::render(kTexture, 416, 1158, {0.0, 115.8, 0.1, {}}, Pose2{});
  return image;
}

const Orthomosaic& local_image() {
  static const Orthomosaic image = [] {
    Orthomosaic local = test::render(kTexture, 180, 180, test::centred(180, 180, 0.1), kTruth);
    test::punch_holes(local, 1, 0.35);
    return local;
  }();
  return image;
}

MatchingOptions options_of(Score score) {
  MatchingOptions options;
  options.score = score;
  return options;
}

std::vector<Pose2> cloud(std::size_t count) {
  const RandomStream random(1, 1);
  std::vector<Pose2> poses;
  for (std::uint64_t i = 0; i < count; ++i) {
    poses.push_back({kTruth.x + random.uniform(3 * i, -1.0, 1.0),
                     kTruth.y + random.uniform(3 * i + 1, -1.0, 1.0),
                     kTruth.yaw + random.uniform(3 * i + 2, -0.05, 0.05)});
  }
  return poses;
}

/// Ends the program where the fast backend does not agree with the reference.
void require_equality(Score score) {
  const MapIndex map(map_image(), options_of(score));
  const Template local = make_template(local_image(), map.options());
  const std::vector<Pose2> poses = cloud(20);
  const auto fast = cpu_backend().score_poses(map, local, poses);
  const auto slow = reference_backend().score_poses(map, local, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (std::abs(fast[i].score - slow[i].score) <= 3e-4) continue;
    std::fprintf(stderr, "%s: %.9g, but the reference says %.9g\n", to_string(score).c_str(),
                 fast[i].score, slow[i].score);
    std::exit(1);
  }
}

void whole_map_one_heading(benchmark::State& state) {
  const auto score = static_cast<Score>(state.range(0));
  const MapIndex map(map_image(), options_of(score));
  const Template local = make_template(local_image(), map.options());
  const std::vector<RotatedTemplate> templates = {
      rotate_template(local.channel, kTruth.yaw, 0.1, pixel_role(map.options()))};
  const PixelWindow window{0, 0, map.channel().value.width(), map.channel().value.height()};
  for (auto _ : state) {
    benchmark::DoNotOptimize(cpu_backend().score_surfaces(map, templates, window));
  }
  state.SetLabel(to_string(score));
}
BENCHMARK(whole_map_one_heading)
    ->Arg(static_cast<int>(Score::kZwncc))
    ->Arg(static_cast<int>(Score::kNcc))
    ->Arg(static_cast<int>(Score::kWnccPaper))
    ->Unit(benchmark::kMillisecond);

void thousand_poses(benchmark::State& state) {
  const auto score = static_cast<Score>(state.range(0));
  require_equality(score);
  const MapIndex map(map_image(), options_of(score));
  const Template local = make_template(local_image(), map.options());
  const std::vector<Pose2> poses = cloud(1000);
  for (auto _ : state) benchmark::DoNotOptimize(score_poses(map, local, poses));
  state.SetLabel(to_string(score));
}
BENCHMARK(thousand_poses)
    ->Arg(static_cast<int>(Score::kZwncc))
    ->Arg(static_cast<int>(Score::kWncc))
    ->Arg(static_cast<int>(Score::kWnccPaper))
    ->Unit(benchmark::kMillisecond);

void registration(benchmark::State& state) {
  const Orthomosaic later = test::render(kTexture, 180, 180, test::centred(180, 180, 0.1),
                                         kTruth * Motion2{0.5, 0.1, 0.0});
  for (auto _ : state) {
    benchmark::DoNotOptimize(register_local_maps(local_image(), later, {}));
  }
}
BENCHMARK(registration)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace nadir

BENCHMARK_MAIN();
