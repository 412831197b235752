// SPDX-License-Identifier: Apache-2.0
#include "performance/plain_correlation.hpp"

#include <pocketfft_hdronly.h>

#include <algorithm>

#include "nadir/map_matching/cpu/correlator.hpp"

namespace nadir::test {
namespace {

pocketfft::stride_t strides(std::size_t row, std::size_t value) {
  return {static_cast<std::ptrdiff_t>(row * value), static_cast<std::ptrdiff_t>(value)};
}

}  // namespace

PlainCorrelation::PlainCorrelation(std::size_t width, std::size_t height,
                                   const std::array<Raster<float>, 3>& maps)
    : width_(width), height_(height) {
  for (std::size_t i = 0; i < maps.size(); ++i) maps_[i] = forward(maps[i]);
}

PlainCorrelation::Spectrum PlainCorrelation::forward(const Raster<float>& image) const {
  std::vector<float> padded(width_ * height_);
  for (int row = 0; row < image.height(); ++row) {
    const auto from = image.row(row);
    std::copy(from.begin(), from.end(),
              padded.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * width_));
  }
  const std::size_t half = width_ / 2 + 1;
  Spectrum spectrum(half * height_);
  pocketfft::r2c<float>({height_, width_}, strides(width_, sizeof(float)),
                        strides(half, sizeof(std::complex<float>)), {0, 1}, true, padded.data(),
                        spectrum.data(), 1.0F);
  return spectrum;
}

std::vector<std::vector<float>> PlainCorrelation::correlate(
    const std::array<Raster<float>, 3>& locals) const {
  const Spectrum spectra[] = {forward(locals[0]), forward(locals[1]), forward(locals[2])};
  const std::size_t half = width_ / 2 + 1;
  std::vector<std::vector<float>> sums;
  for (const cpu::Product& product : cpu::kZeroMeanProducts) {
    Spectrum values(half * height_);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::complex<float> a = maps_[product.map][i];
      const std::complex<float> b = spectra[product.local][i];
      values[i] = {a.real() * b.real() + a.imag() * b.imag(),
                   a.imag() * b.real() - a.real() * b.imag()};
    }
    std::vector<float> plane(width_ * height_);
    pocketfft::c2r<float>({height_, width_}, strides(half, sizeof(std::complex<float>)),
                          strides(width_, sizeof(float)), {0, 1}, false, values.data(),
                          plane.data(), 1.0F / static_cast<float>(width_ * height_));
    sums.push_back(std::move(plane));
  }
  return sums;
}

}  // namespace nadir::test
