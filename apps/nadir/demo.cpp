// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>

#include "add_verb.hpp"
#include "demo_report.hpp"
#include "demo_site.hpp"
#include "effective_options.hpp"
#include "interrupt.hpp"
#include "manifest_of.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/orthomosaic_file.hpp"
#include "output_folder.hpp"
#include "progress.hpp"
#include "run_figures.hpp"
#include "run_files.hpp"
#include "seed_run.hpp"
#include "site.hpp"
#include "stopwatch.hpp"
#include "threads.hpp"
#include "verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct DemoOptions {
  fs::path output = "out/demo";
};

SeedRun run_way(const Way& way, const Orthomosaic& map, const Sequence& sequence,
                const fs::path& folder, const Invocation& invocation) {
  OptionSources sources;
  sources.preset = way.preset;
  sources.sets = {std::string("map_matching.score=") + way.score};
  EffectiveOptions options(sources);
  options.use_device(invocation.common.device);
  const std::uint64_t seed = invocation.common.seed;
  const Prior start = start_of({"truth", "5,5"}, *sequence.truth, seed);
  Progress progress(std::string("localizing, ") + way.name,
                    static_cast<int>(sequence.local_maps.size()), invocation.common);
  std::optional<SeedRun> run =
      run_and_judge({map, std::nullopt, sequence, sequence.local_maps, options.values(), start,
                     seed, sequence.odometry.has_value()},
                    [&](int done) { progress.update(done); });
  stop_if_interrupted();
  write_run(folder, run->result, run->truth);
  draw_run(folder, {map, run->result, run->truth, &run->judgement->evaluation, way.name});
  Manifest manifest = manifest_of(invocation, 1, {});
  manifest.stages.push_back({"localize", run->result.update_s()});
  write_manifest(folder, manifest, options.table(), options.origins());
  return std::move(*run);
}

int run(const DemoOptions& options, const Invocation& invocation) {
  require_device(invocation.common);
  const ThreadLimit limit(invocation.common);
  require_writable(options.output, invocation.common, {});
  explain_demo(options.output.string(), invocation);
  if (invocation.common.dry_run) {
    if (invocation.common.json) print(Json{{"dry_run", true}, {"output", options.output.string()}});
    return 0;
  }
  note_device(invocation.common);
  const Stopwatch stopwatch;
  OutputFolder output(options.output, invocation.common, {});
  write_demo_site(output.staging() / "site", invocation.common.seed);
  const Sequence sequence = read_sequence(output.staging() / "site");
  const Orthomosaic map = read_orthomosaic(map_path(sequence, {}));
  std::vector<SeedRun> runs;
  for (const Way& way : kWays) {
    runs.push_back(run_way(way, map, sequence, output.staging() / way.folder, invocation));
  }
  Manifest manifest = manifest_of(invocation, limit.threads(), {});
  manifest.stages.push_back({"demo", stopwatch.seconds()});
  write_manifest(output.staging(), manifest, OptionTable{});
  output.commit();
  report_demo(runs, options.output.string(), invocation);
  return 0;
}

}  // namespace

void add_demo(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<DemoOptions>(
      program, invocation, "demo", "Simulate a drive, localize it three ways, compare", run);
  verb->add_option("-o,--output", options.output, "Folder to write")
      ->type_name("OUT")
      ->capture_default_str();
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir demo\n"
      "  nadir demo -o /tmp/demo --seed 3 --overwrite\n");
}

}  // namespace nadir::cli
