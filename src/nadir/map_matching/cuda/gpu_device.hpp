// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "nadir/map_matching/cuda/device.hpp"

namespace nadir::cuda {

/// A GPU with streams of its own: the one that CUDA lists first (CUDA_VISIBLE_DEVICES chooses).
/// Throws Error (processing) where there is none, or its driver is older than this build's runtime.
std::unique_ptr<Device> make_gpu_device();

/// What make_gpu_device() would say; empty where it would work.
std::string why_no_gpu();

/// Versions of the runtime and of cuFFT.
std::string gpu_library_version();

/// Bytes a second that a copy within the device's memory reads and writes: the roof of all that
/// computes little. 0 where the build has no CUDA.
double gpu_copy_bytes_per_s();

}  // namespace nadir::cuda
