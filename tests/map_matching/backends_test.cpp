// SPDX-License-Identifier: Apache-2.0
// Every fast path of every backend against the reference, on random images, masks, sizes, offsets
// and headings. The backend `cuda` runs where there is a GPU, its kernels on the CPU everywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <tuple>

#include "map_matching/emulated_device.hpp"
#include "map_matching/random_maps.hpp"
#include "nadir/map_matching/cuda/backend.hpp"
#include "nadir/map_matching/cuda_status.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

using test::centred;
using test::random_image;

struct Variant {
  Score score = Score::kZwncc;
  HoleTreatment holes = HoleTreatment::kMasked;
  PaperWeight weight = PaperWeight::kLiteral;
  Channel channel = Channel::kGrey;
  double tolerance = 1e-5;  ///< of surfaces; for the distances, of grey levels
  const char* name = "";
  friend void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }
};

const Variant kVariants[] = {
    {.score = Score::kSsd, .tolerance = 2e-2, .name = "ssd"},
    {.score = Score::kSsd, .holes = HoleTreatment::kWhite, .tolerance = 2e-2, .name = "ssd_white"},
    {.score = Score::kSad, .tolerance = 1e-3, .name = "sad"},
    {.score = Score::kSad, .holes = HoleTreatment::kWhite, .tolerance = 1e-3, .name = "sad_white"},
    {.score = Score::kNcc, .name = "ncc"},
    {.score = Score::kWncc, .name = "wncc"},
    // The literal weight reaches thousands of grey levels squared: relative to its own size.
    {.score = Score::kWnccPaper, .tolerance = 2e-4, .name = "wncc_paper_literal"},
    {.score = Score::kWnccPaper,
     .weight = PaperWeight::kNormalised,
     .tolerance = 1e-6,
     .name = "wncc_paper_normalised"},
    {.score = Score::kZncc, .name = "zncc"},
    {.score = Score::kZwncc, .name = "zwncc"},
    {.score = Score::kZwncc, .channel = Channel::kHighPass, .name = "zwncc_high_pass"},
};

enum class Tested { kCpu, kCudaKernelsOnCpu, kCuda };

const MatchingBackend& backend_of(Tested tested) {
  static const cuda::DeviceBackend emulated(
      [] { return std::make_unique<test::EmulatedDevice>(); });
  switch (tested) {
    case Tested::kCudaKernelsOnCpu:
      return emulated;
    case Tested::kCuda:
      return cuda_backend();
    case Tested::kCpu:
      break;
  }
  return cpu_backend();
}

class BackendsTest : public testing::TestWithParam<std::tuple<Variant, Tested>> {
 protected:
  void SetUp() override {
    if (std::get<1>(GetParam()) != Tested::kCuda) return;
    static const CudaStatus status = cuda_status();
    if (!status.usable) GTEST_SKIP() << "no CUDA: " << status.detail;
  }
  static const Variant& variant() { return std::get<0>(GetParam()); }
  static const MatchingBackend& tested() { return backend_of(std::get<1>(GetParam())); }
  static MatchingOptions options(double min_valid_weight = 0.5) {
    MatchingOptions options;
    options.score = variant().score;
    options.holes = variant().holes;
    options.paper_weight = variant().weight;
    options.channel = variant().channel;
    options.min_valid_weight = min_valid_weight;
    return options;
  }
};

void expect_same(double fast, double reference, double tolerance, const std::string& where) {
  ASSERT_EQ(std::isnan(fast), std::isnan(reference)) << where << ": " << fast << ", " << reference;
  if (std::isnan(fast)) return;
  ASSERT_NEAR(fast, reference, tolerance * (1.0 + std::abs(reference))) << where;
}

/// A share that rounding may put on either side of the limit says nothing.
bool borderline(double share, double limit) { return std::abs(share - limit) < 1e-4; }

TEST_P(BackendsTest, SurfacesEqualTheReference) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const RandomStream random(seed, 3);
    const auto draw = [&](std::uint64_t i, int low, int high) {
      return low + static_cast<int>(random.uniform(i) * (high - low));
    };
    const MapIndex map(random_image(seed, draw(0, 20, 60), draw(1, 20, 60),
                                    random.uniform(2, 0.0, 0.3), {3.0, 7.0, 0.1, {}}),
                       options());
    const int width = draw(3, 3, 24);
    const int height = draw(4, 3, 24);
    const Template local =
        make_template(random_image(seed + 100, width, height, random.uniform(5, 0.0, 0.4),
                                   {-0.1 * draw(6, 0, width), 0.1 * draw(7, 0, height), 0.1, {}}),
                      options());
    std::vector<RotatedTemplate> templates;
    for (const double yaw : {0.0, random.uniform(8, -kPi, kPi), random.uniform(9, -kPi, kPi)}) {
      templates.push_back(rotate_template(local.channel, yaw, 0.1, pixel_role(map.options())));
    }
    // The window reaches beyond the map on all sides.
    const PixelWindow window{draw(10, -12, 8), draw(11, -12, 8), draw(12, 1, 60), draw(13, 1, 60)};
    const auto fast = tested().score_surfaces(map, templates, window);
    const auto slow = reference_backend().score_surfaces(map, templates, window);
    ASSERT_EQ(fast.size(), slow.size());
    for (std::size_t k = 0; k < fast.size(); ++k) {
      for (int row = 0; row < window.height; ++row) {
        for (int column = 0; column < window.width; ++column) {
          const std::string where = "seed " + std::to_string(seed) + " template " +
                                    std::to_string(k) + " at " + std::to_string(column) + ", " +
                                    std::to_string(row);
          const double share = slow[k].valid_weight.at(column, row);
          ASSERT_NEAR(fast[k].valid_weight.at(column, row), share, 1e-4) << where;
          if (borderline(share, 0.5)) continue;
          expect_same(fast[k].score.at(column, row), slow[k].score.at(column, row),
                      variant().tolerance, where);
        }
      }
    }
  }
}

TEST_P(BackendsTest, ATemplateLargerThanTheMapEqualsTheReference) {
  for (const auto& [width, height] : {std::pair{2, 3}, std::pair{9, 4}, std::pair{5, 40}}) {
    const MapIndex map(random_image(1, width, height, 0.1, {0.0, 0.1 * height, 0.1, {}}),
                       options(0.02));
    const Template local =
        make_template(random_image(2, 31, 23, 0.1, centred(31, 23, 0.1)), options(0.02));
    const std::vector<RotatedTemplate> templates = {
        rotate_template(local.channel, 0.0, 0.1, pixel_role(map.options())),
        rotate_template(local.channel, 0.8, 0.1, pixel_role(map.options()))};
    const PixelWindow window{-3, -2, width + 6, height + 4};
    const auto fast = tested().score_surfaces(map, templates, window);
    const auto slow = reference_backend().score_surfaces(map, templates, window);
    for (std::size_t k = 0; k < templates.size(); ++k) {
      for (std::size_t i = 0; i < slow[k].score.values().size(); ++i) {
        const double share = slow[k].valid_weight.values()[i];
        ASSERT_NEAR(fast[k].valid_weight.values()[i], share, 1e-4) << i;
        if (borderline(share, 0.02)) continue;
        expect_same(fast[k].score.values()[i], slow[k].score.values()[i], 10 * variant().tolerance,
                    std::to_string(i));
      }
    }
  }
}

TEST_P(BackendsTest, PosesEqualTheReference) {
  const MapIndex map(random_image(5, 61, 47, 0.02, {500000.0, 4.7e6, 0.1, {}}), options());
  const Template local =
      make_template(random_image(6, 21, 16, 0.3, {-0.7, 1.1, 0.1, {}}), options());
  const RandomStream random(1, 1);
  std::vector<Pose2> poses;
  for (std::uint64_t i = 0; i < 200; ++i) {
    poses.push_back({500000.0 + random.uniform(3 * i, -1.0, 7.0),
                     4.7e6 - random.uniform(3 * i + 1, -1.0, 6.0),
                     random.uniform(3 * i + 2, -kPi, kPi)});
  }
  poses.push_back({0.0, 0.0, 0.0});
  poses.push_back({1e300, -1e300, 1.0});
  const auto fast = tested().score_poses(map, local, poses);
  const auto slow = reference_backend().score_poses(
      map, local, std::span<const Pose2>(poses).first(poses.size() - 1));
  int defined = 0;
  for (std::size_t i = 0; i < slow.size(); ++i) {
    ASSERT_NEAR(fast[i].valid_weight, slow[i].valid_weight, 1e-2) << i;
    // A sample on the very edge of a hole may fall on either side in single precision.
    if (std::abs(fast[i].valid_weight - slow[i].valid_weight) > 1e-4) continue;
    if (borderline(slow[i].valid_weight, 0.5)) continue;
    expect_same(fast[i].score, slow[i].score, 10 * variant().tolerance, std::to_string(i));
    defined += std::isnan(slow[i].score) ? 0 : 1;
  }
  EXPECT_GT(defined, 50);
  EXPECT_TRUE(std::isnan(fast.back().score));
}

std::string name_of(const testing::TestParamInfo<std::tuple<Variant, Tested>>& info) {
  return std::get<0>(info.param).name;
}
const auto kEveryVariant = testing::ValuesIn(kVariants);
INSTANTIATE_TEST_SUITE_P(Cpu, BackendsTest,
                         testing::Combine(kEveryVariant, testing::Values(Tested::kCpu)), name_of);
INSTANTIATE_TEST_SUITE_P(CudaKernelsOnCpu, BackendsTest,
                         testing::Combine(kEveryVariant,
                                          testing::Values(Tested::kCudaKernelsOnCpu)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Cuda, BackendsTest,
                         testing::Combine(kEveryVariant, testing::Values(Tested::kCuda)), name_of);

}  // namespace
}  // namespace nadir
