// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/streams.hpp"
#include "cli/version_text.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

struct VersionOptions {};

int run(const VersionOptions&, const Invocation& invocation) {
  invocation.common.json ? print(version_document()) : print(version_text());
  return 0;
}

}  // namespace

void add_version(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<VersionOptions>(
      program, invocation, "version", "Print the version, the libraries and their licences", run);
  verb->footer("Example:\n  nadir version --json\n");
}

}  // namespace nadir::cli
