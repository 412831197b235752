// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace nadir {

/// The SHA-256 of a file's bytes as 64 hexadecimal digits. Throws Error (input).
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace nadir
