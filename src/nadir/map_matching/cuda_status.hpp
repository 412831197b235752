// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace nadir {

/// Whether the backend `cuda` can be used here.
struct CudaStatus {
  bool built = false;   ///< this build contains it (NADIR_WITH_CUDA)
  bool usable = false;  ///< there is a GPU, and it gives the results of the reference
  std::string detail;   ///< which GPU, or why not
};

/// Looks for a GPU and lets it match a small map: a device or a driver that computes wrongly is not
/// usable. Takes a fraction of a second where there is a GPU.
CudaStatus cuda_status();

/// Of the CUDA runtime and cuFFT that this build has; empty where it has none.
std::string cuda_version();

}  // namespace nadir
