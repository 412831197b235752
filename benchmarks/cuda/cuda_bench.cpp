// SPDX-License-Identifier: Apache-2.0
// Times of the CUDA backend beside the floor that the memory of the GPU sets, on a synthetic place
// of the size of the Aero-Ground run. Results are compared with the reference before a time counts.
//   nadir_bench_cuda             on the GPU; says so and ends where none is usable
//   nadir_bench_cuda --emulate   the same program on the CPU and on a tiny place: a test of itself
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "map_matching/emulated_device.hpp"
#include "map_matching/random_maps.hpp"
#include "nadir/map_matching/cuda/backend.hpp"
#include "nadir/map_matching/cuda/device_map.hpp"
#include "nadir/map_matching/cuda/gpu_device.hpp"
#include "nadir/map_matching/cuda_status.hpp"
#include "roof.hpp"

namespace nadir {
namespace {

struct Place {
  int map_width = 416;
  int map_height = 1158;
  int local_size = 180;
  int headings = 360;
  std::size_t poses = 1000;
  int runs = 21;
};

struct Bench {
  const cuda::DeviceBackend& backend;
  MatchingOptions options;
  Place place;
  double bytes_per_s = 0.0;  ///< of a copy on the device; 0 = unknown

  Orthomosaic map;
  Orthomosaic local;
  Pose2 truth;
};

Bench make_bench(const cuda::DeviceBackend& backend, const Place& place, double bytes_per_s) {
  const test::Texture texture(1);
  Bench bench{backend, {}, place, bytes_per_s, {}, {}, {}};
  bench.truth = {0.048 * place.map_width, 0.049 * place.map_height, radians(-94.0)};
  bench.map = test::render(texture, place.map_width, place.map_height,
                           {0.0, 0.1 * place.map_height, 0.1, {}}, Pose2{});
  bench.local = test::render(texture, place.local_size, place.local_size,
                             test::centred(place.local_size, place.local_size, 0.1), bench.truth);
  test::punch_holes(bench.local, 1, 0.35);
  return bench;
}

MatchingOptions options_of(Score score) {
  MatchingOptions options;
  options.score = score;
  return options;
}

double median_s(int runs, const std::function<void()>& work) {
  work();  // plans, memory, clocks
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + runs / 2, seconds.end());
  return seconds[static_cast<std::size_t>(runs / 2)];
}

void require_near(double value, double reference, double tolerance, const std::string& what) {
  const bool both_undefined = std::isnan(value) && std::isnan(reference);
  if (both_undefined || std::abs(value - reference) <= tolerance * (1.0 + std::abs(reference))) {
    return;
  }
  std::fprintf(stderr, "%s: %.9g, but the reference says %.9g\n", what.c_str(), value, reference);
  std::exit(1);
}

void report(const std::string& task, double seconds, double floor_s) {
  if (floor_s > 0.0) {
    std::printf("%-44s %9.3f ms   floor %7.3f ms   ratio %5.2f\n", task.c_str(), 1e3 * seconds,
                1e3 * floor_s, seconds / floor_s);
  } else {
    std::printf("%-44s %9.3f ms\n", task.c_str(), 1e3 * seconds);
  }
  std::fflush(stdout);
}

/// All headings, the best places only: the whole-map search.
void whole_map(const Bench& bench, Score score) {
  const MapIndex map(bench.map, options_of(score));
  const Template local = make_template(bench.local, map.options());
  const PixelWindow window{0, 0, map.channel().value.width(), map.channel().value.height()};
  std::vector<double> yaws;
  for (int i = 0; i < bench.place.headings; ++i) {
    yaws.push_back(radians(-94.0) + 2.0 * kPi * i / bench.place.headings);
  }
  const cuda::KeptMap kept(bench.backend, map);
  std::vector<cuda::Place> places;
  const double seconds =
      median_s(bench.place.runs, [&] { places = kept.best_places(local, yaws, window, 64); });
  for (const std::size_t rank : {std::size_t{0}, places.size() / 2, places.size() - 1}) {
    const cuda::Place& at = places[rank];
    const auto expected = reference_backend().score_surfaces(
        map,
        std::vector{rotate_template(local.channel, yaws[at.yaw], 0.1, pixel_role(map.options()))},
        {window.left + at.column, window.top + at.row, 1, 1});
    require_near(at.score, expected[0].score.at(0, 0), 1e-4, "whole map, " + to_string(score));
  }
  const double floor_s =
      bench.bytes_per_s > 0.0
          ? bench::search_bytes(cuda::rule_of(map.options()).formula, kept.shape(), window,
                                bench.place.local_size, bench.place.headings) /
                bench.bytes_per_s
          : 0.0;
  report("whole map, " + std::to_string(yaws.size()) + " headings, " + to_string(score), seconds,
         floor_s);
}

/// Table I of the paper: every position of the map, one heading, every score.
void table_one(const Bench& bench, Score score) {
  MatchingOptions options = options_of(score);
  options.channel = Channel::kGrey;
  const MapIndex map(bench.map, options);
  const Template local = make_template(bench.local, options);
  const PixelWindow window{0, 0, map.channel().value.width(), map.channel().value.height()};
  const std::vector<RotatedTemplate> templates = {
      rotate_template(local.channel, 0.0, 0.1, pixel_role(options))};
  const cuda::KeptMap kept(bench.backend, map);
  std::vector<ScoreSurface> surfaces;
  const double seconds =
      median_s(bench.place.runs, [&] { surfaces = kept.score_surfaces(templates, window); });
  const PixelWindow sample{window.width / 2, window.height / 2, 3, 2};
  const auto expected = reference_backend().score_surfaces(map, templates, sample);
  for (int i = 0; i < 6; ++i) {
    require_near(surfaces[0].score.at(sample.left + i % 3, sample.top + i / 3),
                 expected[0].score.at(i % 3, i / 3), 1e-3, "Table I, " + to_string(score));
  }
  report("Table I, every position, " + to_string(score), seconds, 0.0);
}

void particles(const Bench& bench, Score score, std::size_t count) {
  const MapIndex map(bench.map, options_of(score));
  const Template local = make_template(bench.local, map.options());
  const RandomStream random(1, 1);
  std::vector<Pose2> poses;
  for (std::uint64_t i = 0; i < count; ++i) {
    poses.push_back({bench.truth.x + random.uniform(3 * i, -1.0, 1.0),
                     bench.truth.y + random.uniform(3 * i + 1, -1.0, 1.0),
                     bench.truth.yaw + random.uniform(3 * i + 2, -0.05, 0.05)});
  }
  const cuda::KeptMap kept(bench.backend, map);
  std::vector<PoseScore> scores;
  const double seconds =
      median_s(bench.place.runs, [&] { scores = kept.score_poses(local, poses); });
  const auto some = std::span<const Pose2>(poses).first(std::min<std::size_t>(count, 10));
  const auto expected = reference_backend().score_poses(map, local, some);
  for (std::size_t i = 0; i < some.size(); ++i) {
    require_near(scores[i].score, expected[i].score, 3e-4, "particles, " + to_string(score));
  }
  report(std::to_string(count) + " particles, exact, " + to_string(score), seconds, 0.0);
}

void run(const Bench& bench) {
  if (bench.bytes_per_s > 0.0) {
    std::printf("a copy on the device moves %.0f GB/s (read and written)\n",
                1e-9 * bench.bytes_per_s);
  }
  for (const Score score : {Score::kZwncc, Score::kZncc, Score::kWncc}) whole_map(bench, score);
  for (const auto& [score, name] : kScoreNames) table_one(bench, score);
  particles(bench, Score::kZwncc, bench.place.poses);
  particles(bench, Score::kZwncc, 10 * bench.place.poses);
  particles(bench, Score::kWnccPaper, bench.place.poses);
}

}  // namespace
}  // namespace nadir

int main(int argc, char** argv) {
  using namespace nadir;
  if (argc == 2 && std::string(argv[1]) == "--emulate") {
    const cuda::DeviceBackend emulated([] { return std::make_unique<test::EmulatedDevice>(); });
    std::puts("EMULATED on the CPU, on a tiny place: these times say nothing about a GPU");
    run(make_bench(emulated, {80, 110, 40, 4, 20, 1}, 0.0));
    return 0;
  }
  const CudaStatus status = cuda_status();
  const auto* gpu =
      status.usable ? dynamic_cast<const cuda::DeviceBackend*>(&cuda_backend()) : nullptr;
  if (gpu == nullptr) {
    std::printf("nothing measured: CUDA cannot be used here: %s\n", status.detail.c_str());
    return 0;
  }
  std::printf("%s; CUDA %s\n", status.detail.c_str(), cuda_version().c_str());
  run(make_bench(*gpu, {}, cuda::gpu_copy_bytes_per_s()));
  return 0;
}
