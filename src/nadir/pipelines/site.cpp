// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/site.hpp"

#include <algorithm>
#include <iterator>

#include "nadir/core/error.hpp"

namespace nadir {

std::filesystem::path map_path(const Sequence& sequence, const std::filesystem::path& map) {
  if (!map.empty()) return map;
  if (sequence.map) return *sequence.map;
  throw Error(ErrorKind::kUsage, "the site has no map", sequence.folder.string(),
              "give one with --map FILE");
}

std::optional<std::filesystem::path> surface_path(const Sequence& sequence,
                                                  const std::filesystem::path& map,
                                                  const std::filesystem::path& surface,
                                                  Layers layers) {
  if (layers == Layers::kColour) return std::nullopt;
  if (!surface.empty()) return surface;
  if (map.empty() && sequence.surface) return sequence.surface;
  if (layers == Layers::kBoth) return std::nullopt;
  throw Error(ErrorKind::kUsage, "heights alone are to be compared, but the map has no surface",
              sequence.folder.string(), "give one with --surface FILE");
}

std::optional<Pose2> truth_at(const Sequence& sequence, Stamp stamp) {
  return sequence.truth ? pose_at(*sequence.truth, stamp) : std::nullopt;
}

Trajectory truth_of(const Sequence& sequence, const std::vector<Sequence::LocalMap>& frames) {
  Trajectory truth;
  if (!sequence.truth) return truth;
  std::ranges::copy_if(*sequence.truth, std::back_inserter(truth), [&](const auto& stamped) {
    return stamped.stamp >= frames.front().stamp && stamped.stamp <= frames.back().stamp;
  });
  return truth;
}

}  // namespace nadir
