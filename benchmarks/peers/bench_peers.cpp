// SPDX-License-Identifier: Apache-2.0
// Our matching against others on the same tasks: equality first, then times, in one process.
//
//   nadir_bench_peers [--quick] [--data DIR] [--frame N] [--json] [--frames-lost]
//
// --frames-lost searches the whole map for the frame, or all with a truth, both coarse to fine and
// in full, and ends with 1 where the former loses one. DIR holds the Aero-Ground run; without it a
// seeded synthetic place of the same size serves.
// --json prints {task: {contender: {"median_s", "ratio_to_ours", "max_abs_diff"}}} on stdout; the
// ratio is how many times as long as ours it takes. Times are those of the computing thread, so
// that other work on the machine does not count, but for the names that end in _wall.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <opencv2/core.hpp>
#include <string>

#include "peers/tasks.hpp"

namespace {

using nadir::bench::Timings;

void print_number(const char* name, const std::optional<double>& value) {
  std::printf("\"%s\": ", name);
  if (value) std::printf("%.6g", *value);
  if (!value) std::printf("null");
}

void print_json(const std::map<std::string, Timings>& tasks) {
  const char* between_tasks = "{";
  for (const auto& [task, timings] : tasks) {
    std::printf("%s\"%s\": ", between_tasks, task.c_str());
    const char* between = "{";
    for (const auto& [contender, timing] : timings) {
      std::printf("%s\"%s\": {", between, contender.c_str());
      print_number("median_s", timing.median_s);
      std::printf(", ");
      print_number("ratio_to_ours", timing.ratio_to_ours);
      std::printf(", ");
      print_number("max_abs_diff", timing.max_abs_diff);
      std::printf(", ");
      print_number("rms_diff", timing.rms_diff);
      std::printf("}");
      between = ",\n  ";
    }
    std::printf("}");
    between_tasks = ",\n ";
  }
  std::printf("}\n");
}

void print_table(const std::map<std::string, Timings>& tasks) {
  std::printf(
      "| task | contender | median, s | times ours | largest difference | rms |\n"
      "|---|---|---|---|---|---|\n");
  const auto number = [](const std::optional<double>& value) {
    char text[32] = "-";
    if (value) std::snprintf(text, sizeof text, "%.2g", *value);
    return std::string(text);
  };
  for (const auto& [task, timings] : tasks) {
    for (const auto& [contender, timing] : timings) {
      std::printf("| %s | %s | %.4g | %.3g | %s | %s |\n", task.c_str(), contender.c_str(),
                  timing.median_s, timing.ratio_to_ours, number(timing.max_abs_diff).c_str(),
                  number(timing.rms_diff).c_str());
    }
  }
}

int run(int argc, char** argv) {
  bool quick = false;
  bool json = false;
  bool count_lost = false;
  std::string data;
  int frame = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--quick") {
      quick = true;
    } else if (argument == "--json") {
      json = true;
    } else if (argument == "--frames-lost") {
      count_lost = true;
    } else if (argument == "--data" && i + 1 < argc) {
      data = argv[++i];
    } else if (argument == "--frame" && i + 1 < argc) {
      frame = std::atoi(argv[++i]);
    } else {
      std::fprintf(stderr,
                   "usage: %s [--quick] [--data DIR] [--frame N] [--json] [--frames-lost]\n",
                   argv[0]);
      return 2;
    }
  }
  if (count_lost) {
    const std::vector<int> frames =
        frame > 0 ? std::vector<int>{frame} : nadir::bench::truth_frames(data);
    return nadir::bench::frames_lost(data, frames) == 0 ? 0 : 1;
  }
  if (frame == 0) frame = 200;
  cv::setNumThreads(1);
  const nadir::bench::Scene scene =
      data.empty() ? nadir::bench::synthetic_scene() : nadir::bench::aeroground_scene(data, frame);
  nadir::bench::Effort effort;
  if (quick) effort = {3, 40, 200};
  std::map<std::string, Timings> tasks;
  tasks["table_1"] = nadir::bench::table_one(scene, effort);
  tasks["whole_map"] = nadir::bench::whole_map(scene, effort);
  tasks["all_headings"] = nadir::bench::all_headings(scene, effort);
  tasks["1000_particles"] = nadir::bench::thousand_particles(scene, effort);
  if (json) print_json(tasks);
  if (!json) print_table(tasks);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
