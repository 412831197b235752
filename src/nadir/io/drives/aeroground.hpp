// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace nadir {

/// How to read the Aero-Ground run.
struct AerogroundOptions {
  std::optional<std::filesystem::path> truth;   ///< default: DIR/truth.txt where it is
  std::string map_file = "global_no_cars.jpg";  ///< in DIR
};

/// Converts the authors' published part of the Aero-Ground Dataset into a sequence folder.
///
/// `directory` holds the drone's image (`map_file`), local/N.jpg for every N of a range, and maybe
/// truth.txt with lines `frame x y rotation scale`: the map pixel under the centre of the local
/// map, and how far that is turned clockwise, degrees. Map frame: origin at the outer lower-left
/// corner of the image, x right, y up, metres. The robot is at the centre of its local map, its
/// axes are those of that image. Stamps: the frame number in seconds. docs/formats.md says more.
///
/// `progress(done, total)` is called after every local map. Throws Error (input), with file:line,
/// for missing or damaged files, frames missing in the range, and bad truth; (processing) where the
/// site cannot be written.
void convert_aeroground(const std::filesystem::path& directory, const std::filesystem::path& site,
                        const AerogroundOptions& options,
                        const std::function<void(int, int)>& progress);

}  // namespace nadir
