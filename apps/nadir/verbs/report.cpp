// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/verdict.hpp"
#include "map_files.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/input_file.hpp"
#include "run_report.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  fs::path run;
  fs::path output;
};

bool is_map(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".tif" || extension == ".tiff";
}

/// The page that `nadir map` wrote beside its map. Throws Error (input) where there is none.
fs::path map_page_of(const fs::path& map) {
  fs::path page = MapFiles(map).page;
  if (!is_file(map)) throw Error(ErrorKind::kInput, "there is no such map", map.string());
  if (!is_file(page)) {
    throw Error(ErrorKind::kInput, "has no page beside it", map.string(),
                "`nadir map` writes it: run it again");
  }
  return page;
}

fs::path written_page(const ReportOptions& options) {
  if (is_map(options.run)) {
    fs::path page = map_page_of(options.run);
    if (options.output.empty()) return page;
    write_file(options.output, read_file(page));
    return options.output;
  }
  if (options.output.empty()) return write_run_report(options.run);
  write_run_report(options.run, options.output);
  return options.output;
}

int run(const ReportOptions& options, const Invocation& invocation) {
  if (!options.output.empty() && fs::exists(options.output) && !invocation.common.overwrite) {
    throw Error(ErrorKind::kUsage, "the page is there already", options.output.string(),
                "give --overwrite to replace it, or another -o");
  }
  const fs::path page = written_page(options);
  const Json document{
      {"run", options.run.string()}, {"report", page.string()}, {"bytes", fs::file_size(page)}};
  return finish(document, fmt::format("open {}\n", page.string()), {}, invocation.common);
}

}  // namespace

void add_report(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<ReportOptions>(program, invocation, "report",
                                                 "Write the page that explains a run", run);
  verb->add_option("run", options.run,
                   "Folder of `nadir localize`, `run` or `demo`, or a map of `nadir map`")
      ->type_name("RUN")
      ->required();
  verb->add_option("-o,--output", options.output, "Page to write (default: RUN/report.html)")
      ->type_name("FILE");
  verb->add_flag("--overwrite", invocation.common.overwrite, "Replace the page that -o names");
  verb->footer(
      "Examples:\n"
      "  nadir report out/run\n"
      "  nadir report out/run -o run.html --overwrite\n"
      "  nadir report campus.tif\n"
      "`localize`, `run`, `map` and `demo` write the page themselves; this writes it anew, as "
      "after\n"
      "an update of nadir. The page is one file without scripts, and needs no network.\n");
}

}  // namespace nadir::cli
