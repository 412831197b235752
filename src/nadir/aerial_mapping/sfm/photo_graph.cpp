// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/photo_graph.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <mutex>

#include "nadir/aerial_mapping/ortho/pixels.hpp"
#include "nadir/aerial_mapping/sfm/stored.hpp"

namespace nadir::aerial {
namespace {

constexpr std::size_t kFeatureMemory = 700U << 20U;  // bytes that all detectors together may use
constexpr int kCoarseFeatures = 1200;
constexpr std::size_t kCoarseMatches = 10;
constexpr double kBlurred = 0.6;  // of the usual sharpness

/// Counts finished work and passes the share on, from one thread at a time.
class Counter {
 public:
  Counter(std::size_t total, const Share& progress) : total_(total), progress_(progress) {}
  void done() {
    const std::scoped_lock lock(mutex_);
    ++count_;
    if (progress_) progress_(static_cast<double>(count_) / static_cast<double>(total_));
  }

 private:
  std::size_t total_;
  const Share& progress_;
  std::size_t count_ = 0;
  std::mutex mutex_;
};

}  // namespace

PhotoFeatures PhotoGraph::features_of(const PhotoSet& set, std::size_t photo) const {
  const std::string& digest = set.photos[photo].digest;
  const std::string key = "features " + digest + " " + std::to_string(options_.features_per_photo);
  const bool kept = store_ != nullptr && !digest.empty();
  if (kept)
    if (const auto bytes = store_->find(key))
      if (auto features = features_from(*bytes)) return std::move(*features);
  PhotoFeatures features = find_features(load_checked(set, photo), options_.features_per_photo);
  if (kept) store_->keep(key, to_bytes(features));
  return features;
}

VerifiedPair PhotoGraph::pair_of(const MappingPhoto& first, const MappingPhoto& second) const {
  const bool near = first.prior.position && second.prior.position;
  const bool kept = store_ != nullptr && !first.digest.empty() && !second.digest.empty();
  std::string key = "pair " + first.digest + " " + second.digest + " " +
                    std::to_string(options_.features_per_photo) + (near ? " near " : " ");
  key += first.name + " " + second.name;  // on which the random numbers depend
  if (kept)
    if (const auto bytes = store_->find(key))
      if (auto pair = pair_from(*bytes)) return std::move(*pair);
  const Entry& a = photos_.at(first.name);
  const Entry& b = photos_.at(second.name);
  VerifiedPair pair;
  const bool promising =
      near || match_features(a.features, b.features, *a.index, *b.index, kCoarseFeatures).size() >=
                  kCoarseMatches;
  if (promising)
    verify(a.features, b.features, match_features(a.features, b.features, *a.index, *b.index),
           seed_of(first.name + "\n" + second.name), pair);
  if (kept) store_->keep(key, to_bytes(pair));
  return pair;
}

void PhotoGraph::detect(const PhotoSet& set, const Share& progress, const StopToken& stop) {
  std::vector<std::size_t> wanted;
  std::size_t largest = 1;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    if (photos_.contains(set.photos[i].name)) continue;
    wanted.push_back(i);
    const CameraPrior& camera = set.cameras[set.photos[i].camera];
    largest = std::max(largest, feature_memory(camera.width, camera.height));
  }
  if (wanted.empty()) return;
  std::vector<Entry> found(wanted.size());
  Counter counter(wanted.size(), progress);
  const auto detect_one = [&](std::size_t k) {
    stop.check();
    Entry& entry = found[k];
    const MappingPhoto& photo = set.photos[wanted[k]];
    entry.features = features_of(set, wanted[k]);
    entry.index =
        std::make_unique<DescriptorIndex>(entry.features.descriptors, seed_of(photo.name));
    counter.done();
  };
  const auto together = static_cast<int>(std::max<std::size_t>(1, kFeatureMemory / largest));
  tbb::task_arena arena(std::min(together, tbb::this_task_arena::max_concurrency()));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, wanted.size(), detect_one); });
  for (std::size_t k = 0; k < wanted.size(); ++k)
    photos_[set.photos[wanted[k]].name] = std::move(found[k]);
}

void PhotoGraph::match(const PhotoSet& set, const PhotoPairs& pairs, const Share& progress,
                       const StopToken& stop) {
  PhotoPairs wanted;
  for (const auto& [a, b] : pairs)
    if (!pairs_.contains({set.photos[a].name, set.photos[b].name})) wanted.emplace_back(a, b);
  if (wanted.empty()) return;
  std::vector<VerifiedPair> found(wanted.size());
  Counter counter(wanted.size(), progress);
  tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t k) {
    stop.check();
    found[k] = pair_of(set.photos[wanted[k].first], set.photos[wanted[k].second]);
    counter.done();
  });
  for (std::size_t k = 0; k < wanted.size(); ++k)
    pairs_[{set.photos[wanted[k].first].name, set.photos[wanted[k].second].name}] =
        std::move(found[k]);
}

std::vector<PhotoFeatures> PhotoGraph::features(const PhotoSet& set) const {
  std::vector<PhotoFeatures> features;
  for (const MappingPhoto& photo : set.photos)
    features.push_back(photos_.at(photo.name).features);  // the descriptors are shared
  return features;
}

std::vector<std::size_t> PhotoGraph::blurred(const PhotoSet& set) const {
  std::map<std::size_t, std::vector<double>> by_camera;
  for (const MappingPhoto& photo : set.photos)
    by_camera[photo.camera].push_back(photos_.at(photo.name).features.sharpness);
  for (auto& [camera, values] : by_camera) std::sort(values.begin(), values.end());
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    const std::vector<double>& values = by_camera.at(set.photos[i].camera);
    const double usual = values[values.size() / 2];
    if (photos_.at(set.photos[i].name).features.sharpness < kBlurred * usual) found.push_back(i);
  }
  return found;
}

std::vector<VerifiedPair> PhotoGraph::verified(const PhotoSet& set, const PhotoPairs& pairs) const {
  std::vector<VerifiedPair> verified;
  for (const auto& [a, b] : pairs) {
    const auto found = pairs_.find({set.photos[a].name, set.photos[b].name});
    if (found == pairs_.end()) continue;
    verified.push_back(found->second);
    verified.back().first = a;
    verified.back().second = b;
  }
  return verified;
}

}  // namespace nadir::aerial
