// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/tracks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nadir::aerial {
namespace {

constexpr double kSamePlacePx = 1.5;  // SIFT gives a place one feature for each main direction

class Forest {
 public:
  explicit Forest(std::size_t size) : root_(size) {
    std::iota(root_.begin(), root_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (root_[i] != i) i = root_[i] = root_[root_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    root_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> root_;
};

/// Leaves one observation a photo; none where two of them lie apart.
Track without_conflicts(const Track& all) {
  Track track;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin + 1;
    bool one_place = true;
    for (; end < all.size() && all[end].photo == all[begin].photo; ++end)
      one_place = one_place &&
                  std::hypot(all[end].u - all[begin].u, all[end].v - all[begin].v) < kSamePlacePx;
    if (one_place) track.push_back(all[begin]);
    begin = end;
  }
  return track;
}

}  // namespace

std::vector<Track> build_tracks(const std::vector<PhotoFeatures>& features,
                                const std::vector<VerifiedPair>& pairs) {
  std::vector<std::size_t> offset{0};
  for (const PhotoFeatures& photo : features) offset.push_back(offset.back() + photo.points.size());
  Forest forest(offset.back());
  for (const VerifiedPair& pair : pairs)
    for (const auto& [i, j] : pair.inliers)
      forest.join(offset[pair.first] + static_cast<std::size_t>(i),
                  offset[pair.second] + static_cast<std::size_t>(j));

  // Nodes come sorted by photo, so each track does too.
  std::vector<Track> by_root(offset.back());
  for (std::size_t photo = 0; photo < features.size(); ++photo)
    for (std::size_t i = 0; i < features[photo].points.size(); ++i) {
      const Feature& p = features[photo].points[i];
      by_root[forest.find(offset[photo] + i)].push_back({photo, p.u, p.v});
    }
  std::vector<Track> tracks;
  for (const Track& all : by_root) {
    if (all.size() < 2) continue;
    Track track = without_conflicts(all);
    if (track.size() >= 2) tracks.push_back(std::move(track));
  }
  return tracks;
}

}  // namespace nadir::aerial
