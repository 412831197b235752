// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cuda/sinks.hpp"

#include <algorithm>
#include <tuple>

#include "nadir/core/score_volume.hpp"

namespace nadir::cuda {
namespace {

std::size_t positions(const Box& window) {
  return static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
}

/// `from` is a dense window; it goes to (column, row) of `to`.
void paste(const float* from, const Box& window, Raster<float>& to, int column, int row) {
  for (int i = 0; i < window.height; ++i) {
    std::copy_n(from + static_cast<std::size_t>(i) * static_cast<std::size_t>(window.width),
                window.width, &to.at(column, row + i));
  }
}

bool better(const Place& a, const Place& b) {
  return std::tuple(-a.score, a.yaw, a.row, a.column) <
         std::tuple(-b.score, b.yaw, b.row, b.column);
}

}  // namespace

DownloadSink::DownloadSink(Device& device, const SurfaceJob& job, const PixelWindow& asked)
    : device_(device),
      window_(job.window),
      column_(job.window.left - asked.left),
      row_(job.window.top - asked.top) {
  // One by one: a copy of a surface costs as much as the GPU takes to compute it.
  surfaces.reserve(static_cast<std::size_t>(job.count));
  for (int i = 0; i < job.count; ++i) {
    surfaces.push_back({Raster<float>(asked.width, asked.height, kUndefinedScore),
                        Raster<float>(asked.width, asked.height)});
  }
}

void DownloadSink::begin(const Batch& batch, StreamWork& work) {
  const std::size_t count = positions(window_) * static_cast<std::size_t>(batch.count);
  float* staged = work.staged_scores.reserve(2 * count);
  device_.download(staged, work.score.data(), count * sizeof(float), batch.stream);
  device_.download(staged + count, work.share.data(), count * sizeof(float), batch.stream);
}

void DownloadSink::end(const Batch& batch, StreamWork& work) {
  device_.wait(batch.stream);
  const std::size_t size = positions(window_);
  const auto count = static_cast<std::size_t>(batch.count);
  const float* score = work.staged_scores.data();
  const float* share = score + size * count;
  for (std::size_t i = 0; i < count; ++i) {
    ScoreSurface& surface = surfaces[static_cast<std::size_t>(batch.first) + i];
    paste(score + i * size, window_, surface.score, column_, row_);
    paste(share + i * size, window_, surface.valid_weight, column_, row_);
  }
}

PeakSink::PeakSink(Device& device, const SurfaceJob& job, const PixelWindow& asked, int wanted)
    : device_(device),
      window_(job.window),
      column_(job.window.left - asked.left),
      row_(job.window.top - asked.top),
      wanted_(static_cast<std::size_t>(std::max(wanted, 0))) {}

void PeakSink::begin(const Batch& batch, StreamWork& work) {
  PeakKey* keys = work.keys.reserve(positions(window_) * static_cast<std::size_t>(batch.count));
  device_.launch(MarkPeaks{work.score.data(), batch.count, window_.width, window_.height, keys},
                 batch.stream);
}

void PeakSink::end(const Batch& batch, StreamWork& work) {
  const std::size_t size = positions(window_);
  const auto width = static_cast<std::size_t>(window_.width);
  const std::size_t count = size * static_cast<std::size_t>(batch.count);
  for (const PeakKey key : device_.largest(work.keys.data(), count, wanted_, batch.stream)) {
    const std::size_t at = place_of(key);
    places_.push_back({static_cast<std::size_t>(batch.first) + at / size,
                       column_ + static_cast<int>(at % size % width),
                       row_ + static_cast<int>(at % size / width), score_of(key)});
  }
  std::sort(places_.begin(), places_.end(), better);
  if (places_.size() > wanted_) places_.resize(wanted_);
}

std::vector<Place> PeakSink::places() const { return places_; }

}  // namespace nadir::cuda
