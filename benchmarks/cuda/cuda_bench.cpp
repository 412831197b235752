// SPDX-License-Identifier: Apache-2.0
// Times of the CUDA backend beside the floor that the memory of the GPU sets, on a synthetic place
// of the size of the Aero-Ground run. Results are compared with the reference before a time counts.
//   nadir_bench_cuda             on the GPU; says so and ends where none is usable
//   nadir_bench_cuda --emulate   the same program on the CPU and on a tiny place: a test of itself
// --json prints {"device", "cuda", "copy_bytes_per_s", "tasks": [{"task", "median_s", "floor_s"}]}
// on stdout instead, where nothing is known null; the exit code is 0 then only if something was
// measured.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

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

/// What was measured: printed line by line, or as one document at the end.
class Report {
 public:
  explicit Report(bool json) : json_(json) {}

  void say(const std::string& text) const {
    if (!json_) std::puts(text.c_str());
  }
  /// `floor_s` 0 = unknown.
  void add(const std::string& task, double seconds, double floor_s) {
    timings_.push_back({task, seconds, floor_s});
    if (json_) return;
    std::printf("%-44s %9.3f ms", task.c_str(), 1e3 * seconds);
    if (floor_s > 0.0) {
      std::printf("   floor %7.3f ms   ratio %5.2f", 1e3 * floor_s, seconds / floor_s);
    }
    std::puts("");
    std::fflush(stdout);
  }
  void end(const std::string& device, double bytes_per_s) const {
    if (!json_) return;
    std::printf("{\"device\": \"%s\", \"cuda\": \"%s\", \"copy_bytes_per_s\": %s, \"tasks\": [",
                device.c_str(), cuda_version().c_str(), number(bytes_per_s).c_str());
    for (std::size_t i = 0; i < timings_.size(); ++i) {
      std::printf("%s{\"task\": \"%s\", \"median_s\": %s, \"floor_s\": %s}", i == 0 ? "" : ", ",
                  timings_[i].task.c_str(), number(timings_[i].seconds).c_str(),
                  number(timings_[i].floor_s).c_str());
    }
    std::puts("]}");
  }

 private:
  struct Timing {
    std::string task;
    double seconds = 0.0;
    double floor_s = 0.0;
  };

  static std::string number(double value) {
    if (!(value > 0.0)) return "null";
    char text[32];
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
  }

  bool json_;
  std::vector<Timing> timings_;
};

/// All headings, the best places only: the whole-map search.
void whole_map(const Bench& bench, Score score, Report& report) {
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
  report.add("whole map, " + std::to_string(yaws.size()) + " headings, " + to_string(score),
             seconds, floor_s);
}

/// Table I of the paper: every position of the map, one heading, every score.
void table_one(const Bench& bench, Score score, Report& report) {
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
  report.add("Table I, every position, " + to_string(score), seconds, 0.0);
}

void particles(const Bench& bench, Score score, std::size_t count, Report& report) {
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
  report.add(std::to_string(count) + " particles, exact, " + to_string(score), seconds, 0.0);
}

void run(const Bench& bench, Report& report) {
  if (bench.bytes_per_s > 0.0) {
    report.say("a copy on the device moves " +
               std::to_string(std::lround(1e-9 * bench.bytes_per_s)) + " GB/s (read and written)");
  }
  for (const Score score : {Score::kZwncc, Score::kZncc, Score::kWncc}) {
    whole_map(bench, score, report);
  }
  for (const auto& [score, name] : kScoreNames) table_one(bench, score, report);
  particles(bench, Score::kZwncc, bench.place.poses, report);
  particles(bench, Score::kZwncc, 10 * bench.place.poses, report);
  particles(bench, Score::kWnccPaper, bench.place.poses, report);
}

int run_emulated(Report& report) {
  const cuda::DeviceBackend emulated([] { return std::make_unique<test::EmulatedDevice>(); });
  report.say("EMULATED on the CPU, on a tiny place: these times say nothing about a GPU");
  run(make_bench(emulated, {80, 110, 40, 4, 20, 1}, 0.0), report);
  report.end("emulated", 0.0);
  return 0;
}

int run_on_gpu(Report& report, bool json) {
  const CudaStatus status = cuda_status();
  const auto* gpu =
      status.usable ? dynamic_cast<const cuda::DeviceBackend*>(&cuda_backend()) : nullptr;
  if (gpu == nullptr) {
    std::fprintf(json ? stderr : stdout, "nothing measured: CUDA cannot be used here: %s\n",
                 status.detail.c_str());
    return json ? 1 : 0;
  }
  report.say(status.detail + "; CUDA " + cuda_version());
  const double bytes_per_s = cuda::gpu_copy_bytes_per_s();
  run(make_bench(*gpu, {}, bytes_per_s), report);
  report.end(status.detail, bytes_per_s);
  return 0;
}

}  // namespace
}  // namespace nadir

int main(int argc, char** argv) {
  bool json = false;
  bool emulate = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    json = json || argument == "--json";
    emulate = emulate || argument == "--emulate";
    if (argument != "--json" && argument != "--emulate") {
      std::fprintf(stderr, "usage: %s [--emulate] [--json]\n", argv[0]);
      return 2;
    }
  }
  nadir::Report report(json);
  return emulate ? nadir::run_emulated(report) : nadir::run_on_gpu(report, json);
}
