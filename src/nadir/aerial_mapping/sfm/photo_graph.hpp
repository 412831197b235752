// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nadir/aerial_mapping/mapping_store.hpp"
#include "nadir/aerial_mapping/options.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/aerial_mapping/sfm/matching.hpp"
#include "nadir/aerial_mapping/sfm/pairs.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// Called with the finished share, 0 .. 1.
using Share = std::function<void(double)>;

/// Features of photos and the geometry of pairs, found once and kept by the photos' names, so that
/// a map that grows finds only what is new.
class PhotoGraph {
 public:
  /// With a store, what is found is kept in it and taken from it.
  explicit PhotoGraph(const AerialMappingOptions& options, MappingStore* store = nullptr)
      : options_(options), store_(store) {}

  /// Features of the photos that have none yet. Throws Stopped.
  void detect(const PhotoSet& set, const Share& progress, const StopToken& stop);

  /// Geometry of the pairs that have none yet. Pairs of photos that no position brought together
  /// are first tried with their largest features alone. `set` is sorted by name. Throws Stopped.
  void match(const PhotoSet& set, const PhotoPairs& pairs, const Share& progress,
             const StopToken& stop);

  /// Features of the photos of a set, in its order.
  std::vector<PhotoFeatures> features(const PhotoSet& set) const;

  /// Photos, by number, that are much less sharp than the others of their camera.
  std::vector<std::size_t> blurred(const PhotoSet& set) const;

  /// The pairs that were matched, with the photos' numbers in the set; sorted.
  std::vector<VerifiedPair> verified(const PhotoSet& set, const PhotoPairs& pairs) const;

 private:
  struct Entry {
    PhotoFeatures features;
    std::unique_ptr<DescriptorIndex> index;
  };
  PhotoFeatures features_of(const PhotoSet& set, std::size_t photo) const;
  VerifiedPair pair_of(const MappingPhoto& first, const MappingPhoto& second) const;

  const AerialMappingOptions options_;
  MappingStore* store_;
  std::map<std::string, Entry> photos_;
  std::map<std::pair<std::string, std::string>, VerifiedPair> pairs_;
};

}  // namespace nadir::aerial
