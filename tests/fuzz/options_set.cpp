// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include "fuzz/fuzz_target.hpp"
#include "nadir/pipelines/effective_options.hpp"

// Each line is a value of --set.
NADIR_FUZZ_TARGET(options_set) {
  nadir::OptionSources sources;
  std::istringstream lines{std::string(input)};
  for (std::string line; std::getline(lines, line);) sources.sets.push_back(line);
  const nadir::EffectiveOptions options(sources);
  for (const nadir::Option& option : options.table().options()) {
    nadir::fuzz::require(!option.get().empty(), "an option without a value");
  }
}
