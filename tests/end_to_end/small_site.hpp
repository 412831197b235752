// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace nadir::testing {

inline constexpr int kSmallSiteFrames = 8;

/// A site of a few small frames with map, odometry and truth; written once a process, never
/// changed.
std::filesystem::path small_site();

/// A copy of it, to be damaged.
std::filesystem::path copy_of_small_site(const std::string& name);

/// The local map images of a site, sorted.
std::filesystem::path local_map_file(const std::filesystem::path& site, int position);

/// The file of the global map.
std::filesystem::path map_file(const std::filesystem::path& site);

}  // namespace nadir::testing
