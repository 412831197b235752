// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "nadir/map_matching/cuda/device.hpp"

namespace nadir::test {

/// A cuda::Device on the CPU: it runs the kernels' own code over the same grid, block by block and
/// thread by thread, adds the partial sums of a block in the GPU's order, and transforms with
/// pocketfft. What it cannot show is what CUDA itself does: launches, copies, cuFFT, CUB.
class EmulatedDevice : public cuda::Device {
 public:
  explicit EmulatedDevice(std::size_t workspace_bytes = std::size_t{64} << 20U)
      : workspace_bytes_(workspace_bytes) {}

  std::string name() const override { return "emulated"; }
  std::size_t workspace_bytes() const override { return workspace_bytes_; }
  void* allocate(std::size_t bytes) override;
  void release(void* memory) noexcept override;
  void* allocate_staging(std::size_t bytes) override { return allocate(bytes); }
  void release_staging(void* memory) noexcept override { release(memory); }
  void upload(void* to, const void* from, std::size_t bytes, int stream) override;
  void download(void* to, const void* from, std::size_t bytes, int stream) override;
  void launch(const cuda::Kernel& kernel, int stream) override;
  std::unique_ptr<cuda::BatchedFft> make_fft(cuda::PlaneShape shape, int batch,
                                             int stream) override;
  std::vector<cuda::PeakKey> largest(const cuda::PeakKey* keys, std::size_t count,
                                     std::size_t wanted, int stream) override;
  void wait(int /*stream*/) override {}

 private:
  std::size_t workspace_bytes_;
};

}  // namespace nadir::test
