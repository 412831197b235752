// SPDX-License-Identifier: Apache-2.0
// Stands in for the backend `cuda` where the build has none.
#include "nadir/core/error.hpp"
#include "nadir/map_matching/cuda/gpu_device.hpp"
#include "nadir/map_matching/cuda_status.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {

const MatchingBackend& cuda_backend() {
  throw Error(ErrorKind::kUsage, "this build has no CUDA backend", "map_matching.backend",
              "use cpu, or build with CUDA's nvcc and -DNADIR_WITH_CUDA=ON");
}

double cuda::gpu_copy_bytes_per_s() { return 0.0; }

std::string cuda_version() { return {}; }

CudaStatus cuda_status() { return {false, false, "not part of this build"}; }

}  // namespace nadir
