// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace nadir {

/// Bytes that a file name may have, on Linux file systems and most others.
inline constexpr std::size_t kLongestName = 255;

/// The beginning of a file name that leaves room for what a temporary name adds: at most `longest`
/// bytes, cut where no UTF-8 character is torn.
std::string short_name(const std::filesystem::path& name, std::size_t longest = 64);

}  // namespace nadir
