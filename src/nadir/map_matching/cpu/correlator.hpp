// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/aligned_allocator.h>

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "nadir/core/raster.hpp"
#include "nadir/map_matching/cpu/fft_kernels.hpp"

namespace nadir::cpu {

/// Floats of a spectrum or of planes on their way back, in blocks of columns (FftKernels).
using AlignedFloats = hwy::AlignedFreeUniquePtr<float[]>;

/// The spectrum of a map.
struct Spectrum {
  AlignedFloats blocks;
  bool empty() const { return blocks == nullptr; }
};

/// Which part of the cyclic correlation is asked for: result(x, y) belongs to the shift
/// (left + x, top + y), modulo the size of the transform.
struct CorrelationWindow {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// Memory that one correlation works in; kept from one to the next.
struct CorrelatorScratch {
  AlignedFloats locals;
  AlignedFloats sums;
  std::size_t locals_size = 0;
  std::size_t sums_size = 0;
};

/// Takes rows of sums: the first row, how many, and for each product a pointer to the first of them
/// (rows are one window width apart).
using RowSink = std::function<void(int, int, std::span<const float* const>)>;

/// Cyclic cross correlations of maps with templates, several products at once:
/// sums[k](x, y) = sum over (i, j) of map_k(x + left + i, y + top + j) * local_k(i, j).
/// Blocks of columns, then groups of rows are worked on in parallel where `parallel` is set; the
/// result is the same to the bit either way.
class Correlator {
 public:
  /// Of the cheapest size that holds `width` x `height`.
  Correlator(int width, int height);

  const FftSize& size() const { return size_; }
  std::size_t lanes() const { return kernels_->lanes(); }
  /// Bytes that one correlation of `products` with `locals` templates of `local_rows` rows needs.
  std::size_t scratch_bytes(std::size_t products, std::size_t locals, std::size_t local_rows,
                            std::size_t window_rows) const;
  std::size_t spectrum_bytes() const { return plane_floats(size_.height) * sizeof(float); }

  /// The spectrum of `image`, padded with zeros.
  Spectrum forward(const Raster<float>& image) const;

  void correlate(std::span<const Spectrum* const> maps,
                 std::span<const Raster<float>* const> locals, std::span<const Product> products,
                 const CorrelationWindow& window, const RowSink& sink, CorrelatorScratch& scratch,
                 bool parallel) const;

  /// The six sums of zncc and zwncc from the spectra of V, V R' and V R'^2 and the templates a,
  /// a P' and a P'^2, put together to scores at once.
  void zero_mean(std::span<const Spectrum* const> maps,
                 std::span<const Raster<float>* const> locals, const CorrelationWindow& window,
                 double total_seen, double min_valid_weight, Raster<float>& score,
                 Raster<float>& valid_weight, CorrelatorScratch& scratch, bool parallel) const;

 private:
  std::size_t blocks() const;
  std::size_t plane_floats(std::size_t rows) const;
  void forward_rows(const Raster<float>& image, float* out, std::size_t out_rows,
                    bool parallel) const;
  /// Fills scratch.sums with one plane a product.
  void column_pass(std::span<const Spectrum* const> maps,
                   std::span<const Raster<float>* const> locals, std::span<const Product> products,
                   const CorrelationWindow& window, CorrelatorScratch& scratch,
                   bool parallel) const;

  FftSize size_;
  std::shared_ptr<const FftKernels> kernels_;
};

/// Products of zncc and zwncc: a, r, rr, p, pp, rp.
inline constexpr Product kZeroMeanProducts[] = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 2}, {1, 1}};

/// body(0) ... body(count - 1), on all threads or in order.
void for_each_index(std::size_t count, bool parallel, const std::function<void(std::size_t)>& body);

}  // namespace nadir::cpu
