// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace nadir::cli {

/// Writes report.html, and its charts as SVG files, into the folder of a run, of several seeds or
/// of a demo, from what lies there, and returns the page's path. The page opens from disk and asks
/// for nothing else. Throws Error (input) where the folder holds no run or half of one.
std::filesystem::path write_run_report(const std::filesystem::path& run_folder);

/// The same under another name; a page elsewhere does not lead to those of the runs below.
void write_run_report(const std::filesystem::path& run_folder, const std::filesystem::path& page);

}  // namespace nadir::cli
