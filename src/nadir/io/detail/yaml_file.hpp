// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the readers of YAML share; yaml-cpp appears in no public header.

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "nadir/core/error.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {

/// Parses the text of a file. Throws Error of `kind` with file:line.
YAML::Node parse_yaml(const std::string& text, const std::filesystem::path& path, ErrorKind kind);

/// What `read` makes of a parsed file. Where a node is of another kind than is asked for, yaml-cpp
/// throws; that becomes an Error of `kind` with file:line.
template <class Read>
auto reading_yaml(const std::string& text, const std::filesystem::path& path, ErrorKind kind,
                  const Read& read) {
  const YAML::Node root = parse_yaml(text, path, kind);
  try {
    return read(root);
  } catch (const YAML::Exception& error) {
    throw Error(kind, "has another form than is expected: " + error.msg,
                file_and_line(path, error.mark.line + 1), "see docs/formats.md");
  }
}

template <class Read>
auto reading_yaml(const std::filesystem::path& path, ErrorKind kind, const Read& read) {
  return reading_yaml(read_file(path), path, kind, read);
}

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
