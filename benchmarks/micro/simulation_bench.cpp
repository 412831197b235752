// SPDX-License-Identifier: Apache-2.0
// Times of the simulated world: the campus of 120 x 90 m with its sensors at their usual sizes.
// `process_time` is the CPU time of all threads together.
#include <benchmark/benchmark.h>

#include "nadir/simulation/simulated_drive.hpp"
#include "nadir/simulation/simulated_flight.hpp"

namespace nadir {
namespace {

const SimulatedWorld& campus() {
  static const SimulatedWorld kWorld = SimulatedWorld::make(7, WorldOptions{});
  return kWorld;
}

const SimulatedFlight& flight() {
  static const SimulatedFlight kFlight(campus(), campus().seen(flight_appearance()),
                                       FlightOptions{}, 7);
  return kFlight;
}

const SimulatedDrive& drive() {
  static const SimulatedDrive kDrive(campus(), campus().seen(drive_appearance()), RouteOptions{},
                                     7);
  return kDrive;
}

void make_world(benchmark::State& state) {
  for (auto run : state) benchmark::DoNotOptimize(SimulatedWorld::make(7, WorldOptions{}));
}
BENCHMARK(make_world)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void light_scene(benchmark::State& state) {
  campus();
  for (auto run : state) benchmark::DoNotOptimize(campus().seen(flight_appearance()));
}
BENCHMARK(light_scene)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// With the ground along its route, drawn in finest detail.
void make_drive_of_96_frames(benchmark::State& state) {
  RouteOptions route;
  route.frames = 96;
  for (auto run : state) {
    state.PauseTiming();
    const SimulatedScene scene = campus().seen(drive_appearance());
    state.ResumeTiming();
    benchmark::DoNotOptimize(SimulatedDrive(campus(), scene, route, 7));
  }
}
BENCHMARK(make_drive_of_96_frames)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void photo_1600x1200(benchmark::State& state) {
  flight();
  int photo = 0;
  for (auto run : state) {
    benchmark::DoNotOptimize(flight().render(photo));
    photo = (photo + 7) % flight().size();
  }
}
BENCHMARK(photo_1600x1200)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void stereo_pair_640x480(benchmark::State& state) {
  drive();
  int frame = 0;
  for (auto run : state) {
    benchmark::DoNotOptimize(drive().stereo(frame));
    frame = (frame + 17) % drive().size();
  }
}
BENCHMARK(stereo_pair_640x480)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void lidar_32_rings_with_camera(benchmark::State& state) {
  drive();
  int frame = 0;
  for (auto run : state) {
    benchmark::DoNotOptimize(drive().lidar(frame));
    frame = (frame + 17) % drive().size();
  }
}
BENCHMARK(lidar_32_rings_with_camera)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void true_local_map(benchmark::State& state) {
  drive();
  int frame = 0;
  for (auto run : state) {
    benchmark::DoNotOptimize(drive().true_local(frame, {}));
    frame = (frame + 17) % drive().size();
  }
}
BENCHMARK(true_local_map)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void true_orthomosaic_120x90_m(benchmark::State& state) {
  const SimulatedScene scene = campus().seen(flight_appearance());
  for (auto run : state) {
    benchmark::DoNotOptimize(scene.true_orthomosaic({0.0, 90.0, 0.1, {}}, 1200, 900));
  }
}
BENCHMARK(true_orthomosaic_120x90_m)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace nadir

BENCHMARK_MAIN();
