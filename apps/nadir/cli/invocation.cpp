// SPDX-License-Identifier: Apache-2.0
#include "cli/invocation.hpp"

#include <CLI/CLI.hpp>

namespace nadir::cli {

void add_output_style(CLI::App& verb, CommonOptions& common) {
  verb.add_flag("--json", common.json, "Print the result as one JSON document");
  verb.add_flag("-q,--quiet", common.quiet, "No progress and no notes on standard error");
}

void add_writing_options(CLI::App& verb, CommonOptions& common) {
  verb.add_flag("--overwrite", common.overwrite, "Replace an output folder that nadir wrote");
  verb.add_flag("--dry-run", common.dry_run, "Check everything, say what would be done, stop");
}

void add_computing_options(CLI::App& verb, CommonOptions& common) {
  verb.add_option("--seed", common.seed, "Seed of all random numbers; same seed, same output")
      ->capture_default_str();
  verb.add_option("--threads", common.threads,
                  "Threads to use; 0 = as many as affinity and control group allow")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  verb.add_option("--device", common.device, "Where to compute: auto, cpu, cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
  verb.add_option("--progress", common.progress,
                  "Progress on standard error: auto, bar, lines, none")
      ->check(CLI::IsMember({"auto", "bar", "lines", "none"}))
      ->capture_default_str();
}

}  // namespace nadir::cli
