// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>
#include <cufft.h>

#include <algorithm>

#include "nadir/map_matching/cuda/gpu_device.hpp"
#include "nadir/map_matching/cuda/gpu_error.cuh"
#include "nadir/map_matching/cuda/gpu_largest.cuh"

namespace nadir::cuda {
namespace {

constexpr int kThreads = 256;

template <class Body>
__global__ void run_items(Body body) {
  const std::int64_t step = static_cast<std::int64_t>(gridDim.x) * blockDim.x;
  const std::int64_t first = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  for (std::int64_t item = first; item < body.items(); item += step) body.run(item);
}

template <class Body>
__global__ void reduce_blocks(Body body) {
  __shared__ alignas(16) unsigned char memory[Body::kThreads * sizeof(typename Body::Partial)];
  auto* partial = reinterpret_cast<typename Body::Partial*>(memory);
  const auto thread = static_cast<int>(threadIdx.x);
  const auto block = static_cast<int>(blockIdx.x);
  partial[thread] = body.partial(block, thread);
  for (int half = Body::kThreads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (thread < half) Body::merge(partial[thread], partial[thread + half]);
  }
  if (thread == 0) body.finish(block, partial[0]);
}

template <class Body>
void start(const Body& body, cudaStream_t stream) {
  if constexpr (kReduces<Body>) {
    if (body.blocks() == 0) return;
    reduce_blocks<<<body.blocks(), Body::kThreads, 0, stream>>>(body);
  } else {
    if (body.items() == 0) return;
    constexpr std::int64_t kMostBlocks = 1 << 20;
    const std::int64_t blocks = std::min((body.items() + kThreads - 1) / kThreads, kMostBlocks);
    run_items<<<static_cast<unsigned>(blocks), kThreads, 0, stream>>>(body);
  }
  check(cudaGetLastError(), "starting a kernel");
}

void check_fft(cufftResult status, const char* doing) {
  if (status == CUFFT_SUCCESS) return;
  throw Error(ErrorKind::kProcessing,
              std::string("cuFFT failed ") + doing + ": code " + std::to_string(status), {},
              "search a smaller window, or use --device cpu");
}

class CufftTransform : public BatchedFft {
 public:
  CufftTransform(PlaneShape shape, int batch, cudaStream_t stream) {
    try {
      plan(forward_, CUFFT_R2C, shape, batch, stream);
      plan(inverse_, CUFFT_C2R, shape, batch, stream);
    } catch (...) {
      release();
      throw;
    }
  }
  ~CufftTransform() override { release(); }

  void forward(float* planes) override {
    check_fft(cufftExecR2C(forward_, planes, reinterpret_cast<cufftComplex*>(planes)),
              "transforming");
  }
  void inverse(float* planes) override {
    check_fft(cufftExecC2R(inverse_, reinterpret_cast<cufftComplex*>(planes), planes),
              "transforming back");
  }

 private:
  static void plan(cufftHandle& handle, cufftType type, PlaneShape shape, int batch,
                   cudaStream_t stream) {
    int size[2] = {shape.height, shape.width};
    int real_rows[2] = {shape.height, 2 * shape.half()};
    int complex_rows[2] = {shape.height, shape.half()};
    const int reals = static_cast<int>(shape.reals());
    const int complexes = static_cast<int>(shape.complexes());
    const bool to_complex = type == CUFFT_R2C;
    check_fft(cufftPlanMany(&handle, 2, size, to_complex ? real_rows : complex_rows, 1,
                            to_complex ? reals : complexes, to_complex ? complex_rows : real_rows,
                            1, to_complex ? complexes : reals, type, batch),
              "planning");
    check_fft(cufftSetStream(handle, stream), "planning");
  }
  void release() noexcept {
    if (forward_ != 0) cufftDestroy(forward_);
    if (inverse_ != 0) cufftDestroy(inverse_);
  }

  cufftHandle forward_ = 0;
  cufftHandle inverse_ = 0;
};

class Stream {
 public:
  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() {
    if (handle_ != nullptr) cudaStreamDestroy(handle_);
  }
  void make() {
    check(cudaStreamCreateWithFlags(&handle_, cudaStreamNonBlocking), "making a stream");
  }
  operator cudaStream_t() const { return handle_; }

 private:
  cudaStream_t handle_ = nullptr;
};

class GpuDevice : public Device {
 public:
  GpuDevice() {
    check(cudaGetDevice(&number_), "choosing a device");
    std::size_t free = 0;
    std::size_t total = 0;
    check(cudaMemGetInfo(&free, &total), "asking for its memory");
    workspace_ = std::min(free / 4, kLargestWorkspace);
    for (Stream& stream : streams_) stream.make();
  }

  std::string name() const override {
    cudaDeviceProp properties{};
    check(cudaGetDeviceProperties(&properties, number_), "asking for its name");
    return std::string(properties.name) + ", compute capability " +
           std::to_string(properties.major) + "." + std::to_string(properties.minor) + ", " +
           std::to_string(properties.totalGlobalMem >> 20U) + " MiB";
  }
  std::size_t workspace_bytes() const override { return workspace_; }

  void* allocate(std::size_t bytes) override {
    void* memory = nullptr;
    use();
    check(cudaMalloc(&memory, bytes), "allocating memory");
    return memory;
  }
  void release(void* memory) noexcept override { cudaFree(memory); }
  void* allocate_staging(std::size_t bytes) override {
    void* memory = nullptr;
    use();
    check(cudaMallocHost(&memory, bytes), "allocating memory of the host");
    return memory;
  }
  void release_staging(void* memory) noexcept override { cudaFreeHost(memory); }

  void upload(void* to, const void* from, std::size_t bytes, int stream) override {
    use();
    check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, streams_[stream]), "copying");
  }
  void download(void* to, const void* from, std::size_t bytes, int stream) override {
    use();
    check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, streams_[stream]), "copying");
  }
  void launch(const Kernel& kernel, int stream) override {
    use();
    std::visit([&](const auto& body) { start(body, streams_[stream]); }, kernel);
  }
  std::unique_ptr<BatchedFft> make_fft(PlaneShape shape, int batch, int stream) override {
    use();
    return std::make_unique<CufftTransform>(shape, batch, streams_[stream]);
  }
  std::vector<PeakKey> largest(const PeakKey* keys, std::size_t count, std::size_t wanted,
                               int stream) override {
    use();
    return gpu_largest(keys, count, wanted, streams_[stream]);
  }
  void wait(int stream) override {
    use();
    check(cudaStreamSynchronize(streams_[stream]), "computing");
  }

 private:
  static constexpr std::size_t kLargestWorkspace = std::size_t{2} << 30U;

  /// The current device is a thread's own, and another thread may have made this one.
  void use() const { check(cudaSetDevice(number_), "choosing a device"); }

  int number_ = 0;
  Stream streams_[kStreams];
  std::size_t workspace_ = 0;
};

std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

}  // namespace

std::string why_no_gpu() {
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status == cudaSuccess && count > 0) return {};
  cudaGetLastError();
  if (status == cudaErrorInsufficientDriver) {
    int driver = 0;
    cudaDriverGetVersion(&driver);
    return driver == 0 ? "no NVIDIA driver"
                       : "the NVIDIA driver knows CUDA " + version_text(driver) +
                             " and this build needs " + version_text(CUDART_VERSION);
  }
  return status == cudaSuccess || status == cudaErrorNoDevice ? "no NVIDIA GPU"
                                                              : cudaGetErrorString(status);
}

std::string gpu_library_version() {
  int fft = 0;
  cufftGetVersion(&fft);
  return version_text(CUDART_VERSION) + ", cuFFT " + std::to_string(fft / 1000) + "." +
         std::to_string(fft % 1000 / 100);
}

std::unique_ptr<Device> make_gpu_device() {
  const std::string reason = why_no_gpu();
  if (!reason.empty()) {
    throw Error(ErrorKind::kProcessing, "the backend cuda cannot be used: " + reason,
                "map_matching.backend", "use cpu");
  }
  return std::make_unique<GpuDevice>();
}

double gpu_copy_bytes_per_s() {
  constexpr std::size_t kBytes = std::size_t{1} << 30U;
  constexpr int kCopies = 20;
  GpuDevice device;
  Memory<char> from(device);
  Memory<char> to(device);
  from.reserve(kBytes);
  to.reserve(kBytes);
  cudaEvent_t start = nullptr;
  cudaEvent_t stop = nullptr;
  check(cudaEventCreate(&start), "making a clock");
  check(cudaEventCreate(&stop), "making a clock");
  float milliseconds = 0.0F;
  for (int i = -1; i < kCopies; ++i) {  // the first is not timed
    if (i == 0) check(cudaEventRecord(start), "timing");
    check(cudaMemcpyAsync(to.data(), from.data(), kBytes, cudaMemcpyDeviceToDevice), "copying");
  }
  check(cudaEventRecord(stop), "timing");
  check(cudaEventSynchronize(stop), "timing");
  check(cudaEventElapsedTime(&milliseconds, start, stop), "timing");
  cudaEventDestroy(start);
  cudaEventDestroy(stop);
  return 2.0 * kCopies * static_cast<double>(kBytes) / (1e-3 * static_cast<double>(milliseconds));
}

}  // namespace nadir::cuda
