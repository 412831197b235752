// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace nadir::ros1 {

/// A chunk of a bag, unpacked; nothing where it is not exactly `size` bytes. `compression` is "bz2"
/// or "lz4", whose frames are those of LZ4. C++17, as ros1.hpp is.
std::optional<std::string> unpacked(std::string_view compression, std::string_view packed,
                                    std::size_t size);

}  // namespace nadir::ros1
