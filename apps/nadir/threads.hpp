// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <oneapi/tbb/global_control.h>

#include "invocation.hpp"

namespace nadir::cli {

/// The cores that this process may use: its affinity, cut by the quota of its control group.
int allowed_cores();

/// Bounds the threads of everything that runs while it lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(const CommonOptions& common);
  int threads() const { return threads_; }

 private:
  int threads_;
  tbb::global_control control_;
};

/// Throws Error (usage) where `--device` asks for a device that cannot be used here.
void require_device(const CommonOptions& common);
/// Says why, where `--device auto` falls back from the GPU that this build could use. To be called
/// when the computing begins: what is refused before says its error alone.
void note_device(const CommonOptions& common);

}  // namespace nadir::cli
