// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "nadir/map_matching/cuda/device_map.hpp"

namespace nadir::cuda {

/// A search: every position of a window, for `count` templates that lie within one box.
struct SurfaceJob {
  Box window;  ///< robot positions, map pixels; no more than can touch the map
  Box box;
  int count = 0;
  Rule rule;
  StopToken stop = {};
};

/// A run of templates, by their numbers.
struct Batch {
  int first = 0;
  int count = 0;
  int stream = 0;
};

/// Takes the scores of a batch from the device: begin() while the stream is still working, end()
/// before its memory is used again.
class SurfaceSink {
 public:
  virtual ~SurfaceSink() = default;
  virtual void begin(const Batch& batch, StreamWork& work) = 0;
  virtual void end(const Batch& batch, StreamWork& work) = 0;
};

/// Fills StreamWork::turned with a batch of templates, on its stream.
using FillTemplates = std::function<void(const Batch& batch, StreamWork& work)>;

/// All headings by FFT: three (four) transforms of each template, six (eight) correlations with the
/// spectra of the map, which are computed once. For [5] three, four, and one for each grey level
/// that window means take.
void correlate_surfaces(DeviceMap& map, const SurfaceJob& job, const FillTemplates& fill,
                        SurfaceSink& sink);

/// The scores of [5] of a batch, whose templates are transformed and correlated with `spectra`,
/// into StreamWork::score and share. `positions`: the window, relative to the spectra's rectangle.
void score_by_levels(DeviceMap& map, const SurfaceJob& job, const MapSpectra& spectra,
                     const Batch& batch, const Box& positions);

/// `sad`, and `ssd` where holes take part, pixel by pixel.
void sum_surfaces(DeviceMap& map, const SurfaceJob& job, std::span<const RotatedTemplate> templates,
                  SurfaceSink& sink);

/// The smallest even size from `least` on that has no prime factor above 7: such sizes have fast
/// transforms.
int fft_size(int least);

/// Templates a batch, so that both streams together stay within `bytes`, and there are a few
/// batches for them to share.
int batch_size(int count, std::size_t bytes, std::size_t bytes_per_template);

/// Runs `work` on batches of `size` templates that alternate between the streams. Throws Stopped,
/// with nothing left on its way.
void for_each_batch(DeviceMap& map, const SurfaceJob& job, int size, SurfaceSink& sink,
                    const std::function<void(const Batch&)>& work);

}  // namespace nadir::cuda
