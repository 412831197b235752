// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/invocation.hpp"

namespace nadir::cli {

/// A verb by its whole path ("config dump", "" for the program), with what may follow it.
struct VerbNode {
  using Word = std::pair<std::string, std::string>;  ///< the word and its description

  std::vector<std::string> path;
  std::vector<Word> verbs;
  std::vector<Word> long_options;  ///< without the dashes
  std::vector<std::string> short_options;
};

/// The program and all its verbs, outer ones first.
std::vector<VerbNode> verb_tree(const CLI::App& program);

std::string bash_completion(const std::vector<VerbNode>& tree);
std::string zsh_completion(const std::vector<VerbNode>& tree);
std::string fish_completion(const std::vector<VerbNode>& tree);

}  // namespace nadir::cli
