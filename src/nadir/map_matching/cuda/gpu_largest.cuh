// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <vector>

#include "nadir/map_matching/cuda/peak_kernels.hpp"

namespace nadir::cuda {

/// Device::largest() by CUB: takes the keys that are not 0, sorts them, brings the first back.
std::vector<PeakKey> gpu_largest(const PeakKey* keys, std::size_t count, std::size_t wanted,
                                 cudaStream_t stream);

}  // namespace nadir::cuda
