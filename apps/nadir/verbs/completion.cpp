// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/completion_scripts.hpp"
#include "cli/streams.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

struct CompletionOptions {
  std::string shell;
  const CLI::App* program = nullptr;
};

int run(const CompletionOptions& options, const Invocation& invocation) {
  const std::vector<VerbNode> tree = verb_tree(*options.program);
  const std::string script = options.shell == "bash"  ? bash_completion(tree)
                             : options.shell == "zsh" ? zsh_completion(tree)
                                                      : fish_completion(tree);
  invocation.common.json ? print(Json{{"shell", options.shell}, {"script", script}})
                         : print(script);
  return 0;
}

}  // namespace

void add_completion(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<CompletionOptions>(program, invocation, "completion",
                                                     "Print a completion script for a shell", run);
  options.program = &program;
  verb->add_option("shell", options.shell, "bash, zsh or fish")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->required();
  verb->footer(
      "Examples:\n"
      "  source <(nadir completion bash)\n"
      "  nadir completion zsh > \"${fpath[1]}/_nadir\"\n"
      "  nadir completion fish | source\n");
}

}  // namespace nadir::cli
