// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/threads.hpp"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "nadir/core/error.hpp"
#include "nadir/map_matching/cuda_status.hpp"

namespace nadir {
namespace {

int cores_by_affinity() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof(cores), &cores) == 0) return CPU_COUNT(&cores);
  return static_cast<int>(std::thread::hardware_concurrency());
}

/// Cores by the quota of the control group (version 2: "quota period" or "max period"); the number
/// of `cores` where there is no quota.
int cores_by_quota(int cores) {
  std::ifstream file("/sys/fs/cgroup/cpu.max");
  double quota_us = 0.0;
  double period_us = 0.0;
  if (!(file >> quota_us >> period_us) || period_us <= 0.0) return cores;
  return static_cast<int>(std::ceil(quota_us / period_us));
}

}  // namespace

int allowed_cores() {
  const int cores = cores_by_affinity();
  return std::max(1, std::min(cores, cores_by_quota(cores)));
}

ThreadLimit::ThreadLimit(int threads)
    : threads_(threads > 0 ? threads : allowed_cores()),
      control_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_)) {}

void require_device(const std::string& device) {
  if (device != "cuda") return;
  const CudaStatus status = cuda_status();
  if (status.usable) return;
  throw Error(ErrorKind::kUsage, "CUDA cannot be used: " + status.detail, "--device cuda",
              "use --device cpu or auto");
}

std::optional<std::string> device_note(const std::string& device) {
  if (device != "auto") return std::nullopt;
  const CudaStatus status = cuda_status();
  if (!status.built || status.usable) return std::nullopt;
  return "computing on the CPU: " + status.detail;
}

}  // namespace nadir
