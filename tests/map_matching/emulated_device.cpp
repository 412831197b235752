// SPDX-License-Identifier: Apache-2.0
#include "map_matching/emulated_device.hpp"

#include <pocketfft_hdronly.h>

#include <algorithm>
#include <array>
#include <complex>
#include <cstring>
#include <new>

namespace nadir::test {
namespace {

template <class Body>
void run(const Body& body) {
  if constexpr (cuda::kReduces<Body>) {
    std::vector<typename Body::Partial> partial(static_cast<std::size_t>(Body::kThreads));
    for (int block = 0; block < body.blocks(); ++block) {
      for (int thread = 0; thread < Body::kThreads; ++thread) {
        partial[static_cast<std::size_t>(thread)] = body.partial(block, thread);
      }
      for (auto half = partial.size() / 2; half > 0; half /= 2) {
        for (std::size_t i = 0; i < half; ++i) Body::merge(partial[i], partial[i + half]);
      }
      body.finish(block, partial[0]);
    }
  } else {
    for (std::int64_t item = 0; item < body.items(); ++item) body.run(item);
  }
}

class PocketTransform : public cuda::BatchedFft {
 public:
  PocketTransform(cuda::PlaneShape shape, int batch) : shape_(shape), batch_(batch) {}

  void forward(float* planes) override {
    for (int i = 0; i < batch_; ++i) {
      float* plane = planes + i * shape_.reals();
      const std::vector<float> input(plane, plane + shape_.reals());
      pocketfft::r2c<float>(size(), reals(), complexes(), {0, 1}, true, input.data(),
                            reinterpret_cast<std::complex<float>*>(plane), 1.0F);
    }
  }
  void inverse(float* planes) override {
    for (int i = 0; i < batch_; ++i) {
      float* plane = planes + i * shape_.reals();
      const std::vector<float> input(plane, plane + shape_.reals());
      pocketfft::c2r<float>(size(), complexes(), reals(), {0, 1}, false,
                            reinterpret_cast<const std::complex<float>*>(input.data()), plane,
                            1.0F);
    }
  }

 private:
  pocketfft::shape_t size() const {
    return {static_cast<std::size_t>(shape_.height), static_cast<std::size_t>(shape_.width)};
  }
  std::ptrdiff_t row_bytes() const {
    return static_cast<std::ptrdiff_t>(sizeof(std::complex<float>)) * shape_.half();
  }
  pocketfft::stride_t reals() const { return {row_bytes(), sizeof(float)}; }
  pocketfft::stride_t complexes() const { return {row_bytes(), sizeof(std::complex<float>)}; }

  cuda::PlaneShape shape_;
  int batch_;
};

}  // namespace

void* EmulatedDevice::allocate(std::size_t bytes) {
  void* memory = ::operator new (bytes, std::align_val_t{64});
  std::memset(memory, 0xFF, bytes);  // NaN: what is read before it was written shows
  return memory;
}

void EmulatedDevice::release(void* memory) noexcept {
  ::operator delete (memory, std::align_val_t{64});
}

void EmulatedDevice::upload(void* to, const void* from, std::size_t bytes, int /*stream*/) {
  if (bytes > 0) std::memcpy(to, from, bytes);
}

void EmulatedDevice::download(void* to, const void* from, std::size_t bytes, int /*stream*/) {
  if (bytes > 0) std::memcpy(to, from, bytes);
}

void EmulatedDevice::launch(const cuda::Kernel& kernel, int /*stream*/) {
  std::visit([](const auto& body) { run(body); }, kernel);
}

std::unique_ptr<cuda::BatchedFft> EmulatedDevice::make_fft(cuda::PlaneShape shape, int batch,
                                                           int /*stream*/) {
  return std::make_unique<PocketTransform>(shape, batch);
}

std::vector<cuda::PeakKey> EmulatedDevice::largest(const cuda::PeakKey* keys, std::size_t count,
                                                   std::size_t wanted, int /*stream*/) {
  std::vector<cuda::PeakKey> best(keys, keys + count);
  std::erase(best, 0U);
  std::sort(best.begin(), best.end(), std::greater<>());
  if (best.size() > wanted) best.resize(wanted);
  return best;
}

}  // namespace nadir::test
