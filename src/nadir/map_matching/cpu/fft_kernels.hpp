// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "nadir/map_matching/cpu/fft_size.hpp"

namespace nadir::cpu {

/// One product of the column pass: the spectrum of a map times the conjugate of a template's.
struct Product {
  std::size_t map = 0;
  std::size_t local = 0;
};

/// One block of columns of one template: see FftKernels.
struct ColumnTask {
  std::span<const float* const> maps;    ///< the block of every map spectrum
  std::span<const float* const> locals;  ///< the block of every template after its row pass
  std::size_t local_rows = 0;            ///< rows of those; the rest of the column is zero
  std::span<const Product> products;
  std::size_t first_row = 0;     ///< first row that is asked for; rows wrap around
  std::size_t rows = 0;          ///< how many
  std::span<float* const> sums;  ///< where they go, one per product
};

/// One group of at most `lanes` rows on their way back to the space domain.
struct RowTask {
  std::span<const float* const> sums;  ///< planes of the column pass, one per product
  std::size_t plane_rows = 0;          ///< rows of a plane
  std::size_t first_row = 0;
  std::size_t rows = 0;
  std::size_t first_column = 0;  ///< first column that is asked for; columns wrap around
  std::size_t columns = 0;
};

/// Where the score of six sums goes (score_from_sums of zncc and zwncc).
struct ZeroMeanOutput {
  float* score = nullptr;  ///< of the group's first row; rows are `columns` apart
  float* valid_weight = nullptr;
  float total_seen = 0.0F;  ///< the template's weight
  float min_valid_weight = 0.0F;
};

/// Pieces of the two-dimensional real transform of one size, on the widest vectors of the
/// processor.
///
/// A spectrum lies in blocks of `lanes` columns: block by block, row by row, `lanes` real parts and
/// then `lanes` imaginary ones. A column pass then runs on whole vectors without gathering, stays
/// in the cache from the forward transform over all products to the inverse ones, and writes only
/// rows that are asked for. Not normalised in the forward direction; by 1 / (width height)
/// backwards.
class FftKernels {
 public:
  virtual ~FftKernels() = default;
  FftKernels() = default;
  FftKernels(const FftKernels&) = delete;
  FftKernels& operator=(const FftKernels&) = delete;
  FftKernels(FftKernels&&) = delete;
  FftKernels& operator=(FftKernels&&) = delete;

  virtual std::size_t lanes() const = 0;
  /// Transforms rows (at most 2 `lanes`) of an image along x, padded with zeros, two real rows as
  /// one complex row. Row r of block b goes to out + (b * out_rows + r) * 2 * lanes.
  virtual void forward_rows(const float* image, std::size_t columns, std::size_t rows, float* out,
                            std::size_t out_rows) const = 0;
  /// Transforms one block of columns in place.
  virtual void forward_columns(float* block) const = 0;
  virtual void correlate_columns(const ColumnTask& task) const = 0;
  /// The rows of every product, back in the space domain: row r of product k goes to
  /// out[k] + r * columns.
  virtual void inverse_rows(const RowTask& task, std::span<float* const> out) const = 0;
  /// The same for the six sums a, r, rr, p, pp, rp, put together at once.
  virtual void zero_mean_rows(const RowTask& task, const ZeroMeanOutput& out) const = 0;
};

std::unique_ptr<FftKernels> make_fft_kernels(const FftSize& size);

}  // namespace nadir::cpu
