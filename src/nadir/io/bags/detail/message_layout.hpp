// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace nadir::ros1 {

/// Whether the bytes of a message are what its definition says, so that no list in it is longer
/// than they are: ROS makes room for what a list declares before it reads it. `layout`: 1, 4 or 8
/// for so many bytes, v1, v4, v8 for a list of such, ( ... ) for a list of what is inside. A text
/// is v1; a std_msgs/Header 444v1. C++17, as ros1.hpp is.
bool has_layout(std::string_view bytes, std::string_view layout);

}  // namespace nadir::ros1
