// SPDX-License-Identifier: Apache-2.0
// The correlations of the fast path against sums written out, for odd sizes, wraps and many
// products.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "map_matching/random_maps.hpp"
#include "nadir/map_matching/cpu/correlator.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

Raster<float> random_raster(std::uint64_t seed, int width, int height) {
  const RandomStream random(seed, 41);
  Raster<float> raster(width, height);
  for (std::size_t i = 0; i < raster.values().size(); ++i) {
    raster.values()[i] = static_cast<float>(random.uniform(i, -1.0, 1.0));
  }
  return raster;
}

int wrapped(int value, std::size_t period) {
  const int modulus = static_cast<int>(period);
  return (value % modulus + modulus) % modulus;
}

/// sum over (i, j) of map(x + i, y + j) local(i, j), on a torus of `size`.
double cyclic_sum(const Raster<float>& map, const Raster<float>& local, int x, int y,
                  const cpu::FftSize& size) {
  double sum = 0.0;
  for (int j = 0; j < local.height(); ++j) {
    for (int i = 0; i < local.width(); ++i) {
      const int u = wrapped(x + i, size.width);
      const int v = wrapped(y + j, size.height);
      if (map.contains(u, v)) sum += static_cast<double>(map.at(u, v)) * local.at(i, j);
    }
  }
  return sum;
}

struct CorrelatorCase {
  int map_width, map_height, local_width, local_height;
  cpu::CorrelationWindow window;
};

TEST(Correlator, EqualsSumsWrittenOut) {
  const CorrelatorCase cases[] = {
      {1, 1, 1, 1, {0, 0, 1, 1}},      {7, 3, 2, 3, {-2, -1, 9, 5}},
      {37, 41, 5, 9, {-4, 3, 40, 45}}, {64, 20, 11, 7, {10, -6, 33, 31}},
      {23, 90, 23, 1, {0, 0, 1, 90}},  {50, 50, 33, 40, {-32, -39, 82, 89}}};
  for (const CorrelatorCase& c : cases) {
    const cpu::Correlator correlator(c.map_width + c.local_width - 1,
                                     c.map_height + c.local_height - 1);
    const Raster<float> maps[] = {random_raster(1, c.map_width, c.map_height),
                                  random_raster(2, c.map_width, c.map_height)};
    const Raster<float> locals[] = {random_raster(3, c.local_width, c.local_height),
                                    random_raster(4, c.local_width, c.local_height)};
    const cpu::Spectrum spectra[] = {correlator.forward(maps[0]), correlator.forward(maps[1])};
    const cpu::Spectrum* const map_list[] = {&spectra[0], &spectra[1]};
    const Raster<float>* const local_list[] = {&locals[0], &locals[1]};
    const cpu::Product products[] = {{1, 0}, {0, 0}, {1, 1}};  // an odd number of them
    cpu::CorrelatorScratch scratch;
    for (const bool parallel : {false, true}) {
      int rows_seen = 0;
      std::vector<Raster<float>> sums(3, Raster<float>(c.window.width, c.window.height));
      correlator.correlate(
          map_list, local_list, products, c.window,
          [&](int row, int rows, std::span<const float* const> values) {
            const auto count =
                static_cast<std::size_t>(rows) * static_cast<std::size_t>(c.window.width);
            for (std::size_t k = 0; k < 3; ++k) {
              std::copy_n(values[k], count, sums[k].row(row).begin());
            }
            if (!parallel) rows_seen += rows;
          },
          scratch, parallel);
      if (!parallel) {
        EXPECT_EQ(rows_seen, c.window.height);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        for (int y = 0; y < c.window.height; ++y) {
          for (int x = 0; x < c.window.width; ++x) {
            const double expected =
                cyclic_sum(maps[products[k].map], locals[products[k].local], c.window.left + x,
                           c.window.top + y, correlator.size());
            ASSERT_NEAR(sums[k].at(x, y), expected, 2e-5)
                << c.map_width << " x " << c.map_height << ", product " << k << " at " << x << ", "
                << y;
          }
        }
      }
    }
  }
}

TEST(FftSize, HoldsWhatIsAskedAndIsNeverMoreThanAThirdLarger) {
  for (std::size_t length = 1; length < 3000; ++length) {
    const cpu::FftSize size = cpu::cheapest_fft_size(length, length);
    ASSERT_GE(size.width, length);
    ASSERT_GE(size.height, length);
    ASSERT_LE(static_cast<double>(size.height), 1.34 * static_cast<double>(length) + 1.0);
    ASSERT_TRUE(std::isfinite(cpu::fft_cost(size.height)));
    ASSERT_LE(cpu::fft_cost(size.height), cpu::fft_cost(4096));
  }
}

/// Bytes, so that NaN equals NaN.
void expect_same_bytes(const ScoreSurface& a, const ScoreSurface& b) {
  const auto bytes = [](const Raster<float>& raster) {
    return std::string(reinterpret_cast<const char*>(raster.values().data()),
                       raster.values().size() * sizeof(float));
  };
  EXPECT_EQ(bytes(a.score), bytes(b.score));
  EXPECT_EQ(bytes(a.valid_weight), bytes(b.valid_weight));
}

TEST(CpuBackend, SurfacesAreTheSameToTheByteForAnyNumberOfThreads) {
  for (const Score score : {Score::kZwncc, Score::kWncc, Score::kWnccPaper}) {
    MatchingOptions options;
    options.score = score;
    const Orthomosaic image = test::random_image(1, 97, 83, 0.1, {0.0, 8.3, 0.1, {}});
    const Template local =
        make_template(test::random_image(2, 31, 27, 0.3, test::centred(31, 27, 0.1)), options);
    std::vector<RotatedTemplate> templates;
    for (int k = 0; k < 5; ++k) {
      templates.push_back(rotate_template(local.channel, 0.3 * k, 0.1, pixel_role(options)));
    }
    const PixelWindow window{0, 0, 97, 83};
    std::vector<std::vector<ScoreSurface>> results;
    for (const std::size_t threads : {1U, 2U, 4U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const MapIndex map(image, options);  // anew: nothing cached
      results.push_back(cpu_backend().score_surfaces(map, templates, window));
      results.push_back(cpu_backend().score_surfaces(map, templates, window));  // from the cache
    }
    for (const auto& surfaces : results) {
      for (std::size_t k = 0; k < surfaces.size(); ++k) {
        expect_same_bytes(surfaces[k], results.front()[k]);
      }
    }
  }
}

TEST(CpuBackend, TilesOfAWideWindowEqualTheReference) {
  MatchingOptions options;
  options.min_valid_weight = 0.3;
  const MapIndex map(test::random_image(1, 4300, 9, 0.1, {0.0, 0.9, 0.1, {}}), options);
  const Template local =
      make_template(test::random_image(2, 11, 7, 0.2, test::centred(11, 7, 0.1)), options);
  const RotatedTemplate templates[] = {
      rotate_template(local.channel, 0.2, 0.1, pixel_role(options))};
  const PixelWindow window{-6, 0, 4310, 9};
  const auto fast = cpu_backend().score_surfaces(map, templates, window);
  const auto slow = reference_backend().score_surfaces(map, templates, window);
  for (int row = 0; row < window.height; ++row) {
    for (int column = 0; column < window.width; ++column) {
      const float share = slow[0].valid_weight.at(column, row);
      ASSERT_NEAR(fast[0].valid_weight.at(column, row), share, 1e-4);
      if (std::abs(share - 0.3F) < 1e-4F || std::isnan(slow[0].score.at(column, row))) continue;
      ASSERT_NEAR(fast[0].score.at(column, row), slow[0].score.at(column, row), 1e-5)
          << column << ", " << row;
    }
  }
}

TEST(CpuBackend, AWindowFarFromTheMapHasNoScore) {
  const MapIndex map(test::random_image(1, 40, 40, 0.0, {0.0, 4.0, 0.1, {}}), {});
  const Template local =
      make_template(test::random_image(2, 9, 9, 0.0, test::centred(9, 9, 0.1)), map.options());
  const RotatedTemplate templates[] = {
      rotate_template(local.channel, 0.0, 0.1, pixel_role(map.options()))};
  for (const PixelWindow& window : {PixelWindow{5000, 5000, 8, 8}, PixelWindow{-900, 3, 8, 8}}) {
    const auto surfaces = cpu_backend().score_surfaces(map, templates, window);
    for (const float score : surfaces[0].score.values()) EXPECT_TRUE(std::isnan(score));
    for (const float share : surfaces[0].valid_weight.values()) EXPECT_NEAR(share, 0.0F, 1e-6F);
  }
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define NADIR_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define NADIR_SANITIZED
#endif
#endif

#ifndef NADIR_SANITIZED  // a sanitizer ends the process instead
TEST(Correlator, SaysWhereMemoryIsRefused) {
  constexpr int kNobodyHasSoMuch = 1 << 23;  // a spectrum of 280 TB
  const cpu::Correlator correlator(kNobodyHasSoMuch, kNobodyHasSoMuch);
  EXPECT_THROW(correlator.forward(Raster<float>(1, 1)), std::bad_alloc);
}
#endif

}  // namespace
}  // namespace nadir
