// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>

#include "cli/invocation.hpp"

namespace nadir::cli {

/// Adds a verb whose options live in an `Options` of its own and whose work is
/// `int run(const Options&, const Invocation&)`. Returns the subcommand and its options to bind.
template <class Options>
std::pair<CLI::App*, Options&> add_verb(CLI::App& parent, Invocation& invocation,
                                        const std::string& name, const std::string& description,
                                        int (*run)(const Options&, const Invocation&)) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = parent.add_subcommand(name, description);
  add_output_style(*verb, invocation.common);
  verb->callback([&invocation, options, run, name] {
    invocation.verb = name;
    invocation.action = [&invocation, options, run] { return run(*options, invocation); };
  });
  return {verb, *options};
}

}  // namespace nadir::cli
