// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace nadir {

struct Library {
  std::string name;
  std::string version;  ///< empty where it cannot be asked
  std::string licence;
};

/// What nadir is built from, with the versions that are linked where they can be asked.
std::vector<Library> libraries();

}  // namespace nadir
