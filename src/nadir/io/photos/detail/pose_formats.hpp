// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/io/photos/photo_poses.hpp"

namespace nadir {

ImportedPoses read_colmap_model(const std::filesystem::path& folder);
ImportedPoses read_opensfm(const std::filesystem::path& path);
ImportedPoses read_metashape(const std::filesystem::path& path);
ImportedPoses read_nadir_poses(const std::filesystem::path& path);

}  // namespace nadir
