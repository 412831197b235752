// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/context.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "cli/streams.hpp"
#include "cli/verdict.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/drives/aeroground.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/pipelines/manifest_of.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/runs/output_folder.hpp"
#include "verbs/convert_map.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  fs::path directory;
  fs::path site;
  fs::path truth;
};

std::vector<fs::path> inputs_of(const ConvertOptions& options) {
  std::vector<fs::path> inputs{options.directory};
  if (!options.truth.empty()) inputs.push_back(options.truth);
  return inputs;
}

void convert_into(const fs::path& folder, const ConvertOptions& options,
                  const Invocation& invocation) {
  AerogroundOptions aeroground;
  if (!options.truth.empty()) aeroground.truth = options.truth;
  const Stopwatch stopwatch;
  std::optional<Progress> progress;
  convert_aeroground(options.directory, folder, aeroground, [&](int done, int total) {
    stop_if_interrupted();
    if (!progress) progress.emplace("converting local maps", total, invocation.common);
    progress->update(done);
  });
  Manifest manifest = manifest_of(context_of(invocation), 1, inputs_of(options));
  manifest.stages.push_back({"convert", stopwatch.seconds()});
  write_manifest(folder, manifest, OptionTable{});
}

Json describe(const Sequence& sequence, const fs::path& site) {
  return {{"site", site.string()},
          {"name", sequence.name},
          {"local_maps", sequence.local_maps.size()},
          {"first_frame", sequence.local_maps.front().number},
          {"last_frame", sequence.local_maps.back().number},
          {"truth_poses", sequence.truth ? sequence.truth->size() : 0},
          {"odometry_poses", sequence.odometry ? sequence.odometry->size() : 0}};
}

int run(const ConvertOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  if (!is_folder(options.directory)) {
    throw Error(ErrorKind::kInput, "there is no such folder", options.directory.string());
  }
  if (common.dry_run) {
    require_writable(options.site, common.overwrite, inputs_of(options));
    const std::string plan = "would convert " + options.directory.string();
    common.json ? print(Json{{"dry_run", true}, {"site", options.site.string()}})
                : print(plan + " to " + options.site.string() + "\n");
    return 0;
  }
  OutputFolder output(options.site, common.overwrite, inputs_of(options));
  convert_into(output.staging(), options, invocation);
  output.commit();
  const Json document = describe(read_sequence(options.site), options.site);
  const std::string text = options.site.string() + ": " + json_text(document["local_maps"]) +
                           " local maps, " + json_text(document["truth_poses"]) + " true poses\n";
  return finish(document, text, {}, common);
}

}  // namespace

void add_convert(CLI::App& program, Invocation& invocation) {
  auto& parent = *program.add_subcommand(
      "convert", "Turn a data set into a site folder, or a map into one for nadir");
  parent.require_subcommand(1);
  parent.footer("Example:\n  nadir convert aeroground data/aeroground -o out/aeroground\n");
  auto [verb, options] = add_verb<ConvertOptions>(
      parent, invocation, "aeroground", "The published part of the Aero-Ground Dataset", run);
  verb->add_option("directory", options.directory, "Folder of the data set")
      ->type_name("DIR")
      ->required();
  verb->add_option("-o,--output", options.site, "Site folder to write")
      ->type_name("SITE")
      ->required();
  verb->add_option("--truth", options.truth, "Truth file (default: DIR/truth.txt where it is)")
      ->type_name("FILE");
  add_writing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir convert aeroground data/aeroground -o out/aeroground\n"
      "  nadir convert aeroground data/aeroground --truth survey.txt -o out/site --overwrite\n");
  add_convert_map(parent, invocation);
}

}  // namespace nadir::cli
