// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/correlator.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "nadir/map_matching/cpu/aligned.hpp"

namespace nadir::cpu {
namespace {

std::size_t size_of(int value) { return static_cast<std::size_t>(value); }

/// The non-negative remainder.
std::size_t wrapped(int value, std::size_t period) {
  const auto modulus = static_cast<std::ptrdiff_t>(period);
  return static_cast<std::size_t>((value % modulus + modulus) % modulus);
}

void reserve(AlignedFloats& buffer, std::size_t& size, std::size_t needed) {
  if (size >= needed) return;
  buffer.reset();
  size = 0;
  buffer = allocate_aligned<float>(needed);
  size = needed;
}

/// Calls body(first, count) for groups of at most `lanes` rows.
void for_each_group(std::size_t rows, std::size_t lanes, bool parallel,
                    const std::function<void(std::size_t, std::size_t)>& body) {
  for_each_index((rows + lanes - 1) / lanes, parallel, [&](std::size_t group) {
    const std::size_t first = group * lanes;
    body(first, std::min(lanes, rows - first));
  });
}

}  // namespace

void for_each_index(std::size_t count, bool parallel,
                    const std::function<void(std::size_t)>& body) {
  if (parallel) {
    tbb::parallel_for(std::size_t{0}, count, body);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) body(i);
}

Correlator::Correlator(int width, int height)
    : size_(cheapest_fft_size(size_of(width), size_of(height))),
      kernels_(make_fft_kernels(size_)) {}

std::size_t Correlator::blocks() const {
  const std::size_t half = size_.width / 2 + 1;
  return (half + kernels_->lanes() - 1) / kernels_->lanes();
}

std::size_t Correlator::plane_floats(std::size_t rows) const {
  return blocks() * rows * 2 * kernels_->lanes();
}

std::size_t Correlator::scratch_bytes(std::size_t products, std::size_t locals,
                                      std::size_t local_rows, std::size_t window_rows) const {
  return (locals * plane_floats(local_rows) + products * plane_floats(window_rows)) * sizeof(float);
}

void Correlator::forward_rows(const Raster<float>& image, float* out, std::size_t out_rows,
                              bool parallel) const {
  const std::size_t lanes = kernels_->lanes();
  for_each_group(
      size_of(image.height()), 2 * lanes, parallel, [&](std::size_t first, std::size_t n) {
        kernels_->forward_rows(image.row(static_cast<int>(first)).data(), size_of(image.width()), n,
                               out + first * 2 * lanes, out_rows);
      });
}

Spectrum Correlator::forward(const Raster<float>& image) const {
  const std::size_t block_floats = size_.height * 2 * kernels_->lanes();
  Spectrum spectrum{allocate_aligned<float>(plane_floats(size_.height))};
  // Rows beyond the image are zero in every block.
  const std::size_t filled = size_of(image.height()) * 2 * kernels_->lanes();
  forward_rows(image, spectrum.blocks.get(), size_.height, true);
  for_each_index(blocks(), true, [&](std::size_t block) {
    float* first = spectrum.blocks.get() + block * block_floats;
    std::fill(first + filled, first + block_floats, 0.0F);
    kernels_->forward_columns(first);
  });
  return spectrum;
}

void Correlator::column_pass(std::span<const Spectrum* const> maps,
                             std::span<const Raster<float>* const> locals,
                             std::span<const Product> products, const CorrelationWindow& window,
                             CorrelatorScratch& scratch, bool parallel) const {
  const std::size_t rows = size_of(window.height);
  const std::size_t local_rows = size_of(locals.front()->height());
  const std::size_t local_plane = plane_floats(local_rows);
  const std::size_t sum_plane = plane_floats(rows);
  reserve(scratch.locals, scratch.locals_size, local_plane * locals.size());
  reserve(scratch.sums, scratch.sums_size, sum_plane * products.size());
  for (std::size_t i = 0; i < locals.size(); ++i) {
    forward_rows(*locals[i], scratch.locals.get() + i * local_plane, local_rows, parallel);
  }
  const std::size_t row_floats = 2 * kernels_->lanes();
  for_each_index(blocks(), parallel, [&](std::size_t block) {
    std::vector<const float*> map_blocks;
    std::vector<const float*> local_blocks;
    std::vector<float*> sum_blocks;
    for (const Spectrum* map : maps) {
      map_blocks.push_back(map->blocks.get() + block * size_.height * row_floats);
    }
    for (std::size_t i = 0; i < locals.size(); ++i) {
      local_blocks.push_back(scratch.locals.get() + i * local_plane +
                             block * local_rows * row_floats);
    }
    for (std::size_t k = 0; k < products.size(); ++k) {
      sum_blocks.push_back(scratch.sums.get() + k * sum_plane + block * rows * row_floats);
    }
    kernels_->correlate_columns({map_blocks, local_blocks, local_rows, products,
                                 wrapped(window.top, size_.height), rows, sum_blocks});
  });
}

void Correlator::correlate(std::span<const Spectrum* const> maps,
                           std::span<const Raster<float>* const> locals,
                           std::span<const Product> products, const CorrelationWindow& window,
                           const RowSink& sink, CorrelatorScratch& scratch, bool parallel) const {
  column_pass(maps, locals, products, window, scratch, parallel);
  const std::size_t rows = size_of(window.height);
  const std::size_t columns = size_of(window.width);
  std::vector<const float*> planes;
  for (std::size_t k = 0; k < products.size(); ++k) {
    planes.push_back(scratch.sums.get() + k * plane_floats(rows));
  }
  for_each_group(rows, kernels_->lanes(), parallel, [&](std::size_t first, std::size_t count) {
    std::vector<float> values(products.size() * count * columns);
    std::vector<float*> out;
    for (std::size_t k = 0; k < products.size(); ++k) {
      out.push_back(values.data() + k * count * columns);
    }
    kernels_->inverse_rows({planes, rows, first, count, wrapped(window.left, size_.width), columns},
                           out);
    const std::vector<const float*> sums(out.begin(), out.end());
    sink(static_cast<int>(first), static_cast<int>(count), sums);
  });
}

void Correlator::zero_mean(std::span<const Spectrum* const> maps,
                           std::span<const Raster<float>* const> locals,
                           const CorrelationWindow& window, double total_seen,
                           double min_valid_weight, Raster<float>& score,
                           Raster<float>& valid_weight, CorrelatorScratch& scratch,
                           bool parallel) const {
  column_pass(maps, locals, kZeroMeanProducts, window, scratch, parallel);
  const std::size_t rows = size_of(window.height);
  std::vector<const float*> planes;
  for (std::size_t k = 0; k < std::size(kZeroMeanProducts); ++k) {
    planes.push_back(scratch.sums.get() + k * plane_floats(rows));
  }
  for_each_group(rows, kernels_->lanes(), parallel, [&](std::size_t first, std::size_t count) {
    const int row = static_cast<int>(first);
    kernels_->zero_mean_rows(
        {planes, rows, first, count, wrapped(window.left, size_.width), size_of(window.width)},
        {score.row(row).data(), valid_weight.row(row).data(), static_cast<float>(total_seen),
         static_cast<float>(min_valid_weight)});
  });
}

}  // namespace nadir::cpu
