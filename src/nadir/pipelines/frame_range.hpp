// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "nadir/io/drives/sequence.hpp"

namespace nadir {

/// The frames A:B, both included; an end that is left out is open.
struct FrameRange {
  int first = std::numeric_limits<int>::min();
  int last = std::numeric_limits<int>::max();
};

/// "A:B", "A:", ":B", "N", or "" for all. Throws Error (usage).
FrameRange parse_frame_range(const std::string& text);

/// The local maps whose numbers lie in the range. Throws Error (usage) where there are none.
std::vector<Sequence::LocalMap> select_frames(const Sequence& sequence, const FrameRange& range);

/// The local map of one number. Throws Error (usage) that names the numbers there are.
const Sequence::LocalMap& find_frame(const Sequence& sequence, int number);

}  // namespace nadir
