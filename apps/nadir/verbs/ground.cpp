// SPDX-License-Identifier: Apache-2.0
#include "cli/add_verb.hpp"
#include "cli/option_flags.hpp"
#include "ground_job.hpp"
#include "nadir/pipelines/threads.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

int run(const GroundOptions& options, const Invocation& invocation) {
  require_device(invocation.common.device);
  const ThreadLimit limit(invocation.common.threads);
  GroundJob job(options, invocation, limit.threads());
  if (invocation.common.dry_run) return job.explain();
  return job.run();
}

}  // namespace

void add_ground(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<GroundOptions>(
      program, invocation, "ground", "Map a recorded drive into local orthomosaics", run);
  add_drive_options(*verb, options.drive);
  verb->add_option("-o,--output", options.site, "Site folder to write")
      ->type_name("SITE")
      ->required();
  verb->add_option("--map", options.map, "The drone's orthomosaic, to put into the site")
      ->type_name("FILE");
  verb->add_option("--surface", options.surface, "Its heights, to put into the site")
      ->type_name("FILE");
  verb->add_flag("--self-check", options.self_check,
                 "Map odd and even frames apart too and compare: do the poses fit the images?");
  add_option_sources(*verb, options.sources);
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir ground kitti/sequences/01 -o out/site --poses kitti/poses/01.txt --self-check\n"
      "  nadir ground MH_01_easy -o out/site --every 1m --size 12 --json\n"
      "  nadir ground drive.bag -o out/site --map campus.tif\n"
      "SITE is what `nadir localize` takes: local maps with their heights, odometry, and map and\n"
      "truth where there are any; beside them overview.png and frames.csv. docs/formats.md shows\n"
      "the layouts of INPUT. Poses are needed: nadir computes no visual odometry.\n");
}

}  // namespace nadir::cli
