// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nadir {

/// A word as it is typed into a shell (bash, zsh, ksh, POSIX 2024): as it is where that is safe, in
/// single quotes where it is not, and in $'...' with octal codes where it holds control characters
/// or bytes that are not UTF-8, so that it can be read and copied from a terminal.
std::string shell_quoted(const std::string& word);

/// The same of a path that a program takes as an argument: one that begins with a dash gets ./
/// before it, or it would be an option.
std::string shell_quoted_path(const std::filesystem::path& path);

/// A command line: the words, quoted, with blanks between.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace nadir
