// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/streams.hpp"
#include "cli/version_text.hpp"
#include "nadir/core/error.hpp"
#include "nadir/pipelines/checks.hpp"
#include "nadir/pipelines/libraries.hpp"
#include "nadir/report/text_table.hpp"
#include "nadir/version.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

struct DoctorOptions {};

std::vector<Check> all_checks() {
  std::vector<Check> checks = check_backends();
  for (const auto& part : {check_files(), check_host()}) {
    checks.insert(checks.end(), part.begin(), part.end());
  }
  try {
    checks.push_back(check_core_path());
  } catch (const Error& error) {
    checks.push_back({"core path", false, true, error.what()});
  }
  return checks;
}

bool healthy(const std::vector<Check>& checks) {
  return std::ranges::all_of(checks, [](const Check& c) { return c.works || !c.needed; });
}

Json to_json(const std::vector<Check>& checks) {
  Json document{{"healthy", healthy(checks)}, {"nadir", NADIR_VERSION}};
  for (const Library& library : libraries()) document["versions"][library.name] = library.version;
  document["checks"] = Json::array();
  for (const Check& check : checks) {
    document["checks"].push_back({{"name", check.name},
                                  {"works", check.works},
                                  {"needed", check.needed},
                                  {"detail", check.detail}});
  }
  return document;
}

std::string to_text(const std::vector<Check>& checks) {
  std::string text = version_text() + "\n";
  for (const Check& check : checks) {
    const std::string mark = check.works ? "ok    " : check.needed ? "FAILED" : "no    ";
    text += "  " + mark + "  " + check.name + ": " + check.detail + "\n";
  }
  return text + (healthy(checks) ? "\nnadir works here\n" : "\nnadir does not work here\n");
}

int run(const DoctorOptions&, const Invocation& invocation) {
  const std::vector<Check> checks = all_checks();
  invocation.common.json ? print(to_json(checks)) : print(to_text(checks));
  return healthy(checks) ? 0 : static_cast<int>(ErrorKind::kProcessing);
}

}  // namespace

void add_doctor(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<DoctorOptions>(
      program, invocation, "doctor", "Check that everything that nadir needs is there", run);
  verb->footer("Example:\n  nadir doctor --json\n");
}

}  // namespace nadir::cli
