// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "nadir/aerial_mapping/sfm/features.hpp"

namespace nadir::aerial {

/// Approximate nearest descriptors: four randomised kd-trees, the same ones for the same seed.
class DescriptorIndex {
 public:
  DescriptorIndex(const cv::Mat& descriptors, std::uint64_t seed);
  ~DescriptorIndex();
  DescriptorIndex(const DescriptorIndex&) = delete;
  DescriptorIndex& operator=(const DescriptorIndex&) = delete;
  DescriptorIndex(DescriptorIndex&&) = delete;
  DescriptorIndex& operator=(DescriptorIndex&&) = delete;

  /// The `count` nearest of each query: indices and squared distances, one row a query.
  void search(const cv::Mat& queries, int count, cv::Mat& indices, cv::Mat& distances) const;

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

/// Features of two photos that look alike: (feature of the first, feature of the second).
using FeatureMatches = std::vector<std::pair<int, int>>;

/// Mutual nearest descriptors that pass the ratio test; the first `limit` features (the largest)
/// of the first photo only, 0 = all.
FeatureMatches match_features(const PhotoFeatures& first, const PhotoFeatures& second,
                              const DescriptorIndex& first_index,
                              const DescriptorIndex& second_index, int limit = 0);

/// Two photos whose matches agree with one geometry.
struct VerifiedPair {
  std::size_t first = 0;  ///< index of the photo, first < second
  std::size_t second = 0;
  int matches = 0;
  int epipolar_inliers = 0;
  int homography_inliers = 0;
  /// Inliers of the epipolar geometry or of the homography, sorted. Flat ground makes the former
  /// ambiguous, never the latter; relief breaks the latter.
  FeatureMatches inliers;
  int support() const { return std::max(epipolar_inliers, homography_inliers); }
};

/// Robust fundamental matrix and homography of the matches (MAGSAC++, Barath et al. 2020).
void verify(const PhotoFeatures& first, const PhotoFeatures& second, const FeatureMatches& matches,
            std::uint64_t seed, VerifiedPair& pair);

}  // namespace nadir::aerial
