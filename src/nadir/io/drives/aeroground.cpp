// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/aeroground.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>

#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/aeroground_map.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

constexpr double kLocalResolution = 0.1;                    ///< metres per pixel
constexpr double kMapResolution = kLocalResolution / 3.54;  ///< the authors' scale of the map
constexpr std::int64_t kNanosecondsPerFrame = 1'000'000'000;

using LocalImages = std::map<int, path>;  ///< by frame number

std::optional<int> frame_number(const path& file) {
  const std::string stem = file.stem().string();
  int number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool plain = error == std::errc{} && std::to_string(number) == stem && number >= 0;
  return plain && file.extension() == ".jpg" ? std::optional(number) : std::nullopt;
}

/// Every N.jpg; none may be missing between the first and the last.
LocalImages find_local_images(const path& folder) {
  if (!is_folder(folder)) {
    throw input_error(folder, "no such folder",
                      "give the folder that holds local/, the map and truth.txt");
  }
  LocalImages images;
  for (const path& file : files_in(folder, Depth::kFolder)) {
    if (const auto number = frame_number(file)) images[*number] = file;
  }
  if (images.empty()) throw input_error(folder, "holds no N.jpg", "copy the local maps again");
  for (auto next = std::next(images.begin()); next != images.end(); ++next) {
    const int expected = std::prev(next)->first + 1;
    if (next->first != expected) {
      throw input_error(folder / fmt::format("{}.jpg", expected),
                        fmt::format("is missing, though {}.jpg is there", next->first),
                        "copy the local maps again");
    }
  }
  return images;
}

struct TruthLine {
  std::string where;
  int frame = 0;
  double column = 0.0;  ///< map pixel under the centre of the local map
  double row = 0.0;
  double rotation_deg = 0.0;  ///< clockwise in the image
};

TruthLine parse_truth(const std::string& where, const std::vector<std::string_view>& words) {
  if (words.size() != 5) {
    throw Error(ErrorKind::kInput, fmt::format("{} values instead of 5", words.size()), where,
                "a line is `frame x y rotation scale`");
  }
  const double frame = number_in_file(words[0], "frame", where);
  if (frame != std::floor(frame) || std::abs(frame) > 1e9) {
    throw Error(ErrorKind::kInput, fmt::format("frame is '{}', no whole number", words[0]), where,
                "correct the line");
  }
  if (number_in_file(words[4], "scale", where) <= 0.0) {
    throw Error(ErrorKind::kInput, "scale is not above 0", where, "correct the line");
  }
  return {where, static_cast<int>(frame), number_in_file(words[1], "x", where),
          number_in_file(words[2], "y", where), number_in_file(words[3], "rotation", where)};
}

/// By frame number. The frames must have local maps.
std::map<int, TruthLine> read_truth(const path& file, const LocalImages& images) {
  std::map<int, TruthLine> lines;
  for_each_line(file, read_file(file), [&](const std::string& where, const auto& words) {
    const TruthLine line = parse_truth(where, words);
    if (!images.contains(line.frame)) {
      throw Error(ErrorKind::kInput, fmt::format("frame {} has no local map", line.frame), where,
                  "remove the line or copy the local maps again");
    }
    const auto [known, added] = lines.emplace(line.frame, line);
    if (!added) {
      throw Error(ErrorKind::kInput, fmt::format("frame {} is given twice", line.frame), where,
                  "it stands at " + known->second.where + " too; remove one");
    }
  });
  return lines;
}

Stamp stamp_of(int frame) { return {frame * kNanosecondsPerFrame}; }

/// Rows count down and turn clockwise, the map counts up and turns the other way. The robot's axes
/// are those of the local map: x right, y up.
Trajectory map_from_robot(const std::map<int, TruthLine>& lines, const GeoReference& map) {
  Trajectory trajectory;
  for (const auto& [frame, line] : lines) {
    trajectory.push_back(
        {stamp_of(frame),
         {map.x_at(line.column), map.y_at(line.row), wrap_angle(-radians(line.rotation_deg))}});
  }
  return trajectory;
}

Orthomosaic read_map(const path& file) {
  Orthomosaic map;
  map.image = without_equal_channels(read_image(file));
  map.valid = seen_by_drone(map.image);
  map.geo = {0.0, map.height() * kMapResolution, kMapResolution, {}};
  return map;
}

/// The robot is taken to be at the centre.
Orthomosaic read_local_map(const path& file) {
  Orthomosaic local;
  local.image = without_equal_channels(read_image(file));
  local.valid = seen_by_robot(local.image);
  local.geo = {-0.5 * local.width() * kLocalResolution,
               0.5 * local.height() * kLocalResolution,
               kLocalResolution,
               {}};
  return local;
}

std::optional<path> truth_file(const path& directory, const AerogroundOptions& options) {
  if (options.truth) return options.truth;
  const path usual = directory / "truth.txt";
  return is_file(usual) ? std::optional(usual) : std::nullopt;
}

}  // namespace

void convert_aeroground(const path& directory, const path& site, const AerogroundOptions& options,
                        const std::function<void(int, int)>& progress) {
  const LocalImages images = find_local_images(directory / "local");
  const Orthomosaic map = read_map(directory / options.map_file);
  const auto truth = truth_file(directory, options);
  const auto truth_lines = truth ? read_truth(*truth, images) : std::map<int, TruthLine>{};

  SequenceWriter writer(site, "aeroground");
  writer.write_map(map);
  int done = 0;
  for (const auto& [frame, file] : images) {
    writer.write_local_map(frame, stamp_of(frame), read_local_map(file));
    if (progress) progress(++done, static_cast<int>(images.size()));
  }
  if (truth) writer.write_truth(map_from_robot(truth_lines, map.geo));
  writer.finish();
}

}  // namespace nadir
