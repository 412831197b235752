// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "nadir/core/raster.hpp"

namespace nadir::test {

/// Six correlations by two-dimensional transforms as anyone would write them with pocketfft: the
/// baseline that the fused path is measured against. Compiled for the plainest processor.
class PlainCorrelation {
 public:
  PlainCorrelation(std::size_t width, std::size_t height, const std::array<Raster<float>, 3>& maps);
  /// One plane for each of kZeroMeanProducts, `width` x `height`, shift (0, 0) first.
  std::vector<std::vector<float>> correlate(const std::array<Raster<float>, 3>& locals) const;

 private:
  using Spectrum = std::vector<std::complex<float>>;
  Spectrum forward(const Raster<float>& image) const;

  std::size_t width_;
  std::size_t height_;
  std::array<Spectrum, 3> maps_;
};

}  // namespace nadir::test
