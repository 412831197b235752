// SPDX-License-Identifier: Apache-2.0
#include "site.hpp"

#include <algorithm>
#include <cstdlib>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"

namespace nadir::cli {
namespace {

constexpr std::int64_t kSameInstantNs = 10'000'000;

}  // namespace

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
  return sequence.truth ? truth_at(*sequence.truth, stamp) : std::nullopt;
}

std::optional<Pose2> truth_at(const Trajectory& truth, Stamp stamp) {
  const Stamp earliest{stamp.nanoseconds - kSameInstantNs};
  const auto found =
      std::ranges::lower_bound(truth, earliest, {}, &StampedPose<frames::Map>::stamp);
  if (found == truth.end() || found->stamp.nanoseconds > stamp.nanoseconds + kSameInstantNs) {
    return std::nullopt;
  }
  return found->pose;
}

Trajectory truth_of(const Sequence& sequence, const std::vector<Sequence::LocalMap>& frames) {
  Trajectory truth;
  if (!sequence.truth) return truth;
  std::ranges::copy_if(*sequence.truth, std::back_inserter(truth), [&](const auto& stamped) {
    return stamped.stamp >= frames.front().stamp && stamped.stamp <= frames.back().stamp;
  });
  return truth;
}

std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  const std::string& flag, const std::string& form) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    numbers.push_back(parse_number(text.substr(begin, comma - begin), flag));
    begin = comma + 1;
  }
  if (numbers.size() != count) {
    throw Error(ErrorKind::kUsage,
                "'" + text + "' does not have " + std::to_string(count) + " numbers", flag,
                "write " + form);
  }
  return numbers;
}

}  // namespace nadir::cli
