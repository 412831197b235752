// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>

#include "nadir/io/detail/yaml_file.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/drives/sequence_format.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/trajectories/tum.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

const std::array<std::string, 8> kSequenceKeys{"version",    "name",     "map",   "surface",
                                               "local_maps", "odometry", "truth", "calibration"};
const std::array<std::string, 4> kLocalMapKeys{"number", "stamp", "image", "elevation"};

/// sequence.yaml while it is read: the folder that it speaks of, and its own path for the errors.
struct Index {
  path folder;
  path file;

  Error error(const YAML::Node& node, const std::string& problem, const std::string& remedy) const {
    return {ErrorKind::kInput, problem, place_of(node, file), remedy};
  }
};

int integer_at(const YAML::Node& map, const std::string& key, const Index& index) {
  const std::string text = text_at(map, key, index.file);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw index.error(map, fmt::format("'{}' is '{}', which is not a whole number", key, text),
                      "see docs/formats.md");
  }
  return value;
}

/// The file that `key` names, inside the folder and there; nothing where the key is absent.
std::optional<path> file_at(const YAML::Node& map, const std::string& key, const Index& index) {
  const path name = text_at(map, key, index.file);
  if (name.empty()) return std::nullopt;
  const path normal = name.lexically_normal();
  if (name.is_absolute() || *normal.begin() == "..") {
    throw index.error(map[key], fmt::format("'{}' leads out of the folder", name.string()),
                      "give a path relative to sequence.yaml, inside its folder");
  }
  path file = index.folder / normal;
  if (!is_file(file)) {
    throw index.error(map[key], fmt::format("'{}' names no file", name.string()),
                      "restore the file or correct its name");
  }
  return file;
}

Sequence::LocalMap read_local_map(const YAML::Node& node, const Index& index) {
  check_keys(node, kLocalMapKeys, index.file);
  const std::string stamp_text = text_at(node, "stamp", index.file);
  const auto stamp = parse_stamp(stamp_text);
  if (!stamp) {
    throw index.error(node,
                      fmt::format("'stamp' is '{}', which is not a number of seconds", stamp_text),
                      "give decimal seconds");
  }
  const auto image = file_at(node, "image", index);
  if (!image) throw index.error(node, "the local map has no 'image'", "name its file");
  return {integer_at(node, "number", index), *stamp, *image, file_at(node, "elevation", index)};
}

std::vector<Sequence::LocalMap> read_local_maps(const YAML::Node& list, const Index& index) {
  if (!list || !list.IsSequence() || list.size() == 0) {
    throw input_error(index.file, "lists no local map", "add them under `local_maps:`");
  }
  std::vector<Sequence::LocalMap> local_maps;
  for (const YAML::Node& node : list) {
    const Sequence::LocalMap next = read_local_map(node, index);
    if (!local_maps.empty()) {
      const Sequence::LocalMap& last = local_maps.back();
      if (next.number <= last.number) {
        throw index.error(node, fmt::format("number {} after {}", next.number, last.number),
                          "the numbers must increase, each used once");
      }
      if (next.stamp <= last.stamp) {
        throw index.error(
            node, fmt::format("stamp {} after {}", to_string(next.stamp), to_string(last.stamp)),
            "the stamps must increase");
      }
    }
    local_maps.push_back(next);
  }
  return local_maps;
}

OdomPose2 interpolated(const StampedPose<frames::Odom>& before,
                       const StampedPose<frames::Odom>& after, Stamp stamp) {
  const auto since = static_cast<double>(stamp.nanoseconds - before.stamp.nanoseconds);
  const auto whole = static_cast<double>(after.stamp.nanoseconds - before.stamp.nanoseconds);
  const double share = since / whole;
  const OdomPose2& from = before.pose;
  return {from.x + share * (after.pose.x - from.x), from.y + share * (after.pose.y - from.y),
          wrap_angle(from.yaw + share * wrap_angle(after.pose.yaw - from.yaw))};
}

std::optional<OdomPose2> odometry_at(const Odometry& odometry, Stamp stamp) {
  constexpr std::int64_t kLargestGap = 500'000'000;        // nanoseconds
  constexpr std::int64_t kLargestDifference = 10'000'000;  // nanoseconds
  const auto after = std::lower_bound(odometry.begin(), odometry.end(), stamp,
                                      [](const auto& pose, Stamp at) { return pose.stamp < at; });
  if (after != odometry.end() && after->stamp == stamp) return after->pose;
  if (after != odometry.begin() && after != odometry.end() &&
      after->stamp.nanoseconds - std::prev(after)->stamp.nanoseconds <= kLargestGap) {
    return interpolated(*std::prev(after), *after, stamp);
  }
  std::optional<OdomPose2> nearest;
  std::int64_t smallest = kLargestDifference + 1;
  for (auto it = after == odometry.begin() ? after : std::prev(after);
       it != odometry.end() && it <= after; ++it) {
    const std::int64_t difference = std::abs(it->stamp.nanoseconds - stamp.nanoseconds);
    if (difference < smallest) {
      smallest = difference;
      nearest = it->pose;
    }
  }
  return nearest;
}

Sequence sequence_of(const YAML::Node& root, const Index& index) {
  check_keys(root, kSequenceKeys, index.file);
  if (const int version = integer_at(root, "version", index);
      version != sequence_format::kVersion) {
    throw index.error(root["version"], fmt::format("format version {} is not known", version),
                      fmt::format("this program reads version {}", sequence_format::kVersion));
  }
  Sequence sequence;
  sequence.folder = index.folder;
  sequence.name = text_at(root, "name", index.file);
  if (sequence.name.empty()) throw index.error(root, "the site has no 'name'", "add one");
  sequence.map = file_at(root, "map", index);
  sequence.surface = file_at(root, "surface", index);
  sequence.calibration = file_at(root, "calibration", index);
  sequence.local_maps = read_local_maps(root["local_maps"], index);
  if (const auto file = file_at(root, "odometry", index)) {
    sequence.odometry = read_tum_odometry(*file);
  }
  if (const auto file = file_at(root, "truth", index)) sequence.truth = read_tum(*file);
  return sequence;
}

}  // namespace

Sequence read_sequence(const path& folder) {
  const Index index{folder, folder / sequence_format::kIndexFile};
  if (!is_folder(folder)) {
    throw input_error(folder, "no such folder", "give a sequence folder (docs/formats.md)");
  }
  if (!is_file(index.file)) {
    const path truth = folder / "truth";
    if (is_file(truth / sequence_format::kIndexFile)) {
      throw input_error(folder, "holds no sequence.yaml, its folder truth does",
                        "a simulated site keeps its sequence there: give " + truth.string());
    }
    throw input_error(folder, "holds no sequence.yaml",
                      "it is no sequence folder, or its conversion did not finish; convert again");
  }
  return reading_yaml(index.file, ErrorKind::kInput,
                      [&](const YAML::Node& root) { return sequence_of(root, index); });
}

Frame read_frame(const Sequence& sequence, const Sequence::LocalMap& local_map) {
  Frame frame{local_map.stamp, read_orthomosaic(local_map.image)};
  if (local_map.elevation) frame.elevation = read_elevation_map(*local_map.elevation);
  if (sequence.odometry) {
    frame.odom_from_robot = odometry_at(*sequence.odometry, local_map.stamp);
  }
  return frame;
}

}  // namespace nadir
