// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/streams.hpp"
#include "cli/verdict.hpp"
#include "verbs/demo_plan.hpp"

namespace nadir::cli {

/// What the demo's commands gave.
struct DemoResult {
  std::vector<std::pair<std::string, double>> stages;  ///< seconds, in the order of the pipeline
  std::vector<Json> judged;                            ///< of `nadir eval`, one a method
  std::string report;                                  ///< the file to look at first
  Verdict verdict;  ///< of the maps and nadir's own method; the others are there to be compared

  void add(const DemoStep& step, const Json& document, double seconds);
};

/// What came of one command, in a few words.
std::string in_words(const DemoStep& step, const Json& document);

/// The methods in one table, and where the pictures are.
std::string to_text(const DemoResult& result, const DemoPlan& plan, const std::string& out);
Json to_json(const DemoResult& result, const DemoPlan& plan, const std::string& out);

}  // namespace nadir::cli
