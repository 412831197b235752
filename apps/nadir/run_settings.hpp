// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/streams.hpp"
#include "nadir/pages/html_page.hpp"

namespace nadir::cli {

/// What a manifest says of the options: those that differ from this program's defaults, and all of
/// them folded.
html::Markup settings_of(const Json& manifest);

/// And of where the output comes from: command, versions, machine, inputs with their digests.
html::Markup provenance_of(const Json& manifest);

}  // namespace nadir::cli
