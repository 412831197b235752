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

/// The largest number that a file may give: no quantity is near it, and products of several such
/// numbers are finite.
inline constexpr double kLargestNumber = 1e50;
/// Of the numbers that describe an image, the largest; no format has longer sides.
inline constexpr int kLargestSide = 1'000'000;

/// A number out of a file, finite and within kLargestNumber. Throws Error (input) that names the
/// place and what it should be.
double number_in_file(std::string_view text, const std::string& what, const std::string& where);
/// The same for a number that a library has parsed.
double checked_number(double value, const std::string& what, const std::string& where);

/// A whole number out of a file, from `lowest` to `highest`. Throws Error (input).
int checked_integer(double value, const std::string& what, const std::string& where, int lowest,
                    int highest);
/// The width or height of an image, 0 .. kLargestSide; 0 where the file leaves it open. Throws
/// Error (input).
inline int checked_side(double pixels, const std::string& what, const std::string& where) {
  return checked_integer(pixels, what, where, 0, kLargestSide);
}

}  // namespace nadir
