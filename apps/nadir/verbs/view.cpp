// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/interrupt.hpp"
#include "cli/server_options.hpp"
#include "verbs/verbs.hpp"
#include "viewer/live_view.hpp"

namespace nadir::cli {
namespace {

struct ViewOptions {
  std::filesystem::path run;
  RunSources sources;
  ServerOptions server;
};

int run(const ViewOptions& options, const Invocation& invocation) {
  const auto view = RunView::open(options.run, options.sources);
  ViewerServer server(*view, nullptr, {}, options.server);
  server.start();
  warn_where_open(options.server, invocation.common.quiet);
  if (invocation.common.json) {
    print(Json{{"url", server.url()}, {"frames", view->size()}});
  } else {
    print(fmt::format("{} frames of {} at {}\nCtrl-C ends\n", view->size(), options.run.string(),
                      server.url()));
  }
  interrupt_is_the_end(true);
  wait_for_interrupt();
  server.stop();
  return 0;  // it has no end of its own
}

}  // namespace

void add_view(CLI::App& program, Invocation& invocation) {
  auto [verb, options] =
      add_verb<ViewOptions>(program, invocation, "view", "Look at a run in a browser", run);
  verb->add_option("run", options.run, "Run folder, of `nadir localize` or `nadir run`")
      ->type_name("RUN")
      ->required();
  verb->add_option("--site", options.sources.site, "Site folder, where it has moved")
      ->type_name("SITE");
  verb->add_option("--map", options.sources.map, "Orthomosaic, where it has moved")
      ->type_name("FILE");
  add_server_options(*verb, options.server);
  verb->footer(
      "Examples:\n"
      "  nadir view out/run\n"
      "  nadir view out/run --port 0 --site /data/site\n"
      "The page needs no network: everything is in this program. It can be reached from this\n"
      "machine alone unless --listen names another address.\n");
}

}  // namespace nadir::cli
