// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/fft.hpp"

#include <pocketfft_hdronly.h>

#include <algorithm>

namespace nadir::cpu {
namespace {

constexpr std::ptrdiff_t kReal = sizeof(float);
constexpr std::ptrdiff_t kComplex = sizeof(std::complex<float>);

std::ptrdiff_t signed_size(std::size_t size) { return static_cast<std::ptrdiff_t>(size); }

}  // namespace

RealFft::RealFft(int width, int height)
    : width_(pocketfft::detail::util::good_size_real(static_cast<std::size_t>(width))),
      height_(pocketfft::detail::util::good_size_cmplx(static_cast<std::size_t>(height))) {}

Spectrum RealFft::forward(const Raster<float>& image) const {
  const std::size_t half = width_ / 2 + 1;
  Spectrum spectrum(half * height_);
  std::vector<float> rows(width_ * static_cast<std::size_t>(image.height()));
  for (int row = 0; row < image.height(); ++row) {
    const auto source = image.row(row);
    std::copy(source.begin(), source.end(),
              rows.begin() + signed_size(width_ * static_cast<std::size_t>(row)));
  }
  // Rows first, and only those that are not all padding.
  pocketfft::r2c<float>(
      {static_cast<std::size_t>(image.height()), width_}, {signed_size(width_) * kReal, kReal},
      {signed_size(half) * kComplex, kComplex}, 1, true, rows.data(), spectrum.data(), 1.0F);
  pocketfft::c2c<float>({height_, half}, {signed_size(half) * kComplex, kComplex},
                        {signed_size(half) * kComplex, kComplex}, {0}, true, spectrum.data(),
                        spectrum.data(), 1.0F);
  return spectrum;
}

Raster<float> RealFft::correlate(const Spectrum& image, const Spectrum& local, int left, int top,
                                 int width, int height) const {
  const std::size_t half = width_ / 2 + 1;
  Spectrum product(image.size());
  for (std::size_t i = 0; i < product.size(); ++i) {
    const float a = image[i].real();
    const float b = image[i].imag();
    const float c = local[i].real();
    const float d = local[i].imag();
    product[i] = {a * c + b * d, b * c - a * d};  // image * conj(local)
  }
  pocketfft::c2c<float>({height_, half}, {signed_size(half) * kComplex, kComplex},
                        {signed_size(half) * kComplex, kComplex}, {0}, false, product.data(),
                        product.data(), 1.0F);
  // Only the rows that are asked for go back to the space domain.
  const auto row_count = static_cast<std::size_t>(height);
  std::vector<float> rows(row_count * width_);
  pocketfft::c2r<float>({row_count, width_}, {signed_size(half) * kComplex, kComplex},
                        {signed_size(width_) * kReal, kReal}, 1, false,
                        product.data() + static_cast<std::size_t>(top) * half, rows.data(),
                        1.0F / static_cast<float>(width_ * height_));
  Raster<float> result(width, height);
  for (int row = 0; row < height; ++row) {
    const auto first = rows.begin() + signed_size(static_cast<std::size_t>(row) * width_) + left;
    std::copy(first, first + width, result.row(row).begin());
  }
  return result;
}

}  // namespace nadir::cpu
