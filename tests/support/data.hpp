// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace nadir::test {

/// Said by GTEST_SKIP where find_data finds nothing.
inline constexpr const char* kNoData =
    "the real data set is not here: set NADIR_DATA, or put it at ../shared/data";

/// A folder or file of the real data sets, which are no part of this project: looked for where
/// NADIR_DATA points, then at ../shared/data from the project's root, where ctest runs the tests.
inline std::optional<std::filesystem::path> find_data(const std::string& name) {
  const char* chosen = std::getenv("NADIR_DATA");
  const std::filesystem::path root = chosen != nullptr
                                         ? std::filesystem::path(chosen)
                                         : std::filesystem::absolute("../shared/data");
  if (name.empty() || !std::filesystem::exists(root / name)) return std::nullopt;
  return root / name;
}

}  // namespace nadir::test
