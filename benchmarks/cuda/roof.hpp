// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "nadir/map_matching/cuda/correlation_kernels.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir::bench {

/// Bytes that a search by correlation moves to and from the memory of the GPU, where every kernel
/// reads what it needs once and writes its result once, and a transform does so once for each axis.
/// At a copy's bandwidth this is the floor of the search. What the map's three spectra and the
/// template itself cost is left out: they are read by all headings and stay in the cache.
inline double search_bytes(cuda::Formula formula, const cuda::PlaneShape& shape,
                           const PixelWindow& window, int local_size, int headings) {
  const double plane = 4.0 * static_cast<double>(shape.reals());
  const double templates = cuda::template_planes(formula);
  const double products = cuda::product_planes(formula);
  const double side = std::ceil(std::sqrt(2.0) * local_size);  // of the box around every heading
  const double turned = 16.0 * side * side;
  const double position = static_cast<double>(window.width) * window.height;
  const double turning = 3.0 * turned;                        // written, summed, read
  const double transforms = (1.0 + 4.0) * templates * plane;  // filled, then there on two axes
  const double multiplying = (templates + products) * plane;
  const double back = 4.0 * products * plane;
  const double assembling = (4.0 * products + 8.0) * position;  // score and share are written
  const double peaks = (4.0 + 8.0 + 8.0) * position;            // scores, keys, keys again
  return headings * (turning + transforms + multiplying + back + assembling + peaks);
}

}  // namespace nadir::bench
