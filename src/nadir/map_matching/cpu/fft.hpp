// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <vector>

#include "nadir/core/raster.hpp"

namespace nadir::cpu {

/// Half of the spectrum of a real image: rows of width / 2 + 1 values.
using Spectrum = std::vector<std::complex<float>>;

/// A real two-dimensional Fourier transform of one size.
class RealFft {
 public:
  /// The smallest size that the transform is fast for and that holds `width` x `height`.
  RealFft(int width, int height);

  /// The spectrum of `image`, padded with zeros.
  Spectrum forward(const Raster<float>& image) const;

  /// The cross correlation of two images from their spectra, cut to a rectangle:
  /// result(x, y) = sum over (i, j) of image(x + left + i, y + top + j) * local(i, j).
  Raster<float> correlate(const Spectrum& image, const Spectrum& local, int left, int top,
                          int width, int height) const;

 private:
  std::size_t width_;
  std::size_t height_;
};

}  // namespace nadir::cpu
