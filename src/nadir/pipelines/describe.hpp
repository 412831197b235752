// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "nadir/io/json.hpp"

namespace nadir {

/// What `nadir info` says of each kind of input. Throw Error (input).
Json describe_site(const std::filesystem::path& folder);
Json describe_drive(const std::filesystem::path& place);
Json describe_bag(const std::filesystem::path& file);
Json describe_image(const std::filesystem::path& path);
Json describe_trajectory(const std::filesystem::path& path);

}  // namespace nadir
