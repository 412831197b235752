// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "nadir/map_matching/cuda/surfaces.hpp"

namespace nadir::cuda {
namespace {

bool has_small_factors(int size) {
  for (const int factor : {2, 3, 5, 7}) {
    while (size % factor == 0) size /= factor;
  }
  return size == 1;
}

}  // namespace

int fft_size(int least) {
  int size = std::max(2, least + least % 2);
  while (!has_small_factors(size)) size += 2;
  return size;
}

int batch_size(int count, std::size_t bytes, std::size_t bytes_per_template) {
  constexpr std::size_t kFewestBatches = 4;
  constexpr std::size_t kEnough = 8;  // smaller batches are not worth splitting
  const auto all = static_cast<std::size_t>(std::max(count, 1));
  const std::size_t fit = bytes / (Device::kStreams * std::max<std::size_t>(bytes_per_template, 1));
  const std::size_t share = std::max(kEnough, (all + kFewestBatches - 1) / kFewestBatches);
  const std::size_t largest = std::clamp<std::size_t>(std::min(fit, share), 1, all);
  // As even as can be: a transform's batch is fixed, and the last one would be padded.
  const std::size_t batches = (all + largest - 1) / largest;
  return static_cast<int>((all + batches - 1) / batches);
}

void for_each_batch(DeviceMap& map, const SurfaceJob& job, int size, SurfaceSink& sink,
                    const std::function<void(const Batch&)>& work) {
  std::array<std::optional<Batch>, Device::kStreams> pending;
  const auto finish = [&](std::size_t stream) {
    if (pending[stream]) sink.end(*pending[stream], map.work[stream]);
    pending[stream].reset();
  };
  int number = 0;
  for (int first = 0; first < job.count && !job.stop.stop_requested(); first += size, ++number) {
    const auto stream = static_cast<std::size_t>(number % Device::kStreams);
    finish(stream);
    const Batch batch{first, std::min(size, job.count - first), static_cast<int>(stream)};
    work(batch);
    sink.begin(batch, map.work[stream]);
    pending[stream] = batch;
  }
  for (int i = 0; i < Device::kStreams; ++i) {  // the older first
    finish(static_cast<std::size_t>((number + i) % Device::kStreams));
  }
  job.stop.check();
}

}  // namespace nadir::cuda
