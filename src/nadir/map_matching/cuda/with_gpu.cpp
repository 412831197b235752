// SPDX-License-Identifier: Apache-2.0
// The backend `cuda` where the build has one; no_gpu.cpp stands in elsewhere.
#include "nadir/core/error.hpp"
#include "nadir/map_matching/cuda/backend.hpp"
#include "nadir/map_matching/cuda/gpu_device.hpp"
#include "nadir/map_matching/cuda_status.hpp"

namespace nadir {

const MatchingBackend& cuda_backend() {
  static const cuda::DeviceBackend backend(cuda::make_gpu_device);
  return backend;
}

std::string cuda_version() { return cuda::gpu_library_version(); }

CudaStatus cuda_status() {
  CudaStatus status{true, false, cuda::why_no_gpu()};
  if (!status.detail.empty()) return status;
  try {
    const std::string fault = cuda::self_test(cuda_backend());
    status.usable = fault.empty();
    status.detail = cuda::make_gpu_device()->name() + (fault.empty() ? "" : ": " + fault);
  } catch (const Error& error) {
    status.detail = error.what();
  }
  return status;
}

}  // namespace nadir
