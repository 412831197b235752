// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/options/yaml_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "nadir/io/detail/yaml_file.hpp"

namespace nadir {
namespace {

/// One reading of one file.
class Reader {
 public:
  Reader(const std::filesystem::path& path, OptionTable& table) : path_(path), table_(table) {}

  void read(const YAML::Node& node, const std::string& prefix, int depth = 0) {
    // Aliases can make a node its own child, or one of a million paths.
    if (depth > kDeepest) throw refusal(node, prefix, "is nested too deeply");
    if (node.IsNull() && prefix.empty()) return;  // comments only
    if (!node.IsMap()) throw refusal(node, prefix, "`name: value` lines are expected");
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) throw refusal(entry.first, prefix, "a key must be a name");
      const std::string name = (prefix.empty() ? "" : prefix + ".") + entry.first.Scalar();
      if (entry.second.IsMap()) {
        read(entry.second, name, depth + 1);
      } else {
        set(name, entry.first, entry.second);
      }
    }
  }

  OptionOrigins take_origins() { return std::move(origins_); }

 private:
  Error refusal(const YAML::Node& node, const std::string& name, const std::string& problem) const {
    return {ErrorKind::kUsage, name.empty() ? problem : name + ": " + problem,
            place_of(node, path_), "`nadir config dump` shows the form"};
  }

  void set(const std::string& name, const YAML::Node& key, const YAML::Node& value) {
    const std::string place = place_of(key, path_);
    if (const auto known = origins_.find(name); known != origins_.end()) {
      throw refusal(key, name, "is given twice, at " + known->second + " too");
    }
    if (!value.IsScalar()) {
      if (table_.find(name) == nullptr) table_.set(name, "", place);  // says so, with the nearest
      throw refusal(key, name, value.IsNull() ? "has no value" : "takes one value, not a list");
    }
    table_.set(name, value.Scalar(), place);
    origins_.emplace(name, place);
  }

  static constexpr int kDeepest = 3;  ///< stage: name: value; names may have points

  const std::filesystem::path& path_;
  OptionTable& table_;
  OptionOrigins origins_;
};

/// "map_matching" of "map_matching.score"; "" where there is no stage.
std::string_view stage_of(std::string_view name) {
  const std::size_t point = name.find('.');
  return point == std::string_view::npos ? std::string_view{} : name.substr(0, point);
}

/// In the order of their first option.
std::vector<std::string_view> stages_of(const OptionTable& table) {
  std::vector<std::string_view> stages;
  for (const Option& option : table.options()) {
    const std::string_view stage = stage_of(option.name);
    if (std::find(stages.begin(), stages.end(), stage) == stages.end()) stages.push_back(stage);
  }
  return stages;
}

std::string dump_option(const Option& option, std::string_view stage,
                        const OptionOrigins& origins) {
  const std::string indent = stage.empty() ? "" : "  ";
  const std::string key = option.name.substr(stage.empty() ? 0 : stage.size() + 1);
  const auto origin = origins.find(option.name);
  return fmt::format("{0}# {1}\n{0}# allowed: {2}; default: {3}{4}; value from: {5}\n{0}{6}: {7}\n",
                     indent, option.description, option.allowed, option.default_value,
                     option.source.empty() ? "" : " (" + option.source + ")",
                     origin == origins.end() ? "default" : origin->second, key, option.get());
}

}  // namespace

OptionOrigins read_yaml_options(const std::filesystem::path& path, OptionTable& table) {
  return reading_yaml(path, ErrorKind::kUsage, [&](const YAML::Node& root) {
    Reader reader(path, table);
    reader.read(root, "");
    return reader.take_origins();
  });
}

std::string dump_yaml_options(const OptionTable& table, const OptionOrigins& origins) {
  std::string text;
  for (const std::string_view stage : stages_of(table)) {
    if (!text.empty()) text += "\n";
    if (!stage.empty()) text += fmt::format("{}:\n", stage);
    for (const Option& option : table.options()) {
      if (stage_of(option.name) == stage) text += dump_option(option, stage, origins);
    }
  }
  return text;
}

}  // namespace nadir
