// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;  // CLI11 is large: only the verbs include it
}

namespace nadir::cli {

/// What the verbs have in common; a verb offers those of its kind.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  bool overwrite = false;
  bool dry_run = false;
  std::uint64_t seed = 7;
  int threads = 0;  ///< 0 = as many as this process may use
  std::string device = "auto";
  std::string progress = "auto";
};

/// One start of the program: its arguments, and what the chosen verb will do.
struct Invocation {
  std::vector<std::string> arguments;  ///< as typed, without the program's name
  std::string verb;
  CommonOptions common;
  std::function<int()> action;  ///< returns the exit code
};

/// -q and --json: every verb.
void add_output_style(CLI::App& verb, CommonOptions& common);
/// --overwrite, --dry-run: verbs that write.
void add_writing_options(CLI::App& verb, CommonOptions& common);
/// --seed, --threads, --device, --progress: verbs that compute.
void add_computing_options(CLI::App& verb, CommonOptions& common);

}  // namespace nadir::cli
