// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/yaml_file.hpp"

#include <algorithm>
#include <set>

#include "nadir/core/options.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {

YAML::Node parse_yaml(const std::string& text, const std::filesystem::path& path, ErrorKind kind) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw Error(kind, "is not YAML: " + error.msg, file_and_line(path, error.mark.line + 1),
                "correct the line");
  }
}

std::string place_of(const YAML::Node& node, const std::filesystem::path& path) {
  return file_and_line(path, node.Mark().line + 1);
}

void check_keys(const YAML::Node& node, std::span<const std::string> known,
                const std::filesystem::path& path) {
  if (!node.IsMap()) {
    throw Error(ErrorKind::kInput, "`key: value` lines are expected here", place_of(node, path),
                "see docs/formats.md");
  }
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const std::string nearest = nearest_name(key, known);
      throw Error(
          ErrorKind::kInput, "unknown key '" + key + "'", place_of(entry.first, path),
          nearest.empty() ? "docs/formats.md lists the keys" : "did you mean '" + nearest + "'?");
    }
    if (!seen.insert(key).second) {
      throw Error(ErrorKind::kInput, "the key '" + key + "' is given twice",
                  place_of(entry.first, path), "remove one");
    }
  }
}

std::string text_at(const YAML::Node& map, const std::string& key,
                    const std::filesystem::path& path) {
  for (const auto& entry : map) {
    if (entry.first.Scalar() != key) continue;
    if (!entry.second.IsScalar() || entry.second.Scalar().empty()) {
      throw Error(ErrorKind::kInput, "'" + key + "' must be one text or number",
                  // the mark of a missing value is that of the line after it
                  place_of(entry.first, path), "see docs/formats.md");
    }
    return entry.second.Scalar();
  }
  return {};
}

std::vector<double> numbers_in(const YAML::Node& list, const std::string& what,
                               const std::filesystem::path& path) {
  std::vector<double> numbers;
  for (const YAML::Node& entry : list) {
    numbers.push_back(number_in_file(entry.Scalar(), what, place_of(list, path)));
  }
  return numbers;
}

}  // namespace nadir
