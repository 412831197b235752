// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "nadir/core/stop.hpp"
#include "nadir/io/photos/photo_poses.hpp"

namespace nadir {

/// Runs COLMAP, an optional program of its own, on photos (paths below `photos`) and reads the
/// largest model that it finds. All that it writes, its log too, stays in `work`, which must be
/// there. `step` is told each of its programs before it starts. Throws Error (usage) where there is
/// no `colmap` in the PATH, (processing) with the log where one of its programs fails, (no result)
/// where it finds no model, and Stopped once its program has ended.
ImportedPoses run_colmap(const std::filesystem::path& photos, const std::vector<std::string>& names,
                         const std::filesystem::path& work,
                         const std::function<void(const std::string&)>& step = {},
                         const StopToken& stop = {});

}  // namespace nadir
