// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/effective_options.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "nadir/core/error.hpp"
#include "nadir/map_matching/cuda_status.hpp"

namespace nadir {
namespace {

/// "NADIR_MAP_MATCHING_" for every stage: variables that begin otherwise are none of ours.
std::set<std::string> environment_prefixes(const OptionTable& table) {
  std::set<std::string> prefixes;
  for (const Option& option : table.options()) {
    prefixes.insert(environment_name(option.name.substr(0, option.name.find('.') + 1)));
  }
  return prefixes;
}

Error unknown_variable(const std::string& variable, const OptionTable& table) {
  std::vector<std::string> known;
  for (const Option& option : table.options()) known.push_back(environment_name(option.name));
  const std::string nearest = nearest_name(variable, known);
  return {ErrorKind::kUsage, "unknown option '" + variable + "'", "environment",
          nearest.empty() ? "`nadir config dump` lists all options"
                          : "did you mean '" + nearest + "'?"};
}

}  // namespace

std::string environment_name(const std::string& option) {
  std::string name = "NADIR_" + option;
  std::ranges::transform(name, name.begin(), [](unsigned char letter) {
    return letter == '.' ? '_' : static_cast<char>(std::toupper(letter));
  });
  return name;
}

OptionTable option_table(StageOptions& options) {
  OptionTable table;
  declare(table, options.aerial_mapping);
  declare(table, options.ground_mapping);
  declare(table, options.local_map);
  declare(table, options.localizer.matching);
  declare(table, options.localizer.localization);
  declare(table, options.localizer.registration);
  declare(table, options.simulation);
  return table;
}

EffectiveOptions::EffectiveOptions(const OptionSources& sources) : table_(option_table(values_)) {
  apply_preset(sources.preset);
  if (!sources.config.empty()) {
    for (const auto& [name, place] : read_yaml_options(sources.config, table_)) {
      origins_[name] = place;
    }
  }
  apply_environment();
  for (const std::string& assignment : sources.sets) apply_set(assignment);
  for (const auto& flag : sources.flags) {
    if (flag->value) set(flag->option, *flag->value, flag->flag);
  }
}

void EffectiveOptions::use_device(const std::string& device) {
  const std::string option = "map_matching.backend";
  const bool on_gpu = values().matching.backend == Backend::kCuda;
  if (device == "cpu" && on_gpu) set(option, "cpu", "--device");
  if (device == "cuda" && !on_gpu) set(option, "cuda", "--device");
  if (device == "auto" && !origins_.contains(option) && cuda_status().usable) {
    set(option, "cuda", "--device");
  }
}

void EffectiveOptions::set(const std::string& name, const std::string& value,
                           const std::string& origin) {
  table_.set(name, value, origin);
  origins_[name] = origin;
}

void EffectiveOptions::apply_preset(const std::string& preset) {
  if (preset != "paper") return;
  values_.localizer = LocalizerOptions::paper();
  for (const Option& option : table_.options()) {
    if (option.get() != option.default_value) origins_[option.name] = "preset paper";
  }
}

void EffectiveOptions::apply_environment() {
  const std::set<std::string> prefixes = environment_prefixes(table_);
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string assignment = *entry;
    const std::string variable = assignment.substr(0, assignment.find('='));
    if (std::ranges::none_of(
            prefixes, [&](const std::string& prefix) { return variable.starts_with(prefix); })) {
      continue;
    }
    const auto& options = table_.options();
    const auto option = std::ranges::find_if(
        options, [&](const Option& known) { return environment_name(known.name) == variable; });
    if (option == options.end()) throw unknown_variable(variable, table_);
    set(option->name, assignment.substr(variable.size() + 1), variable);
  }
}

void EffectiveOptions::apply_set(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw Error(ErrorKind::kUsage, "'" + assignment + "' has no value", "--set",
                "write STAGE.NAME=VALUE");
  }
  set(assignment.substr(0, equals), assignment.substr(equals + 1), "--set");
}

}  // namespace nadir
