// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace nadir::simulation {

/// The number of a frame or photo, as RandomStream takes it.
constexpr std::uint64_t draw_index(int number) { return static_cast<std::uint64_t>(number); }

}  // namespace nadir::simulation
