// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/cuda/surfaces.hpp"

namespace nadir::cuda {

/// A place of a search: the number of its heading, its position in the window, its score.
struct Place {
  std::size_t yaw = 0;
  int column = 0;
  int row = 0;
  float score = 0.0F;
};

/// Brings whole surfaces back into the window that was asked for; where no template touches the
/// map, they are undefined.
class DownloadSink : public SurfaceSink {
 public:
  DownloadSink(Device& device, const SurfaceJob& job, const PixelWindow& asked);
  void begin(const Batch& batch, StreamWork& work) override;
  void end(const Batch& batch, StreamWork& work) override;
  std::vector<ScoreSurface> surfaces;

 private:
  Device& device_;
  Box window_;
  int column_;  ///< of the job's window in the one that was asked for
  int row_;
};

/// Keeps the best local maxima, found and sorted on the device.
class PeakSink : public SurfaceSink {
 public:
  PeakSink(Device& device, const SurfaceJob& job, const PixelWindow& asked, int wanted);
  void begin(const Batch& batch, StreamWork& work) override;
  void end(const Batch& batch, StreamWork& work) override;
  /// Best first; of equal ones the first heading, row and column first.
  std::vector<Place> places() const;

 private:
  Device& device_;
  Box window_;
  int column_;
  int row_;
  std::size_t wanted_;
  std::vector<Place> places_;
};

}  // namespace nadir::cuda
