// SPDX-License-Identifier: Apache-2.0
#include "demo_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "streams.hpp"
#include "text_table.hpp"

namespace nadir::cli {
namespace {

std::string table(const std::vector<SeedRun>& runs) {
  std::vector<std::vector<std::string>> rows{{"", "RMSE, m", "yaw, deg", "max, m", "maps/s"}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Evaluation& e = runs[i].judgement->evaluation;
    rows.push_back(
        {kWays[i].name, fixed(e.ape_translation_m.rmse, 3), fixed(degrees(e.ape_yaw_rad.rmse), 2),
         fixed(e.ape_translation_m.max, 2),
         fixed(static_cast<double>(runs[i].result.records.size()) / runs[i].result.update_s(), 1)});
  }
  return text_table(rows);
}

}  // namespace

void explain_demo(const std::string& out, const Invocation& invocation) {
  std::string text = "The demo makes a site and does what these commands do:\n";
  for (const Way& way : kWays) {
    text += fmt::format(
        "  nadir localize {0}/site -o {0}/{1} --preset {2} --score {3} --prior truth --seed {4}\n",
        out, way.folder, way.preset, way.score, invocation.common.seed);
  }
  text += fmt::format("  nadir eval {0}/run/trajectory.tum --truth {0}/site/truth.tum\n", out);
  if (!invocation.common.json) print(text + "\n");
}

void report_demo(const std::vector<SeedRun>& runs, const std::string& out,
                 const Invocation& invocation) {
  if (!invocation.common.json) {
    print(table(runs) +
          fmt::format("\nopen {}/run/trajectory.png and {}/run/swarm.png\n", out, out));
    return;
  }
  Json document{{"output", out}, {"seed", invocation.common.seed}};
  document["runs"] = Json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Json run = to_json(runs[i]);
    run["name"] = kWays[i].name;
    run["folder"] = out + "/" + kWays[i].folder;
    document["runs"].push_back(std::move(run));
  }
  print(document);
}

}  // namespace nadir::cli
