// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace nadir::fuzz {

/// A bag of one uncompressed chunk without the definitions of its messages and without the padding
/// of its header, which are nine tenths of a small bag and tell a reader of known types nothing.
std::string shrunk_bag(const std::string& bag);

}  // namespace nadir::fuzz
