// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace nadir::cli {

struct Library {
  std::string name;
  std::string version;
  std::string licence;
};

/// What this program is built from, with the versions that are linked where they can be asked.
std::vector<Library> libraries();

/// The version of nadir.
std::string program_version();

/// `nadir version` and `nadir --version`, for reading.
std::string version_text();

}  // namespace nadir::cli
