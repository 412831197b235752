// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "invocation.hpp"
#include "seed_run.hpp"

namespace nadir::cli {

/// A way to localize, as a user would ask for it.
struct Way {
  const char* name;
  const char* folder;
  const char* preset;
  const char* score;
};
inline constexpr std::array<Way, 3> kWays{{{"ncc + PF", "run_ncc", "paper", "ncc"},
                                           {"wncc + PF (the paper's)", "run_wncc", "paper", "wncc"},
                                           {"nadir", "run", "default", "zwncc"}}};

/// The same commands that a user would type, with their own outputs; `out` is the demo's folder.
void explain_demo(const std::string& out, const Invocation& invocation);

/// The table, or the JSON document, of one run a way.
void report_demo(const std::vector<SeedRun>& runs, const std::string& out,
                 const Invocation& invocation);

}  // namespace nadir::cli
