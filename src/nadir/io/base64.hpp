// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace nadir {

/// Of at most 2 GiB.
std::string base64(std::string_view bytes);

}  // namespace nadir
