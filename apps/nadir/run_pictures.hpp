// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "nadir/pages/html_page.hpp"

namespace nadir::cli {

/// The figures that draw_run() left in a folder, as parts of a page; empty where there are none.
html::Markup pictures_in(const std::filesystem::path& folder);

}  // namespace nadir::cli
