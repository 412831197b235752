// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "nadir/map_matching/cuda/correlation_kernels.hpp"
#include "nadir/map_matching/cuda/direct_kernels.hpp"
#include "nadir/map_matching/cuda/level_kernels.hpp"
#include "nadir/map_matching/cuda/peak_kernels.hpp"
#include "nadir/map_matching/cuda/pose_kernels.hpp"
#include "nadir/map_matching/cuda/turn_kernels.hpp"

namespace nadir::cuda {

/// All that can be launched. A kernel is a value with its arguments in it. It either does `items()`
/// independent things by `run(item)`, or reduces each of `blocks()`: `partial(block, thread)` of
/// kThreads threads, added pairwise by `merge`, handed to `finish(block, sum)`.
using Kernel = std::variant<TurnTemplates, SumTemplates, MapPlanes, TemplatePlanes, MultiplySpectra,
                            AssembleScores, SumDeviations, WindowMoments, FindLevels, LevelPlanes,
                            MultiplyLevels, AddLevels, PadMap, DirectSurfaces, ScorePoses,
                            ScoreDeviations, MarkPeaks>;

template <class Body>
inline constexpr bool kReduces =
    std::is_same_v<Body, SumTemplates> || std::is_same_v<Body, SumDeviations> ||
    std::is_same_v<Body, FindLevels> || std::is_same_v<Body, ScorePoses> ||
    std::is_same_v<Body, ScoreDeviations>;

/// Real two-dimensional transforms of many planes at once, in place and not normalised.
class BatchedFft {
 public:
  virtual ~BatchedFft() = default;
  virtual void forward(float* planes) = 0;
  virtual void inverse(float* planes) = 0;
};

/// What the backend needs of a GPU. All work of one stream is done in order; the streams run beside
/// each other. The tests implement it on the CPU with the same kernels. Not for several threads at
/// once. Throws Error (processing) where the device fails.
class Device {
 public:
  static constexpr int kStreams = 2;

  virtual ~Device() = default;

  virtual std::string name() const = 0;
  /// Bytes that one call may fill with intermediate planes.
  virtual std::size_t workspace_bytes() const = 0;

  virtual void* allocate(std::size_t bytes) = 0;
  virtual void release(void* memory) noexcept = 0;
  /// Memory of the host from and to which copies run beside other work.
  virtual void* allocate_staging(std::size_t bytes) = 0;
  virtual void release_staging(void* memory) noexcept = 0;

  virtual void upload(void* to, const void* from, std::size_t bytes, int stream) = 0;
  virtual void download(void* to, const void* from, std::size_t bytes, int stream) = 0;
  virtual void launch(const Kernel& kernel, int stream) = 0;
  virtual std::unique_ptr<BatchedFft> make_fft(PlaneShape shape, int batch, int stream) = 0;
  /// The `wanted` largest keys that are not 0, largest first. Waits for the stream.
  virtual std::vector<PeakKey> largest(const PeakKey* keys, std::size_t count, std::size_t wanted,
                                       int stream) = 0;
  virtual void wait(int stream) = 0;
};

/// Memory that grows and is kept: of the device, or of the host for staging.
template <class T, bool Staged = false>
class Memory {
 public:
  explicit Memory(Device& device) : device_(&device) {}
  Memory(Memory&& other) noexcept
      : device_(other.device_),
        data_(std::exchange(other.data_, nullptr)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  Memory& operator=(Memory&&) = delete;
  ~Memory() { release(); }

  T* data() const { return data_; }

  /// Room for `count`; what was in it is lost where it grows. No work may be using it.
  T* reserve(std::size_t count) {
    if (count <= capacity_) return data_;
    release();
    const std::size_t bytes = count * sizeof(T);
    data_ = static_cast<T*>(Staged ? device_->allocate_staging(bytes) : device_->allocate(bytes));
    capacity_ = count;
    return data_;
  }

 private:
  void release() noexcept {
    if (data_ == nullptr) return;
    Staged ? device_->release_staging(data_) : device_->release(data_);
    data_ = nullptr;
    capacity_ = 0;
  }

  Device* device_;
  T* data_ = nullptr;
  std::size_t capacity_ = 0;
};
template <class T>
using Staging = Memory<T, true>;

}  // namespace nadir::cuda
