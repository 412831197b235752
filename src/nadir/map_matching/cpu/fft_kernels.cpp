// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/fft_kernels.hpp"

// What pocketfft includes, before it is compiled for other targets than the baseline: nothing of
// the standard library may be.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nadir/map_matching/cpu/aligned.hpp"
#include "nadir/map_matching/cpu/sums.hpp"

#define POCKETFFT_NO_MULTITHREADING
#define POCKETFFT_CACHE_SIZE 0

// Compiled once per vector width and dispatched at run time (Highway). Narrower targets than AVX2
// have the same four lanes as the baseline.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nadir/map_matching/cpu/fft_kernels.cpp"
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
// A copy of pocketfft per target, each in a namespace of its own: the header is templates alone,
// and the functions of two targets must not be taken for one another.
#undef POCKETFFT_HDRONLY_H
#undef pocketfft
// NOLINTNEXTLINE(readability-identifier-naming): it renames their namespace
#define pocketfft HWY_CONCAT(pocketfft_, HWY_NAMESPACE)
#include <pocketfft_hdronly.h>

namespace nadir::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace fft = pocketfft::detail;

#if HWY_TARGET == HWY_AVX3
constexpr std::size_t kLanes = 16;
#elif HWY_TARGET == HWY_AVX2
constexpr std::size_t kLanes = 8;
#else
constexpr std::size_t kLanes = 4;
#endif

// The vectors of the compiler, because pocketfft computes with operators.
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using ComplexLanes = fft::cmplx<Lanes>;
static_assert(sizeof(ComplexLanes) == 2 * sizeof(Lanes));

HWY_INLINE Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(Lanes));
  return lanes;
}
HWY_INLINE void store(const Lanes& lanes, float* to) { std::memcpy(to, &lanes, sizeof(Lanes)); }

/// Of the first `count` lanes; the others are zero.
HWY_INLINE Lanes load_part(const float* from, std::size_t count) {
  if (count == kLanes) return load(from);
  Lanes lanes = {};
  for (std::size_t i = 0; i < count; ++i) lanes[i] = from[i];
  return lanes;
}
HWY_INLINE void store_part(const Lanes& lanes, std::size_t count, float* to) {
  if (count == kLanes) return store(lanes, to);
  for (std::size_t i = 0; i < count; ++i) to[i] = lanes[i];
}

#ifdef __has_builtin
#if __has_builtin(__builtin_shufflevector)
#define NADIR_SHUFFLE 1
#endif
#endif

#ifdef NADIR_SHUFFLE
/// Element `lane` of the first (second) result when blocks of `step` lanes of two rows, `step` rows
/// apart, are exchanged.
constexpr int first_source(std::size_t lane, std::size_t step) {
  return static_cast<int>((lane & step) == 0 ? lane : lane - step + kLanes);
}
constexpr int second_source(std::size_t lane, std::size_t step) {
  return static_cast<int>((lane & step) == 0 ? lane + step : lane + kLanes);
}

template <std::size_t Step, std::size_t... Lane>
HWY_INLINE void exchange(Lanes& a, Lanes& b, std::index_sequence<Lane...> /*lanes*/) {
  const Lanes first = __builtin_shufflevector(a, b, first_source(Lane, Step)...);
  b = __builtin_shufflevector(a, b, second_source(Lane, Step)...);
  a = first;
}

template <std::size_t Step>
HWY_INLINE void transpose_step(Lanes* rows) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    if ((i & Step) == 0) {
      exchange<Step>(rows[i], rows[i + Step], std::make_index_sequence<kLanes>());
    }
  }
}

HWY_INLINE void transpose(Lanes* rows) {
  if constexpr (kLanes >= 16) transpose_step<8>(rows);
  if constexpr (kLanes >= 8) transpose_step<4>(rows);
  transpose_step<2>(rows);
  transpose_step<1>(rows);
}
#else
HWY_INLINE void transpose(Lanes* rows) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t j = i + 1; j < kLanes; ++j) {
      const float value = rows[i][j];
      rows[i][j] = rows[j][i];
      rows[j][i] = value;
    }
  }
}
#endif

/// The score of one vector of positions from (a, r), (rr, p) and (pp, rp), `stride` apart.
HWY_INLINE void zero_mean(const ComplexLanes* sums, std::size_t stride,
                          const ZeroMeanOutput& options, Lanes& score, Lanes& share) {
  const hn::CappedTag<float, kLanes> d;
  HWY_ALIGN float sum[6][kLanes];
  HWY_ALIGN float scores[kLanes];
  HWY_ALIGN float shares[kLanes];
  for (std::size_t k = 0; k < 3; ++k) {
    store(sums[k * stride].r, sum[2 * k]);
    store(sums[k * stride].i, sum[2 * k + 1]);
  }
  const auto undefined = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const auto one = hn::Set(d, 1.0F);
  const auto per_total = hn::Set(d, options.total_seen > 0.0F ? 1.0F / options.total_seen : 0.0F);
  for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(d)) {
    const auto at = [&](std::size_t k) HWY_ATTR { return hn::Load(d, sum[k] + lane); };
    const auto a = at(0), r = at(1), rr = at(2), p = at(3), pp = at(4), rp = at(5);
    const auto seen = hn::Min(hn::Max(hn::Mul(a, per_total), hn::Zero(d)), one);
    hn::Store(seen, d, shares + lane);
    const auto per_a = hn::Div(one, a);
    const auto map_mean = hn::Mul(r, per_a);
    const auto map_norm = hn::Sub(rr, hn::Mul(r, map_mean));
    const auto local_norm = hn::Sub(pp, hn::Mul(p, hn::Mul(p, per_a)));
    const auto product = hn::Sub(rp, hn::Mul(p, map_mean));
    const auto least = hn::Mul(hn::Set(d, static_cast<float>(kMinVariance)), a);
    const auto defined = hn::And(
        hn::And(hn::Ge(map_norm, least), hn::Ge(local_norm, least)),
        hn::And(hn::Ge(seen, hn::Set(d, options.min_valid_weight)), hn::Gt(a, hn::Zero(d))));
    const auto ratio = hn::Div(product, hn::Sqrt(hn::Mul(map_norm, local_norm)));
    const auto clamped = hn::Min(hn::Max(ratio, hn::Neg(one)), one);
    hn::Store(hn::IfThenElse(defined, clamped, undefined), d, scores + lane);
  }
  score = load(scores);
  share = load(shares);
}

class Kernels : public FftKernels {
 public:
  explicit Kernels(const FftSize& size)
      : width_(size.width),
        height_(size.height),
        row_plan_(size.width),
        column_plan_(size.height) {}

  std::size_t lanes() const override { return kLanes; }

  void forward_rows(const float* image, std::size_t columns, std::size_t rows, float* out,
                    std::size_t out_rows) const override {
    const auto buffer = allocate_aligned<ComplexLanes>(width_);
    std::fill(buffer.get() + columns, buffer.get() + width_, ComplexLanes(Lanes{}, Lanes{}));
    const std::size_t first = std::min(rows, kLanes);
    for (std::size_t x = 0; x < columns; x += kLanes) {
      Lanes real[kLanes];
      Lanes imaginary[kLanes];
      const std::size_t count = std::min(kLanes, columns - x);
      read_tile(image + x, columns, first, count, real);
      read_tile(image + first * columns + x, columns, rows - first, count, imaginary);
      for (std::size_t i = 0; i < count; ++i) buffer[x + i].Set(real[i], imaginary[i]);
    }
    row_plan_.exec(buffer.get(), 1.0F, true);
    for (std::size_t block = 0; block < blocks(); ++block) {
      Lanes spectra[4][kLanes] = {};
      for (std::size_t i = 0; i < kLanes && block * kLanes + i < half(); ++i) {
        separate(buffer.get(), block * kLanes + i, spectra, i);
      }
      for (auto& part : spectra) transpose(part);
      float* to = out + block * out_rows * 2 * kLanes;
      for (std::size_t r = 0; r < rows; ++r, to += 2 * kLanes) {
        const std::size_t part = r < kLanes ? 0 : 2;
        store(spectra[part][r % kLanes], to);
        store(spectra[part + 1][r % kLanes], to + kLanes);
      }
    }
  }

  void forward_columns(float* block) const override {
    column_plan_.exec(as_complex(block), 1.0F, true);
  }

  void correlate_columns(const ColumnTask& task) const override {
    const std::size_t column_floats = 2 * kLanes * height_;
    const auto buffer = allocate_aligned<float>(column_floats * (task.locals.size() + 1));
    const auto column = [&](std::size_t i) { return buffer.get() + column_floats * i; };
    for (std::size_t i = 0; i < task.locals.size(); ++i) {
      const std::size_t filled = 2 * kLanes * task.local_rows;
      std::copy_n(task.locals[i], filled, column(i));
      std::fill(column(i) + filled, column(i) + column_floats, 0.0F);
      column_plan_.exec(as_complex(column(i)), 1.0F, true);
    }
    float* product = column(task.locals.size());
    const std::size_t before_wrap = std::min(task.rows, height_ - task.first_row);
    for (std::size_t k = 0; k < task.products.size(); ++k) {
      multiply(task.maps[task.products[k].map], column(task.products[k].local), product);
      column_plan_.exec(as_complex(product), 1.0F, false);
      float* rest = std::copy_n(product + 2 * kLanes * task.first_row, 2 * kLanes * before_wrap,
                                task.sums[k]);
      std::copy_n(product, 2 * kLanes * (task.rows - before_wrap), rest);
    }
  }

  void inverse_rows(const RowTask& task, std::span<float* const> out) const override {
    const auto buffer = allocate_aligned<ComplexLanes>(width_);
    for (std::size_t k = 0; k < task.sums.size(); k += 2) {
      const bool pair = k + 1 < task.sums.size();
      to_space(task, task.sums[k], pair ? task.sums[k + 1] : nullptr, buffer.get());
      for (std::size_t x = 0; x < task.columns; x += kLanes) {
        Lanes real[kLanes];
        Lanes imaginary[kLanes];
        for (std::size_t i = 0; i < kLanes; ++i) {
          const ComplexLanes& at = buffer[source(task, x + i)];
          real[i] = at.r;
          imaginary[i] = at.i;
        }
        write_tile(task, x, real, out[k]);
        if (pair) write_tile(task, x, imaginary, out[k + 1]);
      }
    }
  }

  void zero_mean_rows(const RowTask& task, const ZeroMeanOutput& out) const override {
    const auto buffer = allocate_aligned<ComplexLanes>(3 * width_);
    for (std::size_t k = 0; k < 3; ++k) {
      to_space(task, task.sums[2 * k], task.sums[2 * k + 1], buffer.get() + k * width_);
    }
    for (std::size_t x = 0; x < task.columns; x += kLanes) {
      Lanes score[kLanes];
      Lanes share[kLanes];
      for (std::size_t i = 0; i < kLanes; ++i) {
        zero_mean(buffer.get() + source(task, x + i), width_, out, score[i], share[i]);
      }
      write_tile(task, x, score, out.score);
      write_tile(task, x, share, out.valid_weight);
    }
  }

 private:
  std::size_t half() const { return width_ / 2 + 1; }
  std::size_t blocks() const { return (half() + kLanes - 1) / kLanes; }
  /// Of a half spectrum's values, all but the first and, for an even width, the last have a mirror
  /// image in the other half.
  bool is_mirrored(std::size_t k) const { return k > 0 && 2 * k < width_; }

  /// The buffer column that holds window column x; beyond the window any.
  std::size_t source(const RowTask& task, std::size_t x) const {
    const std::size_t column = task.first_column + std::min(x, task.columns - 1);
    return column < width_ ? column : column - width_;
  }

  static ComplexLanes* as_complex(float* column) { return reinterpret_cast<ComplexLanes*>(column); }

  /// product = map conj(local)
  void multiply(const float* map, const float* local, float* product) const {
    for (std::size_t i = 0; i < 2 * kLanes * height_; i += 2 * kLanes) {
      const Lanes a = load(map + i);
      const Lanes b = load(map + i + kLanes);
      const Lanes c = load(local + i);
      const Lanes d = load(local + i + kLanes);
      store(a * c + b * d, product + i);
      store(b * c - a * d, product + i + kLanes);
    }
  }

  static void read_tile(const float* image, std::size_t columns, std::size_t rows,
                        std::size_t count, Lanes* tile) {
    for (std::size_t r = 0; r < kLanes; ++r) {
      tile[r] = r < rows ? load_part(image + r * columns, count) : Lanes{};
    }
    transpose(tile);
  }

  /// Two real rows were transformed as one complex row z = a + i b. Value k of the spectra of a and
  /// b: (Z(k) + conj Z(-k)) / 2 and (Z(k) - conj Z(-k)) / 2i.
  void separate(const ComplexLanes* z, std::size_t k, Lanes (&spectra)[4][kLanes],
                std::size_t i) const {
    const ComplexLanes& at = z[k];
    if (!is_mirrored(k)) {
      spectra[0][i] = at.r;
      spectra[2][i] = at.i;
      return;
    }
    const ComplexLanes& mirror = z[width_ - k];
    spectra[0][i] = 0.5F * (at.r + mirror.r);
    spectra[1][i] = 0.5F * (at.i - mirror.i);
    spectra[2][i] = 0.5F * (at.i + mirror.i);
    spectra[3][i] = 0.5F * (mirror.r - at.r);
  }

  /// Reads one tile of half spectra, one row a lane.
  static void read_spectra(const RowTask& task, const float* plane, std::size_t block, Lanes* real,
                           Lanes* imaginary) {
    std::fill_n(real, kLanes, Lanes{});
    std::fill_n(imaginary, kLanes, Lanes{});
    if (plane == nullptr) return;
    const float* from = plane + (block * task.plane_rows + task.first_row) * 2 * kLanes;
    for (std::size_t r = 0; r < task.rows; ++r, from += 2 * kLanes) {
      real[r] = load(from);
      imaginary[r] = load(from + kLanes);
    }
    transpose(real);
    transpose(imaginary);
  }

  /// The rows of two planes in the space domain, one row a lane: a + i b.
  void to_space(const RowTask& task, const float* a, const float* b, ComplexLanes* buffer) const {
    for (std::size_t block = 0; block < blocks(); ++block) {
      Lanes a_real[kLanes], a_imaginary[kLanes], b_real[kLanes], b_imaginary[kLanes];
      read_spectra(task, a, block, a_real, a_imaginary);
      read_spectra(task, b, block, b_real, b_imaginary);
      for (std::size_t i = 0; i < kLanes; ++i) {
        const std::size_t k = block * kLanes + i;
        if (k >= half()) break;
        if (!is_mirrored(k)) {
          buffer[k].Set(a_real[i], b_real[i]);
          continue;
        }
        buffer[k].Set(a_real[i] - b_imaginary[i], a_imaginary[i] + b_real[i]);
        buffer[width_ - k].Set(a_real[i] + b_imaginary[i], b_real[i] - a_imaginary[i]);
      }
    }
    row_plan_.exec(buffer, 1.0F / static_cast<float>(width_ * height_), false);
  }

  static void write_tile(const RowTask& task, std::size_t x, Lanes* tile, float* out) {
    transpose(tile);
    const std::size_t count = std::min(kLanes, task.columns - x);
    for (std::size_t r = 0; r < task.rows; ++r) {
      store_part(tile[r], count, out + r * task.columns + x);
    }
  }

  std::size_t width_;
  std::size_t height_;
  fft::pocketfft_c<float> row_plan_;
  fft::pocketfft_c<float> column_plan_;
};

FftKernels* make_kernels(const FftSize& size) { return std::make_unique<Kernels>(size).release(); }

}  // namespace nadir::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nadir::cpu {

HWY_EXPORT(make_kernels);

std::unique_ptr<FftKernels> make_fft_kernels(const FftSize& size) {
  return std::unique_ptr<FftKernels>(HWY_DYNAMIC_DISPATCH(make_kernels)(size));
}

}  // namespace nadir::cpu
#endif  // HWY_ONCE
