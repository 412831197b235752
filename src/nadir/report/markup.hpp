// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace nadir::report {

/// A text as HTML or XML takes it, in an element or a quoted attribute: <, >, &, " and ' become
/// entities; control characters, which XML forbids, become spaces.
std::string escaped(std::string_view text);

}  // namespace nadir::report
