// SPDX-License-Identifier: Apache-2.0
#include "nadir/runs/particle_log.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "nadir/core/random.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir::cli {
namespace {

using test::TemporaryFolder;

/// A cloud somewhere at UTM scale, where float32 steps by 3 cm and more.
ParticleSet cloud(std::size_t count, std::uint64_t seed) {
  const RandomStream random(seed, 0);
  ParticleSet particles;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, y] = random.normal_pair(2 * i);
    const auto [yaw, weight] = random.uniform_pair(2 * i + 1);
    particles.poses.push_back({431234.5 + x, 5182345.5 + y, 6.0 * yaw - 3.0});
    particles.odometry_scales.push_back(1.0);
    particles.weights.push_back(weight);
  }
  const double sum = std::accumulate(particles.weights.begin(), particles.weights.end(), 0.0);
  for (double& weight : particles.weights) weight /= sum;
  return particles;
}

TEST(ParticleLog, RoundTripsToTheMillimetre) {
  const TemporaryFolder folder;
  ParticleLogWriter writer(folder / "particles.bin");
  writer.append(cloud(100, 1));
  writer.append(cloud(7, 2));
  ParticleLogReader reader(folder / "particles.bin");
  for (const auto& [frame, written] : {std::pair{0, cloud(100, 1)}, {1, cloud(7, 2)}}) {
    const auto read = reader.read(static_cast<std::size_t>(frame));
    ASSERT_TRUE(read);
    ASSERT_EQ(read->size(), written.size());
    for (std::size_t i = 0; i < read->size(); ++i) {
      const auto& particle = read->at(i);
      EXPECT_NEAR(double{particle.x} + reader.anchor().x, written.poses[i].x, 1e-3);
      EXPECT_NEAR(double{particle.y} + reader.anchor().y, written.poses[i].y, 1e-3);
      EXPECT_NEAR(particle.yaw, written.poses[i].yaw, 1e-6);
      EXPECT_NEAR(particle.weight, written.weights[i], 1e-7);
    }
  }
  EXPECT_FALSE(reader.read(2));
}

TEST(ParticleLog, IsReadWhileItGrows) {
  const TemporaryFolder folder;
  ParticleLogWriter writer(folder / "particles.bin");
  ParticleLogReader reader(folder / "particles.bin");
  EXPECT_FALSE(reader.read(0));
  writer.append(cloud(10, 1));
  ASSERT_TRUE(reader.read(0));
  EXPECT_FALSE(reader.read(1));
  std::filesystem::rename(folder / "particles.bin", folder / "moved.bin");  // the run has ended
  writer.append(cloud(20, 2));
  ASSERT_TRUE(reader.read(1));
  EXPECT_EQ(reader.read(1)->size(), 20U);
}

TEST(ParticleLog, ALargeCloudIsThinnedAndItsWeightsSumToOne) {
  const std::vector<LoggedParticle> kept = thinned(cloud(20001, 3), {431234, 5182345});
  EXPECT_LE(kept.size(), kMostLoggedParticles);
  EXPECT_GT(kept.size(), kMostLoggedParticles / 2);
  double sum = 0.0;
  for (const LoggedParticle& particle : kept) sum += double{particle.weight};
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST(ParticleLog, RefusesOtherFilesAndPassesOverACutEnd) {
  const TemporaryFolder folder;
  test::write_text(folder / "other.bin", "this is no particle log at all");
  test::expect_error(ErrorKind::kInput, {"other.bin", "no particle log"},
                     [&] { ParticleLogReader reader(folder / "other.bin"); });
  test::expect_error(ErrorKind::kInput, {"none.bin"},
                     [&] { ParticleLogReader reader(folder / "none.bin"); });
  {
    ParticleLogWriter writer(folder / "cut.bin");
    writer.append(cloud(10, 1));
    writer.append(cloud(10, 2));
  }
  std::filesystem::resize_file(folder / "cut.bin",
                               std::filesystem::file_size(folder / "cut.bin") - 5);
  ParticleLogReader reader(folder / "cut.bin");
  EXPECT_TRUE(reader.read(0));
  EXPECT_FALSE(reader.read(1));
}

}  // namespace
}  // namespace nadir::cli
