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

/// Throws Error (usage) where `--device` asks for a device that cannot be used here. Where `auto`
/// falls back from the GPU that this build could use, a note says why.
void require_device(const CommonOptions& common);

}  // namespace nadir::cli
