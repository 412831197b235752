// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "invocation.hpp"

namespace nadir::cli {

/// `convert map`, under the verb convert.
void add_convert_map(CLI::App& convert, Invocation& invocation);

}  // namespace nadir::cli
