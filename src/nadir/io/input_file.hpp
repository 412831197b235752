// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "nadir/core/error.hpp"

namespace nadir {

/// An Error of bad input that names the file.
inline Error input_error(const std::filesystem::path& path, const std::string& problem,
                         const std::string& remedy = {}) {
  return {ErrorKind::kInput, problem, path.string(), remedy};
}

/// The extension with its point, in small letters; "" where there is none.
std::string lower_extension(const std::filesystem::path& path);

/// "file:line", the place that an error names.
std::string file_and_line(const std::filesystem::path& path, int line);

/// Whether there is such a file or folder; no where that cannot be found out.
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);

/// The files right in a folder, or all below it; sorted. Throws Error (input).
enum class Depth { kFolder, kAllBelow };
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, Depth depth);

/// Throws Error (input) for a file that is missing, a folder, empty, or a Git LFS pointer.
void check_input_file(const std::filesystem::path& path);

/// The bytes of a file. Throws as check_input_file does, and where it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// Calls `visit(where, fields)` with the file:line and the words, separated by spaces or tabs, of
/// each line that has any; what follows a '#' is a comment.
void for_each_line(
    const std::filesystem::path& path, std::string_view text,
    const std::function<void(const std::string&, const std::vector<std::string_view>&)>& visit);

/// A finite number out of a file. Throws Error (input) that names the place and what it should be.
double number_in_file(std::string_view text, const std::string& what, const std::string& where);

}  // namespace nadir
