// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include <string>

#include "nadir/core/error.hpp"

namespace nadir::cuda {

/// Throws Error (processing) where a call of the CUDA runtime failed.
inline void check(cudaError_t status, const char* doing) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // or the next call reports it again
  const bool memory = status == cudaErrorMemoryAllocation;
  throw Error(ErrorKind::kProcessing,
              std::string("the GPU failed ") + doing + ": " + cudaGetErrorString(status), {},
              memory ? "search a smaller window, or use --device cpu" : "use --device cpu");
}

}  // namespace nadir::cuda
