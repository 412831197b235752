// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "nadir/io/json.hpp"

namespace nadir::cli {

/// `nadir version` and `nadir --version`, for reading and as a document.
std::string version_text();
Json version_document();

}  // namespace nadir::cli
