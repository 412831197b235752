// SPDX-License-Identifier: Apache-2.0
#include "cli/completion_scripts.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

namespace nadir::cli {
namespace {

void collect(const CLI::App& app, const std::vector<std::string>& path,
             std::vector<VerbNode>& tree) {
  VerbNode node{path, {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      node.long_options.emplace_back(name, option->get_description());
    }
    std::ranges::copy(option->get_snames(), std::back_inserter(node.short_options));
  }
  const auto verbs = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* verb : verbs) {
    node.verbs.emplace_back(verb->get_name(), verb->get_description());
  }
  tree.push_back(std::move(node));
  for (const CLI::App* verb : verbs) {
    std::vector<std::string> longer = path;
    longer.push_back(verb->get_name());
    collect(*verb, longer, tree);
  }
}

std::string place_of(const VerbNode& node) { return fmt::format("{}", fmt::join(node.path, " ")); }

/// "|convert|config|config dump|": how a shell recognises a verb.
std::string known_places(const std::vector<VerbNode>& tree) {
  std::string text = "|";
  for (const VerbNode& node : tree) text += place_of(node) + "|";
  return text;
}

/// One branch a verb of a `case` that bash and zsh both take: what may follow it.
std::string case_branches(const std::vector<VerbNode>& tree) {
  std::string text;
  for (const VerbNode& node : tree) {
    std::vector<std::string> choices;
    for (const auto& [verb, unused] : node.verbs) choices.push_back(verb);
    for (const auto& [option, unused] : node.long_options) choices.push_back("--" + option);
    for (const std::string& option : node.short_options) choices.push_back("-" + option);
    text += fmt::format("    '{}') choices='{}' ;;\n", place_of(node), fmt::join(choices, " "));
  }
  return text;
}

std::string quoted_for_fish(const std::string& text) {
  std::string quoted = "'";
  for (const char letter : text) {
    if (letter == '\'' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + "'";
}

/// Every verb of the path has been typed, and none of those that may follow it.
std::string fish_condition(const VerbNode& node) {
  if (node.path.empty()) return "__fish_use_subcommand";
  std::string condition;
  for (const std::string& verb : node.path) {
    condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + verb);
  }
  for (const auto& [verb, unused] : node.verbs) {
    condition += "; and not __fish_seen_subcommand_from " + verb;
  }
  return condition;
}

}  // namespace

std::vector<VerbNode> verb_tree(const CLI::App& program) {
  std::vector<VerbNode> tree;
  collect(program, {}, tree);
  return tree;
}

std::string bash_completion(const std::vector<VerbNode>& tree) {
  return "# nadir, completion for bash: source <(nadir completion bash)\n"
         "_nadir() {\n"
         "  local known='" +
         known_places(tree) +
         "' place='' choices='' next i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    next=\"${place:+$place }${COMP_WORDS[i]}\"\n"
         "    [[ $known == *\"|$next|\"* ]] || break\n"
         "    place=$next\n"
         "  done\n"
         "  case \"$place\" in\n" +
         case_branches(tree) +
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$choices\" -- \"${COMP_WORDS[COMP_CWORD]}\"))\n"
         "}\n"
         "complete -o default -F _nadir nadir\n";
}

std::string zsh_completion(const std::vector<VerbNode>& tree) {
  return "#compdef nadir\n"
         "# nadir, completion for zsh: nadir completion zsh > \"${fpath[1]}/_nadir\"\n"
         "_nadir() {\n"
         "  local known='" +
         known_places(tree) +
         "' place='' choices='' next word\n"
         "  for word in \"${(@)words[2,CURRENT-1]}\"; do\n"
         "    next=\"${place:+$place }$word\"\n"
         "    [[ $known == *\"|$next|\"* ]] || break\n"
         "    place=$next\n"
         "  done\n"
         "  case \"$place\" in\n" +
         case_branches(tree) +
         "  esac\n"
         "  compadd -- ${=choices}\n"
         "  [[ $PREFIX == -* ]] || _files\n"
         "}\n"
         "if [[ $funcstack[1] == _nadir ]]; then _nadir; else compdef _nadir nadir; fi\n";
}

std::string fish_completion(const std::vector<VerbNode>& tree) {
  std::string text = "# nadir, completion for fish: nadir completion fish | source\n";
  for (const VerbNode& node : tree) {
    const std::string start = "complete -c nadir -n " + quoted_for_fish(fish_condition(node));
    for (const auto& [verb, description] : node.verbs) {
      text += fmt::format("{} -f -a {} -d {}\n", start, verb, quoted_for_fish(description));
    }
    for (const auto& [option, description] : node.long_options) {
      text += fmt::format("{} -l {} -d {}\n", start, option, quoted_for_fish(description));
    }
    for (const std::string& option : node.short_options) {
      text += fmt::format("{} -s {}\n", start, option);
    }
  }
  return text;
}

}  // namespace nadir::cli
