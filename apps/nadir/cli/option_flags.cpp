// SPDX-License-Identifier: Apache-2.0
#include "cli/option_flags.hpp"

#include <CLI/CLI.hpp>
#include <memory>

namespace nadir::cli {

void add_config_and_set(CLI::App& verb, OptionSources& sources) {
  verb.add_option("--config", sources.config, "YAML file of options, as `config dump` prints it");
  verb.add_option("--set", sources.sets, "Set any option: STAGE.NAME=VALUE (may be repeated)")
      ->allow_extra_args(false);
}

void add_option_sources(CLI::App& verb, OptionSources& sources) {
  verb.add_option("--preset", sources.preset,
                  "Options to start from: default, or paper (its protocol)")
      ->check(CLI::IsMember({"default", "paper"}))
      ->capture_default_str();
  add_config_and_set(verb, sources);
}

void add_option_flag(CLI::App& verb, OptionSources& sources, const std::string& flag,
                     const std::string& option) {
  StageOptions values;
  const OptionTable table = option_table(values);
  const Option* declared = table.find(option);
  if (declared == nullptr) throw CLI::BadNameString("no option is named " + option);
  const auto bound = std::make_shared<OptionSources::Flag>(OptionSources::Flag{flag, option, {}});
  sources.flags.push_back(bound);
  verb.add_option_function<std::string>(
      flag, [bound](const std::string& value) { bound->value = value; },
      declared->description + " Allowed: " + declared->allowed + " (" + option + ")");
}

}  // namespace nadir::cli
