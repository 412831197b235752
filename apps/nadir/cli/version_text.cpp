// SPDX-License-Identifier: Apache-2.0
#include "cli/version_text.hpp"

#include <nlohmann/json.hpp>

#include "nadir/pipelines/libraries.hpp"
#include "nadir/report/text_table.hpp"
#include "nadir/version.hpp"

namespace nadir::cli {

std::string version_text() {
  std::vector<std::vector<std::string>> rows{{"library", "version", "licence"}};
  for (const Library& library : libraries()) {
    rows.push_back(
        {library.name, library.version.empty() ? "-" : library.version, library.licence});
  }
  return "nadir " NADIR_VERSION ", Apache-2.0\n\n" + text_table(rows);
}

Json version_document() {
  Json document{{"nadir", NADIR_VERSION}, {"licence", "Apache-2.0"}};
  document["libraries"] = Json::array();
  for (const Library& library : libraries()) {
    document["libraries"].push_back(
        {{"name", library.name}, {"version", library.version}, {"licence", library.licence}});
  }
  return document;
}

}  // namespace nadir::cli
