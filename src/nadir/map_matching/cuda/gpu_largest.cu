// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cuda/gpu_largest.cuh"

#include <algorithm>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_select.cuh>

#include "nadir/map_matching/cuda/gpu_error.cuh"

namespace nadir::cuda {
namespace {

struct IsPlace {
  __host__ __device__ bool operator()(PeakKey key) const { return key != 0; }
};

/// Memory in the order of a stream's work: from CUDA's pool, and so cheap to take.
class Scratch {
 public:
  Scratch(std::size_t bytes, cudaStream_t stream) : stream_(stream) {
    check(cudaMallocAsync(&data_, std::max<std::size_t>(bytes, 1), stream), "allocating memory");
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { cudaFreeAsync(data_, stream_); }
  template <class T>
  T* as() const {
    return static_cast<T*>(data_);
  }

 private:
  void* data_ = nullptr;
  cudaStream_t stream_;
};

}  // namespace

std::vector<PeakKey> gpu_largest(const PeakKey* keys, std::size_t count, std::size_t wanted,
                                 cudaStream_t stream) {
  const int items = static_cast<int>(count);  // a batch is far below 2^31 positions
  const Scratch places(count * sizeof(PeakKey), stream);
  const Scratch found(sizeof(int), stream);
  std::size_t bytes = 0;
  check(cub::DeviceSelect::If(nullptr, bytes, keys, places.as<PeakKey>(), found.as<int>(), items,
                              IsPlace{}, stream),
        "selecting");
  {
    const Scratch work(bytes, stream);
    check(cub::DeviceSelect::If(work.as<void>(), bytes, keys, places.as<PeakKey>(), found.as<int>(),
                                items, IsPlace{}, stream),
          "selecting");
  }
  int number = 0;
  check(cudaMemcpyAsync(&number, found.as<int>(), sizeof(int), cudaMemcpyDeviceToHost, stream),
        "copying");
  check(cudaStreamSynchronize(stream), "selecting");
  if (number == 0) return {};

  const Scratch sorted(static_cast<std::size_t>(number) * sizeof(PeakKey), stream);
  check(cub::DeviceRadixSort::SortKeysDescending(nullptr, bytes, places.as<PeakKey>(),
                                                 sorted.as<PeakKey>(), number, 0, 64, stream),
        "sorting");
  const Scratch work(bytes, stream);
  check(cub::DeviceRadixSort::SortKeysDescending(work.as<void>(), bytes, places.as<PeakKey>(),
                                                 sorted.as<PeakKey>(), number, 0, 64, stream),
        "sorting");
  std::vector<PeakKey> best(std::min(wanted, static_cast<std::size_t>(number)));
  check(cudaMemcpyAsync(best.data(), sorted.as<PeakKey>(), best.size() * sizeof(PeakKey),
                        cudaMemcpyDeviceToHost, stream),
        "copying");
  check(cudaStreamSynchronize(stream), "sorting");
  return best;
}

}  // namespace nadir::cuda
