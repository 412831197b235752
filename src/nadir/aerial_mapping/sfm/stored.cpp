// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/stored.hpp"

#include <cstring>
#include <type_traits>

namespace nadir::aerial {
namespace {

template <class T>
void append(const T* values, std::size_t count, std::string& bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t at = bytes.size();
  bytes.resize(at + count * sizeof(T));
  if (count > 0) std::memcpy(bytes.data() + at, values, count * sizeof(T));
}

/// Takes values off the front; false where there are too few bytes.
template <class T>
bool take(std::string_view& bytes, std::size_t count, T* values) {
  if (count > bytes.size() / sizeof(T)) return false;
  if (count > 0) std::memcpy(values, bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
  return true;
}

/// Whether the bytes are `count` pieces of this size; the count comes from a file, and its product
/// could overflow.
bool holds_exactly(std::string_view bytes, std::uint64_t count, std::size_t size) {
  return bytes.size() % size == 0 && bytes.size() / size == count;
}

}  // namespace

std::string to_bytes(const PhotoFeatures& features) {
  std::string bytes;
  const std::uint64_t count = features.points.size();
  append(&count, 1, bytes);
  append(&features.sharpness, 1, bytes);
  append(features.points.data(), features.points.size(), bytes);
  append(features.descriptors.ptr<float>(), features.descriptors.total(), bytes);
  return bytes;
}

std::optional<PhotoFeatures> features_from(std::string_view bytes) {
  constexpr int kLength = 128;
  PhotoFeatures features;
  std::uint64_t count = 0;
  if (!take(bytes, 1, &count) || !take(bytes, 1, &features.sharpness)) return std::nullopt;
  if (!holds_exactly(bytes, count, sizeof(Feature) + kLength * sizeof(float))) return std::nullopt;
  features.points.resize(count);
  features.descriptors.create(static_cast<int>(count), kLength, CV_32F);
  if (!take(bytes, count, features.points.data()) ||
      !take(bytes, count * kLength, features.descriptors.ptr<float>()))
    return std::nullopt;
  return features;
}

std::string to_bytes(const VerifiedPair& pair) {
  std::string bytes;
  const std::uint64_t count = pair.inliers.size();
  append(&count, 1, bytes);
  append(&pair.matches, 1, bytes);
  append(&pair.epipolar_inliers, 1, bytes);
  append(&pair.homography_inliers, 1, bytes);
  for (const auto& [first, second] : pair.inliers) {
    append(&first, 1, bytes);
    append(&second, 1, bytes);
  }
  return bytes;
}

std::optional<VerifiedPair> pair_from(std::string_view bytes) {
  VerifiedPair pair;
  std::uint64_t count = 0;
  if (!take(bytes, 1, &count) || !take(bytes, 1, &pair.matches) ||
      !take(bytes, 1, &pair.epipolar_inliers) || !take(bytes, 1, &pair.homography_inliers) ||
      !holds_exactly(bytes, count, 2 * sizeof(int)))
    return std::nullopt;
  pair.inliers.resize(count);
  for (auto& [first, second] : pair.inliers)
    if (!take(bytes, 1, &first) || !take(bytes, 1, &second)) return std::nullopt;
  return pair;
}

}  // namespace nadir::aerial
