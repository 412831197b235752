// SPDX-License-Identifier: Apache-2.0
// What is peculiar to the backend `cuda`: batches and streams, templates turned on the device, the
// best places, degenerate input. The kernels run on the CPU (EmulatedDevice); where a GPU is
// usable, ParityTest runs them there too. Scores themselves: backends_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "map_matching/emulated_device.hpp"
#include "map_matching/random_maps.hpp"
#include "nadir/core/error.hpp"
#include "nadir/map_matching/cuda/backend.hpp"
#include "nadir/map_matching/cuda/device_map.hpp"
#include "nadir/map_matching/cuda/surfaces.hpp"
#include "nadir/map_matching/cuda_status.hpp"

namespace nadir {
namespace {

using cuda::DeviceBackend;
using cuda::Place;
using test::EmulatedDevice;
using test::random_image;

MatchingOptions grey(Score score, double min_valid_weight = 0.5) {
  MatchingOptions options;
  options.score = score;
  options.channel = Channel::kGrey;
  options.min_valid_weight = min_valid_weight;
  return options;
}

DeviceBackend emulated(std::size_t workspace_bytes = std::size_t{64} << 20U) {
  return DeviceBackend([=] { return std::make_unique<EmulatedDevice>(workspace_bytes); });
}

std::vector<double> all_headings(int count) {
  std::vector<double> yaws;
  for (int i = 0; i < count; ++i) yaws.push_back(-kPi + 2.0 * kPi * i / count);
  return yaws;
}

std::vector<RotatedTemplate> turned(const Template& local, const std::vector<double>& yaws,
                                    const MatchingOptions& options) {
  std::vector<RotatedTemplate> templates;
  for (const double yaw : yaws) {
    templates.push_back(rotate_template(local.channel, yaw, 0.1, pixel_role(options)));
  }
  return templates;
}

/// Bit by bit, so that NaN equals itself.
bool identical(const Raster<float>& a, const Raster<float>& b) {
  return a.values().size() == b.values().size() &&
         std::memcmp(a.values().data(), b.values().data(), a.values().size() * sizeof(float)) == 0;
}

/// Local maxima of the surfaces, by the definition, best first.
std::vector<Place> maxima(const std::vector<ScoreSurface>& surfaces) {
  std::vector<Place> places;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const Raster<float>& score = surfaces[k].score;
    for (int row = 0; row < score.height(); ++row) {
      for (int column = 0; column < score.width(); ++column) {
        const float at = score.at(column, row);
        if (std::isnan(at)) continue;
        bool best = true;
        for (int n = 0; n < 9; ++n) {
          const int u = column + n % 3 - 1;
          const int v = row + n / 3 - 1;
          if (n == 4 || !score.contains(u, v)) continue;
          const float other = score.at(u, v);
          if (other > at || (n < 4 && other == at)) best = false;
        }
        if (best) places.push_back({k, column, row, at});
      }
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.score > b.score; });
  return places;
}

TEST(CudaKernelsTest, TransformSizesAreFastAndEvenAndLargeEnough) {
  for (int least = 1; least < 3000; ++least) {
    int rest = cuda::fft_size(least);
    ASSERT_GE(rest, least);
    ASSERT_EQ(rest % 2, 0);
    for (const int factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) rest /= factor;
    }
    ASSERT_EQ(rest, 1) << least;
  }
  EXPECT_EQ(cuda::fft_size(1024), 1024);
  EXPECT_EQ(cuda::fft_size(1025), 1050);
}

TEST(CudaKernelsTest, BatchesCoverAllTemplatesWithinTheMemory) {
  for (const int count : {1, 2, 7, 8, 9, 33, 360}) {
    for (const std::size_t bytes : {std::size_t{1}, std::size_t{100}, std::size_t{100000}}) {
      const int size = cuda::batch_size(count, bytes, 10);
      ASSERT_GE(size, 1);
      ASSERT_LE(size, count);
      if (size > 1) {
        ASSERT_LE(static_cast<std::size_t>(size) * 10 * cuda::Device::kStreams, bytes);
      }
      // The last batch lacks less than one template for each batch.
      const int batches = (count + size - 1) / size;
      ASSERT_LT(batches * size - count, batches);
    }
  }
}

TEST(CudaKernelsTest, KeysOrderPlacesByScoreThenByPosition) {
  const std::vector<float> scores = {
      -std::numeric_limits<float>::max(), -3.5F, -1e-30F, 0.0F, 1e-30F, 0.25F, 1.0F, 65000.0F};
  for (std::size_t i = 1; i < scores.size(); ++i) {
    EXPECT_LT(cuda::peak_key(scores[i - 1], 0), cuda::peak_key(scores[i], 1000));
  }
  EXPECT_GT(cuda::peak_key(0.5F, 3), cuda::peak_key(0.5F, 4));
  for (const float score : scores) {
    EXPECT_EQ(cuda::score_of(cuda::peak_key(score, 77)), score);
    EXPECT_EQ(cuda::place_of(cuda::peak_key(score, 77)), 77U);
    EXPECT_NE(cuda::peak_key(score, 77), 0U);
  }
}

TEST(CudaKernelsTest, TemplatesTurnOnTheDeviceAsOnTheHost) {
  for (const Score score : {Score::kZwncc, Score::kZncc, Score::kWncc}) {
    const MatchingOptions options = grey(score);
    const Template local =
        make_template(random_image(3, 23, 14, 0.3, {-0.9, 1.7, 0.1, {}}), options);
    const PixelRole role = pixel_role(options);
    const std::vector<std::uint8_t> pixels = cuda::with_holes(local.channel);
    for (const double yaw : {0.0, 0.3, 1.5707963267948966, -2.9}) {
      const RotatedTemplate expected = rotate_template(local.channel, yaw, 0.1, role);
      const cuda::Heading heading{std::cos(yaw), std::sin(yaw)};
      const cuda::Box box{expected.left - 2, expected.top - 1, expected.value.width() + 5,
                          expected.value.height() + 3};
      std::vector<cuda::TurnedPixel> result(static_cast<std::size_t>(box.width) *
                                            static_cast<std::size_t>(box.height));
      EmulatedDevice device;
      device.launch(cuda::TurnTemplates{pixels.data(), 23, 14, -0.9, 1.7, 0.1, 0.1, role.weighted,
                                        role.weighted_norms, &heading, 1, box, result.data()},
                    0);
      for (std::size_t i = 0; i < result.size(); ++i) {
        const int column = static_cast<int>(i) % box.width - 2;
        const int row = static_cast<int>(i) / box.width - 1;
        const bool inside = expected.value.contains(column, row);
        ASSERT_EQ(result[i].value, inside ? expected.value.at(column, row) : 0.0F);
        ASSERT_EQ(result[i].mask, inside ? expected.mask.at(column, row) : 0.0F);
        ASSERT_EQ(result[i].weight, inside ? expected.weight.at(column, row) : 0.0F);
        ASSERT_EQ(result[i].seen, inside ? expected.seen.at(column, row) : 0.0F);
      }
    }
  }
}

TEST(CudaKernelsTest, BatchesAndStreamsDoNotChangeTheResult) {
  for (const Score score : {Score::kZwncc, Score::kWncc, Score::kSad, Score::kWnccPaper}) {
    const MapIndex map(random_image(1, 57, 43, 0.1, {0.0, 4.3, 0.1, {}}), grey(score));
    const Template local =
        make_template(random_image(2, 17, 12, 0.2, {-0.8, 0.6, 0.1, {}}), map.options());
    const auto templates = turned(local, all_headings(13), map.options());
    const PixelWindow window{-5, 3, 61, 30};
    const auto at_once = emulated().score_surfaces(map, templates, window);
    const auto one_by_one = emulated(1).score_surfaces(map, templates, window);
    ASSERT_EQ(at_once.size(), templates.size());
    for (std::size_t k = 0; k < templates.size(); ++k) {
      EXPECT_TRUE(identical(at_once[k].score, one_by_one[k].score)) << to_string(score) << k;
      EXPECT_TRUE(identical(at_once[k].valid_weight, one_by_one[k].valid_weight));
    }
  }
}

TEST(CudaKernelsTest, TheBestPlacesAreTheLocalMaximaOfTheSurfaces) {
  for (const Score score : {Score::kZwncc, Score::kNcc, Score::kSad, Score::kWnccPaper}) {
    const MapIndex map(random_image(4, 61, 48, 0.05, {2.0, 9.0, 0.1, {}}), grey(score));
    const Template local =
        make_template(random_image(5, 15, 19, 0.1, {-0.7, 1.0, 0.1, {}}), map.options());
    const std::vector<double> yaws = all_headings(9);
    const PixelWindow window{-6, -4, 70, 60};
    const auto expected =
        maxima(emulated().score_surfaces(map, turned(local, yaws, map.options()), window));
    for (const std::size_t workspace : {std::size_t{1}, std::size_t{64} << 20U}) {
      const auto places =
          cuda::KeptMap(emulated(workspace), map).best_places(local, yaws, window, 40);
      ASSERT_EQ(places.size(), 40U) << to_string(score);
      for (std::size_t i = 0; i < places.size(); ++i) {
        ASSERT_NEAR(places[i].score, expected[i].score, 1e-4) << i;
        // Where two are nearly equal, rounding may order them.
        if (i + 1 < expected.size() && expected[i].score - expected[i + 1].score < 1e-4F) break;
        ASSERT_EQ(places[i].yaw, expected[i].yaw) << i;
        ASSERT_EQ(places[i].column, expected[i].column) << i;
        ASSERT_EQ(places[i].row, expected[i].row) << i;
      }
    }
  }
}

TEST(CudaKernelsTest, NothingToCompareIsUndefinedEverywhere) {
  struct Case {
    const char* name;
    double map_holes, local_holes;
    int map_width, map_height, local_width, local_height;
    PixelWindow window;
  };
  const Case cases[] = {
      {"template of holes", 0.0, 1.0, 20, 20, 9, 9, {0, 0, 20, 20}},
      {"window off the map", 0.0, 0.0, 20, 20, 9, 9, {500, -900, 7, 5}},
      {"map of one pixel", 0.0, 0.0, 1, 1, 9, 9, {-3, -3, 7, 7}},
  };
  for (const Case& c : cases) {
    for (const auto& [score, name] : kScoreNames) {
      const MapIndex map(
          random_image(1, c.map_width, c.map_height, c.map_holes, {0.0, 2.0, 0.1, {}}),
          grey(score));
      const Template local =
          make_template(random_image(2, c.local_width, c.local_height, c.local_holes,
                                     test::centred(c.local_width, c.local_height, 0.1)),
                        map.options());
      const auto surfaces =
          emulated().score_surfaces(map, turned(local, {0.0, 0.4}, map.options()), c.window);
      ASSERT_EQ(surfaces.size(), 2U);
      for (const float value : surfaces[1].score.values())
        ASSERT_TRUE(std::isnan(value)) << c.name << name;
      for (const float value : surfaces[1].valid_weight.values())
        ASSERT_LT(value, 0.5F) << c.name << name;
      EXPECT_TRUE(
          cuda::KeptMap(emulated(), map).best_places(local, all_headings(3), c.window, 5).empty());
    }
  }
}

TEST(CudaKernelsTest, OneGreyIsUndefinedForTheZeroMeanScores) {
  for (const Score score : {Score::kZncc, Score::kZwncc, Score::kWnccPaper}) {
    Orthomosaic flat = random_image(2, 11, 9, 0.0, test::centred(11, 9, 0.1));
    std::fill(flat.image.values().begin(), flat.image.values().end(), std::uint8_t{120});
    const MapIndex map(random_image(1, 30, 25, 0.0, {0.0, 2.5, 0.1, {}}), grey(score));
    const Template local = make_template(flat, map.options());
    // Unturned, so that no white corner gives [5] contrast.
    const auto surfaces =
        emulated().score_surfaces(map, turned(local, {0.0}, map.options()), {10, 10, 6, 5});
    for (const float value : surfaces[0].score.values()) EXPECT_TRUE(std::isnan(value));
    const std::vector<Pose2> poses = {{1.5, 1.2, 0.0}};
    EXPECT_TRUE(std::isnan(emulated().score_poses(map, local, poses)[0].score));
  }
}

TEST(CudaKernelsTest, NoPlaceIsLostWhereTheWholeTemplateMustBeCompared) {
  for (const Score score : {Score::kZwncc, Score::kZncc, Score::kSad}) {
    const MapIndex map(random_image(1, 40, 35, 0.0, {0.0, 3.5, 0.1, {}}), grey(score, 1.0));
    const Template local =
        make_template(random_image(2, 11, 9, 0.2, test::centred(11, 9, 0.1)), map.options());
    const auto surfaces =
        emulated().score_surfaces(map, turned(local, {0.0}, map.options()), {10, 10, 15, 12});
    for (const float value : surfaces[0].score.values()) EXPECT_FALSE(std::isnan(value));
  }
}

/// Counts what goes to the device.
class CountingDevice : public EmulatedDevice {
 public:
  struct Counts {
    int map_planes = 0;
    int level_planes = 0;
    std::size_t uploaded = 0;
    int living = 0;
  };
  explicit CountingDevice(Counts& counts, std::size_t workspace_bytes = std::size_t{64} << 20U)
      : EmulatedDevice(workspace_bytes), counts_(counts) {}
  void* allocate(std::size_t bytes) override {
    ++counts_.living;
    return EmulatedDevice::allocate(bytes);
  }
  void release(void* memory) noexcept override {
    --counts_.living;
    EmulatedDevice::release(memory);
  }
  void upload(void* to, const void* from, std::size_t bytes, int stream) override {
    counts_.uploaded += bytes;
    EmulatedDevice::upload(to, from, bytes, stream);
  }
  void launch(const cuda::Kernel& kernel, int stream) override {
    counts_.map_planes += std::holds_alternative<cuda::MapPlanes>(kernel) ? 1 : 0;
    if (const auto* planes = std::get_if<cuda::LevelPlanes>(&kernel)) {
      counts_.level_planes += planes->count;
    }
    EmulatedDevice::launch(kernel, stream);
  }

 private:
  Counts& counts_;
};

TEST(CudaKernelsTest, TheMapGoesToTheDeviceOnceAndItsSpectraAreKept) {
  CountingDevice::Counts counts;
  {
    const DeviceBackend backend([&] { return std::make_unique<CountingDevice>(counts); });
    const MapIndex index(random_image(1, 60, 50, 0.0, {0.0, 5.0, 0.1, {}}), grey(Score::kZwncc));
    const auto on_device = std::dynamic_pointer_cast<cuda::DeviceMap>(backend.prepare(index));
    ASSERT_NE(on_device, nullptr);
    const std::size_t map_bytes = counts.uploaded;
    EXPECT_EQ(map_bytes, 60U * 50U + 64U * 54U * 4U);

    cuda::SurfaceJob job{{0, 0, 60, 50}, {-6, -6, 13, 13}, 2, cuda::rule_of(index.options())};
    const Template local =
        make_template(random_image(2, 11, 11, 0.0, test::centred(11, 11, 0.1)), index.options());
    for (int search = 0; search < 3; ++search) {
      cuda::PeakSink sink(*on_device->device, job, {0, 0, 60, 50}, 3);
      cuda::correlate_surfaces(
          *on_device, job,
          [](const cuda::Batch& batch, cuda::StreamWork& work) {
            const auto pixels = static_cast<std::size_t>(13 * 13 * batch.count);
            cuda::TurnedPixel* to = work.turned.reserve(pixels);
            for (std::size_t i = 0; i < pixels; ++i) {
              to[i] = {static_cast<float>(i * 37 % 200), 1.0F, 1.0F, 1.0F};
            }
          },
          sink);
      EXPECT_EQ(sink.places().size(), 3U);
    }
    EXPECT_EQ(counts.uploaded, map_bytes);
    EXPECT_EQ(counts.map_planes, 1);
  }
  EXPECT_EQ(counts.living, 0);
}

TEST(CudaKernelsTest, SpectraOfGreyLevelsAreKeptWithinTheMemory) {
  const MapIndex map(random_image(1, 60, 50, 0.1, {0.0, 5.0, 0.1, {}}), grey(Score::kWnccPaper));
  const Template local =
      make_template(random_image(2, 11, 11, 0.2, test::centred(11, 11, 0.1)), map.options());
  const auto templates = turned(local, all_headings(5), map.options());
  const auto search = [&](std::size_t workspace_bytes, const PixelWindow& second) {
    CountingDevice::Counts counts;
    const DeviceBackend backend(
        [&] { return std::make_unique<CountingDevice>(counts, workspace_bytes); });
    {
      const cuda::KeptMap kept(backend, map);
      kept.score_surfaces(templates, {0, 0, 60, 50});
      const int first = counts.level_planes;
      EXPECT_GT(first, 0);
      // Whole groups; each once, but where only one fits.
      EXPECT_TRUE(first <= 256 || workspace_bytes == 1) << first;
      kept.score_surfaces(templates, second);
      counts.level_planes -= first;
    }
    EXPECT_EQ(counts.living, 0);
    return counts.level_planes;
  };
  EXPECT_EQ(search(std::size_t{64} << 20U, {0, 0, 60, 50}), 0);
  // Another part of the map has others, and so does the map where only one group fits.
  EXPECT_GT(search(std::size_t{64} << 20U, {20, 20, 4, 4}), 0);
  EXPECT_GT(search(1, {0, 0, 60, 50}), 0);
}

/// Computes all but one thing rightly.
class FaultyDevice : public EmulatedDevice {
 public:
  void launch(const cuda::Kernel& kernel, int stream) override {
    EmulatedDevice::launch(kernel, stream);
    if (const auto* scores = std::get_if<cuda::AssembleScores>(&kernel)) {
      // In the middle of the first of two surfaces.
      scores->score[scores->items() / 4 + scores->window.width / 2] += 0.01F;
    }
  }
};

TEST(CudaKernelsTest, TheSelfTestTellsWrongFromRight) {
  EXPECT_EQ(cuda::self_test(emulated()), "");
  const DeviceBackend faulty([] { return std::make_unique<FaultyDevice>(); });
  EXPECT_NE(cuda::self_test(faulty), "");
}

TEST(CudaKernelsTest, ABackendThatCannotBeUsedSaysSo) {
  const CudaStatus status = cuda_status();
  if (status.usable) GTEST_SKIP() << "CUDA is usable: " << status.detail;
  EXPECT_FALSE(status.detail.empty());
  EXPECT_EQ(status.built, !cuda_version().empty());
  MatchingOptions options;
  options.backend = Backend::kCuda;
  EXPECT_THROW(MapIndex(random_image(1, 20, 20, 0.0, {}), options), Error);
}

/// The GPU against its own kernels on the CPU: but for cuFFT, the same operations in the same
/// order.
TEST(CudaParityTest, TheGpuComputesWhatItsKernelsComputeOnTheCpu) {
  const CudaStatus status = cuda_status();
  if (!status.usable) GTEST_SKIP() << "no CUDA: " << status.detail;
  const auto* gpu = dynamic_cast<const DeviceBackend*>(&cuda_backend());
  ASSERT_NE(gpu, nullptr);
  for (const auto& [score, name] : kScoreNames) {
    const MapIndex map(random_image(1, 157, 143, 0.1, {0.0, 14.3, 0.1, {}}), grey(score));
    const Template local =
        make_template(random_image(2, 37, 32, 0.2, {-1.8, 1.6, 0.1, {}}), map.options());
    const std::vector<double> yaws = all_headings(24);
    const PixelWindow window{-5, 3, 161, 130};
    const auto places = cuda::KeptMap(*gpu, map).best_places(local, yaws, window, 30);
    const auto expected = cuda::KeptMap(emulated(), map).best_places(local, yaws, window, 30);
    ASSERT_EQ(places.size(), expected.size()) << name;
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_NEAR(places[i].score, expected[i].score, 1e-4 * (1.0 + std::abs(expected[i].score)));
    }
    std::vector<Pose2> poses;
    for (int i = 0; i < 300; ++i) poses.push_back({0.05 * i, 0.047 * i, 0.1 * i});
    const auto scores = gpu->score_poses(map, local, poses);
    const auto on_cpu = emulated().score_poses(map, local, poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      ASSERT_EQ(std::isnan(scores[i].score), std::isnan(on_cpu[i].score)) << name << i;
      EXPECT_EQ(scores[i].valid_weight, on_cpu[i].valid_weight) << name << i;
      if (std::isnan(scores[i].score)) continue;
      EXPECT_EQ(scores[i].score, on_cpu[i].score) << name << i;
    }
  }
}

}  // namespace
}  // namespace nadir
