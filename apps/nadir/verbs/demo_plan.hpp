// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace nadir::cli {

/// A way to localize, as a user would ask for it.
struct DemoMethod {
  const char* name;
  const char* folder;
  std::vector<std::string> options;  ///< of `nadir localize`
};
/// The last is nadir's own.
const std::vector<DemoMethod>& demo_methods();

/// One command of the demo, and the stage that it belongs to.
struct DemoStep {
  std::string stage;  ///< simulate, map, ground, match, localize, eval, report
  std::vector<std::string> arguments;
  bool is_nadirs_own = true;  ///< false of the methods that it is compared with
};

/// The commands in their order; localize and eval come once a method, in the order of
/// demo_methods().
struct DemoPlan {
  std::vector<DemoStep> steps;
  std::vector<std::string> stand_ins;  ///< stages whose true product is taken instead
  std::string map;                     ///< the orthomosaic that the robot is localized in
};

/// `out` is the demo's folder; `quick` a smaller site.
DemoPlan plan_demo(const std::string& out, bool quick, std::uint64_t seed);

}  // namespace nadir::cli
