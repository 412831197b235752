// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "nadir/core/stop.hpp"

namespace nadir {

/// How a pipeline runs, and whom it tells. Every pipeline takes one; it prints nothing itself.
struct PipelineContext {
  bool overwrite = false;       ///< an output that nadir wrote may be replaced
  std::uint64_t seed = 7;       ///< of all random numbers: same seed, same output
  int threads = 0;              ///< 0 = as many as this process may use
  std::string device = "auto";  ///< or "cpu", "cuda"
  StopToken stop;               ///< asked often; the pipeline then throws Stopped
  /// Told how far a stage has come, from the thread that called the pipeline; may be empty.
  std::function<void(const std::string& stage, int done, int total)> progress = {};
  /// Told what a person should know and no result says, one sentence a call; may be empty.
  std::function<void(const std::string& sentence)> note = {};
  /// The command that the work is part of, for the manifest; may be empty.
  std::vector<std::string> arguments = {};

  void report_progress(const std::string& stage, int done, int total) const {
    if (progress) progress(stage, done, total);
  }
  void say(const std::string& sentence) const {
    if (note) note(sentence);
  }
};

}  // namespace nadir
