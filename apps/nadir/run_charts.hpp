// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "run_record.hpp"

namespace nadir::cli {

/// A chart of a run: SVG, the name of its file, and what it shows.
struct Chart {
  std::string name;
  std::string svg;
  std::string caption;
};

/// Error within two sigma, what the filter says of itself, and times, over the run.
std::vector<Chart> charts_of(const RunRecord& run);

}  // namespace nadir::cli
