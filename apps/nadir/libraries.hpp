// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "nadir/io/json.hpp"

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

/// `nadir version` and `nadir --version`, for reading and as a document.
std::string version_text();
Json version_document();

}  // namespace nadir::cli
