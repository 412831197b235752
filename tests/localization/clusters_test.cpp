// SPDX-License-Identifier: Apache-2.0
#include "nadir/localization/clusters.hpp"

#include <gtest/gtest.h>

#include "nadir/core/random.hpp"

namespace nadir {
namespace {

/// Adds `count` particles of total weight `mass`, normal around `mean`.
void add_cloud(ParticleSet& set, const Pose2& mean, double sigma_m, double sigma_yaw, int count,
               double mass, std::uint64_t stream) {
  const RandomStream random(3, stream);
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    const auto [x, y] = random.normal_pair(2 * index);
    set.poses.push_back({mean.x + sigma_m * x, mean.y + sigma_m * y,
                         wrap_angle(mean.yaw + sigma_yaw * random.normal(2 * index + 1))});
    set.odometry_scales.push_back(1.0);
    set.weights.push_back(mass / count);
  }
}

TEST(FindClusters, MeanAndCovarianceOfOneCloud) {
  ParticleSet set;
  add_cloud(set, {500000.0, 4.5e6, 1.0}, 0.2, 0.05, 20000, 1.0, 0);
  const std::vector<Cluster> clusters = find_clusters(set, {});
  const Cluster& cluster = clusters.front();
  EXPECT_GT(cluster.mass, 0.98);
  EXPECT_NEAR(cluster.mean.x, 500000.0, 0.01);
  EXPECT_NEAR(cluster.mean.y, 4.5e6, 0.01);
  EXPECT_NEAR(cluster.mean.yaw, 1.0, 0.003);
  EXPECT_NEAR(cluster.covariance(0, 0), 0.04, 0.002);
  EXPECT_NEAR(cluster.covariance(1, 1), 0.04, 0.002);
  EXPECT_NEAR(cluster.covariance(2, 2), 0.0025, 0.0002);
  EXPECT_NEAR(cluster.covariance(0, 1), 0.0, 0.002);
}

// beluga#258: never a mean across modes.
TEST(FindClusters, KeepsTwoPlacesApart) {
  ParticleSet set;
  add_cloud(set, {0.0, 0.0, 0.0}, 0.1, 0.01, 400, 0.4, 0);
  add_cloud(set, {6.0, 0.0, 0.0}, 0.1, 0.01, 600, 0.6, 1);
  const std::vector<Cluster> clusters = find_clusters(set, {});
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_NEAR(clusters[0].mass, 0.6, 1e-9);
  EXPECT_NEAR(clusters[0].mean.x, 6.0, 0.03);
  EXPECT_NEAR(clusters[1].mean.x, 0.0, 0.03);

  LocalizationOptions one;
  one.cluster_estimate = false;
  EXPECT_NEAR(find_clusters(set, one).at(0).mean.x, 3.6, 0.03);
}

TEST(FindClusters, KeepsTwoHeadingsOfOnePlaceApart) {
  ParticleSet set;
  add_cloud(set, {0.0, 0.0, 0.0}, 0.1, 0.01, 500, 0.5, 0);
  add_cloud(set, {0.0, 0.0, kPi / 2}, 0.1, 0.01, 500, 0.5, 1);
  EXPECT_EQ(find_clusters(set, {}).size(), 2U);
}

TEST(FindClusters, TheTurnHasNoSeam) {
  ParticleSet set;
  add_cloud(set, {0.0, 0.0, kPi}, 0.05, 0.1, 2000, 1.0, 0);
  const std::vector<Cluster> clusters = find_clusters(set, {});
  ASSERT_GT(clusters.front().mass, 0.99);
  EXPECT_NEAR(wrap_angle(clusters.front().mean.yaw - kPi), 0.0, 0.01);
  EXPECT_NEAR(clusters.front().covariance(2, 2), 0.01, 0.002);
}

TEST(FindClusters, MassIsNeverAboveOne) {
  ParticleSet set;
  add_cloud(set, {}, 0.0, 0.0, 1000, 1.0, 0);
  for (double& weight : set.weights) weight *= 1.0 + 1e-12;
  EXPECT_EQ(find_clusters(set, {}).at(0).mass, 1.0);
}

TEST(FindClusters, NothingHasNoCluster) { EXPECT_TRUE(find_clusters({}, {}).empty()); }

}  // namespace
}  // namespace nadir
