// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the readers of YAML share; yaml-cpp appears in no public header.

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "nadir/core/error.hpp"

namespace nadir {

/// Parses a file. Throws Error of `kind` with file:line.
YAML::Node load_yaml(const std::filesystem::path& path, ErrorKind kind);

/// The file:line of a node.
std::string place_of(const YAML::Node& node, const std::filesystem::path& path);

/// Throws Error (input) where `node` is not a map of known keys, each given once; an unknown key
/// is answered with the nearest known one.
void check_keys(const YAML::Node& node, std::span<const std::string> known,
                const std::filesystem::path& path);

/// The text of the value of `key`, "" where the key is absent. Throws Error (input) where the
/// value is a list, a map or nothing.
std::string text_at(const YAML::Node& map, const std::string& key,
                    const std::filesystem::path& path);

/// The numbers of a list; errors call them `what`. Throws Error (input).
std::vector<double> numbers_in(const YAML::Node& list, const std::string& what,
                               const std::filesystem::path& path);

}  // namespace nadir
