// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <oneapi/tbb/global_control.h>

#include <optional>
#include <string>

namespace nadir {

/// The cores that this process may use: its affinity, cut by the quota of its control group.
int allowed_cores();

/// Bounds the threads of everything that runs while it lives.
class ThreadLimit {
 public:
  /// `threads` = 0: as many as this process may use.
  explicit ThreadLimit(int threads);
  int threads() const { return threads_; }

 private:
  int threads_;
  tbb::global_control control_;
};

/// Throws Error (usage) where `device` ("auto", "cpu", "cuda") is one that cannot be used here.
void require_device(const std::string& device);
/// Why "auto" falls back from the GPU that this build could use; nothing where it does not.
std::optional<std::string> device_note(const std::string& device);

}  // namespace nadir
