// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

namespace nadir {

struct AerogroundOptions {
  std::optional<std::filesystem::path> truth;  ///< default: DIR/truth.txt where it is
  std::string map_file = "global_no_cars.jpg";
};

/// Converts the authors' published part of the Aero-Ground Dataset into a sequence folder.
/// `progress(done, total)` is called after every local map. Throws Error (input).
void convert_aeroground(const std::filesystem::path& directory, const std::filesystem::path& site,
                        const AerogroundOptions& options,
                        const std::function<void(int, int)>& progress);

}  // namespace nadir
