// SPDX-License-Identifier: Apache-2.0
#pragma once

// Looks at a ROS 1 bag before rosbag does, which takes its lengths and offsets for granted: it
// makes room for what a header declares and reads where an index points to. C++17, as ros1.hpp is.

#include <filesystem>
#include <string_view>

namespace nadir::ros1 {

/// Walks the records of a bag of version 2.0. Throws Error (input) that names the byte where
///   a record is longer than the file, or its header than 1 MiB or no list of fields;
///   a chunk declares more than 256 MiB, or is of another size than its data where it is not
///   compressed;
///   an index points beyond its chunk, or, where that is not compressed, to no message;
///   the index of the file, or a chunk that it lists, is not where it is said to be.
/// Data is skipped: it takes a short read a message. What compressed chunks hold is not looked at.
void check_bag_structure(const std::filesystem::path& file);

/// Whether the bytes of a message are what its definition says, so that no list in it is longer
/// than they are. `layout`: 1, 4 or 8 for so many bytes, v1, v4, v8 for a list of such, ( ... ) for
/// a list of what is inside. A text is v1; a std_msgs/Header 444v1.
bool has_layout(std::string_view bytes, std::string_view layout);

}  // namespace nadir::ros1
