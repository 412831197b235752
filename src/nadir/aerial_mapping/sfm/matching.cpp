// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/matching.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/flann.hpp>

namespace nadir::aerial {
namespace {

constexpr float kRatio = 0.8F;  // Lowe 2004, of distances
constexpr int kTrees = 4;
constexpr int kChecks = 48;  // leaves that are looked at
constexpr double kEpipolarPx = 2.0;
constexpr double kHomographyPx = 6.0;  // relief of a tenth of the height passes
constexpr int kFewest = 12;
// Below this share of the matches, agreement with an epipolar geometry is chance.
constexpr double kEpipolarShare = 0.25;

cv::UsacParams robust(double threshold, std::uint64_t seed) {
  cv::UsacParams parameters;
  parameters.threshold = threshold;
  parameters.confidence = 0.999;
  parameters.maxIterations = 3000;
  parameters.isParallel = false;
  parameters.randomGeneratorState = static_cast<int>(seed & 0x7fffffffU);
  parameters.sampler = cv::SAMPLING_UNIFORM;
  parameters.score = cv::SCORE_METHOD_MAGSAC;
  parameters.loMethod = cv::LOCAL_OPTIM_SIGMA;
  parameters.loIterations = 10;
  parameters.loSampleSize = 50;
  return parameters;
}

}  // namespace

struct DescriptorIndex::Trees {
  cv::Mat descriptors;  // the index refers to it
  mutable cv::flann::Index index;
};

DescriptorIndex::DescriptorIndex(const cv::Mat& descriptors, std::uint64_t seed)
    : trees_(std::make_unique<Trees>()) {
  trees_->descriptors = descriptors;
  if (descriptors.rows == 0) return;
  // FLANN draws from this thread's generator.
  cv::theRNG().state = seed | 1U;
  trees_->index.build(descriptors, cv::flann::KDTreeIndexParams(kTrees), cvflann::FLANN_DIST_L2);
}

DescriptorIndex::~DescriptorIndex() = default;

void DescriptorIndex::search(const cv::Mat& queries, int count, cv::Mat& indices,
                             cv::Mat& distances) const {
  trees_->index.knnSearch(queries, indices, distances, count, cv::flann::SearchParams(kChecks));
}

FeatureMatches match_features(const PhotoFeatures& first, const PhotoFeatures& second,
                              const DescriptorIndex& first_index,
                              const DescriptorIndex& second_index, int limit) {
  FeatureMatches matches;
  if (first.points.size() < 2 || second.points.size() < 2) return matches;
  cv::Mat queries = first.descriptors;
  if (limit > 0 && limit < queries.rows) queries = queries.rowRange(0, limit);
  cv::Mat indices;
  cv::Mat distances;
  second_index.search(queries, 2, indices, distances);

  FeatureMatches candidates;
  cv::Mat back_queries;
  for (int i = 0; i < queries.rows; ++i) {
    const int j = indices.at<int>(i, 0);
    if (j < 0 || indices.at<int>(i, 1) < 0) continue;
    if (distances.at<float>(i, 0) >= kRatio * kRatio * distances.at<float>(i, 1)) continue;
    candidates.emplace_back(i, j);
    back_queries.push_back(second.descriptors.row(j));
  }
  if (candidates.empty()) return matches;
  first_index.search(back_queries, 1, indices, distances);
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (indices.at<int>(static_cast<int>(k), 0) == candidates[k].first)
      matches.push_back(candidates[k]);
  return matches;
}

void verify(const PhotoFeatures& first, const PhotoFeatures& second, const FeatureMatches& matches,
            std::uint64_t seed, VerifiedPair& pair) {
  pair.matches = static_cast<int>(matches.size());
  if (pair.matches < kFewest) return;
  std::vector<cv::Point2f> a;
  std::vector<cv::Point2f> b;
  for (const auto& [i, j] : matches) {
    const Feature& p = first.points[static_cast<std::size_t>(i)];
    const Feature& q = second.points[static_cast<std::size_t>(j)];
    a.emplace_back(p.u, p.v);
    b.emplace_back(q.u, q.v);
  }
  std::vector<std::uint8_t> epipolar;
  std::vector<std::uint8_t> planar;
  if (cv::findFundamentalMat(a, b, epipolar, robust(kEpipolarPx, seed)).empty())
    epipolar.assign(matches.size(), 0);
  if (cv::findHomography(a, b, planar, robust(kHomographyPx, seed + 1)).empty())
    planar.assign(matches.size(), 0);
  pair.epipolar_inliers = static_cast<int>(std::count(epipolar.begin(), epipolar.end(), 1));
  pair.homography_inliers = static_cast<int>(std::count(planar.begin(), planar.end(), 1));
  if (pair.epipolar_inliers < kEpipolarShare * pair.matches) {
    pair.epipolar_inliers = 0;
    epipolar.assign(matches.size(), 0);
  }
  for (std::size_t k = 0; k < matches.size(); ++k)
    if (epipolar[k] != 0 || planar[k] != 0) pair.inliers.push_back(matches[k]);
}

}  // namespace nadir::aerial
