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

// How cost grows: the size of the map, of the template, headings, poses, threads. The time that
// counts is of the whole process, so that threads are added up; of threads, the wall's.

/// A square map of `side` pixels and a square template.
struct Place {
  Place(int side, int local_side, PoseScoring scoring = PoseScoring::kAuto)
      : map(test::render(kTexture, side, side, {0.0, 0.1 * side, 0.1, {}}, Pose2{}),
            [&] {
              MatchingOptions options = options_of(Score::kZwncc);
              options.pose_scoring = scoring;
              return options;
            }()),
        centre{0.05 * side, 0.05 * side, 0.3},
        local(make_template(test::render(kTexture, local_side, local_side,
                                         test::centred(local_side, local_side, 0.1), centre),
                            map.options())) {}
  void surfaces(int headings) const {
    std::vector<double> yaws;
    for (int k = 0; k < headings; ++k) yaws.push_back(centre.yaw + 0.05 * k);
    const auto templates = rotate_templates(local.channel, yaws, 0.1, pixel_role(map.options()));
    const int side = map.channel().value.width();
    benchmark::DoNotOptimize(cpu_backend().score_surfaces(map, templates, {0, 0, side, side}));
  }
  MapIndex map;
  Pose2 centre;
  Template local;
};

void growth_map_side(benchmark::State& state) {
  const Place place(static_cast<int>(state.range(0)), 180);
  for (auto _ : state) place.surfaces(1);
}
BENCHMARK(growth_map_side)->RangeMultiplier(2)->Range(256, 2048)->MeasureProcessCPUTime();

void growth_template_side(benchmark::State& state) {
  const Place place(768, static_cast<int>(state.range(0)));
  for (auto _ : state) place.surfaces(1);
}
BENCHMARK(growth_template_side)->RangeMultiplier(2)->Range(32, 512)->MeasureProcessCPUTime();

void growth_headings(benchmark::State& state) {
  const Place place(384, 128);
  for (auto _ : state) place.surfaces(static_cast<int>(state.range(0)));
}
BENCHMARK(growth_headings)->RangeMultiplier(4)->Range(1, 64)->MeasureProcessCPUTime();

void growth_poses(benchmark::State& state, PoseScoring scoring) {
  const Place place(400, 180, scoring);
  const RandomStream random(1, 1);
  std::vector<Pose2> poses;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(state.range(0)); ++i) {
    poses.push_back({place.centre.x + random.uniform(3 * i, -5.0, 5.0),
                     place.centre.y + random.uniform(3 * i + 1, -5.0, 5.0),
                     place.centre.yaw + random.uniform(3 * i + 2, -0.087, 0.087)});
  }
  for (auto _ : state) benchmark::DoNotOptimize(score_poses(place.map, place.local, poses));
}
BENCHMARK_CAPTURE(growth_poses, exact, PoseScoring::kExact)
    ->RangeMultiplier(4)
    ->Range(64, 16384)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(growth_poses, surface, PoseScoring::kSurface)
    ->RangeMultiplier(4)
    ->Range(64, 16384)
    ->MeasureProcessCPUTime();

void growth_threads(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(state.range(0)));
  const Place place(768, 180);
  for (auto _ : state) place.surfaces(8);
}
BENCHMARK(growth_threads)->RangeMultiplier(2)->Range(1, 4)->UseRealTime();

}  // namespace
}  // namespace nadir

BENCHMARK_MAIN();
