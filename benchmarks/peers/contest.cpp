// SPDX-License-Identifier: Apache-2.0
#include "peers/contest.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <stdexcept>

namespace nadir::bench {
namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

void check(const std::string& task, const Contender& contender) {
  if (!contender.max_abs_diff || *contender.max_abs_diff <= contender.allowed_diff) return;
  throw std::runtime_error(task + ", " + contender.name + ": differs from the reference by " +
                           std::to_string(*contender.max_abs_diff));
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Timings contest(const std::string& task, std::vector<Contender>& contenders,
                const std::string& ours, int rounds) {
  for (const Contender& contender : contenders) check(task, contender);
  std::map<std::string, std::vector<double>> seconds;
  for (int round = 0; round < rounds; ++round) {
    for (const Contender& contender : contenders) {
      const auto clock = contender.wall ? wall_seconds : thread_seconds;
      const double before = clock();
      contender.run();
      seconds[contender.name].push_back((clock() - before) * contender.extrapolate);
    }
  }
  Timings timings;
  const double base = median(seconds.at(ours));
  for (const Contender& contender : contenders) {
    const double time = median(seconds.at(contender.name));
    timings[contender.name] = {time, time / base, contender.max_abs_diff, contender.rms_diff};
    std::fprintf(stderr, "%-18s %-34s %12.6f s %10.2f x\n", task.c_str(), contender.name.c_str(),
                 time, time / base);
  }
  return timings;
}

}  // namespace nadir::bench
