// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace nadir {

/// One thing that `nadir doctor` looks at.
struct Check {
  std::string name;
  bool works = false;
  bool needed = true;  ///< the core path does not work without it
  std::string detail;  ///< what there is, or why not and what to do
};

std::vector<Check> check_backends();
std::vector<Check> check_files();  ///< GDAL's drivers, PROJ's data
std::vector<Check> check_host();   ///< cores, memory, disk, GPU
/// A small drive, localized end to end.
Check check_core_path();

}  // namespace nadir
