// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/context.hpp"
#include "cli/interrupt.hpp"
#include "cli/verb_call.hpp"
#include "nadir/pipelines/manifest_of.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/pipelines/threads.hpp"
#include "nadir/runs/output_folder.hpp"
#include "verbs/demo_plan.hpp"
#include "verbs/demo_report.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct DemoOptions {
  fs::path output = "out/demo";
  bool quick = false;
};

/// The demo talks while it goes on; a JSON document stands alone.
void say(const std::string& text, const CommonOptions& common) {
  if (!common.json) print(text);
}

/// Replaces an old demo by an empty folder: from here on every command writes a folder of its own.
void clear(const fs::path& folder, const Manifest& manifest, const CommonOptions& common) {
  OutputFolder output(folder, common.overwrite, {});
  write_manifest(output.staging(), manifest, OptionTable{});
  output.commit();
}

DemoResult run_steps(const DemoPlan& plan, const CommonOptions& common) {
  DemoResult result;
  for (const DemoStep& step : plan.steps) {
    stop_if_interrupted();
    say(command_line(step.arguments) + "\n", common);
    const Stopwatch stopwatch;
    const Json document = call_verb(step.arguments, common);
    const double seconds = stopwatch.seconds();
    result.add(step, document, seconds);
    say(fmt::format("  {:5.1f} s  {}\n", seconds, in_words(step, document)), common);
  }
  return result;
}

int run(const DemoOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  require_device(common.device);
  const ThreadLimit limit(common.threads);
  require_writable(options.output, common.overwrite, {});
  const std::string out = options.output.string();
  const DemoPlan plan = plan_demo(out, options.quick, common.seed);
  for (const std::string& stage : plan.stand_ins) {
    say(stage + ": this build cannot do it (nadir doctor); its true product stands in\n", common);
  }
  if (common.dry_run) {
    Json commands = Json::array();
    for (const DemoStep& step : plan.steps) {
      commands.push_back(command_line(step.arguments));
      say(commands.back().get<std::string>() + "\n", common);
    }
    if (common.json) print(Json{{"dry_run", true}, {"output", out}, {"commands", commands}});
    return 0;
  }
  note_device(common);
  Manifest manifest = manifest_of(context_of(invocation), limit.threads(), {});
  clear(options.output, manifest, common);
  const DemoResult result = run_steps(plan, common);
  for (const auto& [stage, seconds] : result.stages) manifest.stages.push_back({stage, seconds});
  manifest.doubts = result.verdict.doubts();
  write_manifest(options.output, manifest, OptionTable{});
  return finish(to_json(result, plan, out), to_text(result, plan, out), result.verdict, common);
}

}  // namespace

void add_demo(CLI::App& program, Invocation& invocation) {
  auto [verb, options] =
      add_verb<DemoOptions>(program, invocation, "demo",
                            "Simulate a place, map it, drive through it, compare methods", run);
  verb->add_option("-o,--output", options.output, "Folder to write")
      ->type_name("OUT")
      ->capture_default_str();
  verb->add_flag("--quick", options.quick, "A smaller flight and a shorter drive");
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir demo\n"
      "  nadir demo --quick -o /tmp/demo --seed 3 --overwrite\n"
      "A drone's photos and a robot's stereo pairs are simulated with their truth; then every "
      "stage\n"
      "runs as the printed commands would: map, ground, match, localize with several methods, "
      "eval.\n");
}

}  // namespace nadir::cli
