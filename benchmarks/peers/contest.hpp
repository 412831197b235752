// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace nadir::bench {

/// One way of doing a task. `run` does it once; what it returned is compared before anything is
/// timed.
struct Contender {
  std::string name;
  std::function<void()> run;
  /// Largest and root mean square difference to the reference; nothing where the definition
  /// differs.
  std::optional<double> max_abs_diff;
  std::optional<double> rms_diff;
  /// A difference above it ends the program: a fast wrong result is no result.
  double allowed_diff = 0.0;
  /// The task is this many times what `run` does.
  double extrapolate = 1.0;
  /// By the clock of the wall where it uses several threads, else by that of the thread.
  bool wall = false;
};

struct Timing {
  double median_s = 0.0;
  double ratio_to_ours = 1.0;
  std::optional<double> max_abs_diff;
  std::optional<double> rms_diff;
};
using Timings = std::map<std::string, Timing>;

/// Checks every contender, then runs all of them in turn `rounds` times. `ours` is the one that
/// ratios are to. Throws std::runtime_error where a difference is larger than allowed.
Timings contest(const std::string& task, std::vector<Contender>& contenders,
                const std::string& ours, int rounds);

/// Seconds that this thread has computed.
double thread_seconds();

}  // namespace nadir::bench
