// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <new>
#include <nlohmann/json.hpp>

#include "cli/exit_code.hpp"
#include "cli/interrupt.hpp"
#include "cli/streams.hpp"
#include "cli/verdict.hpp"
#include "cli/version_text.hpp"
#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"

namespace nadir::cli {
namespace {

constexpr const char* kExample =
    "Example:\n"
    "  nadir demo -o out/demo\n"
    "\n"
    "`nadir VERB --help` explains a verb and shows examples.\n";

/// The innermost verb that was named.
const CLI::App& chosen(const CLI::App& program) {
  const auto parsed = program.get_subcommands();
  return parsed.empty() ? program : chosen(*parsed.back());
}

std::string full_name(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  return parent == nullptr ? app.get_name() : full_name(*parent) + " " + app.get_name();
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

/// Something that was typed and not understood: the nearest name helps.
Error unknown(const std::string& kind, const std::string& typed,
              const std::vector<std::string>& candidates, const std::string& help) {
  const std::string nearest = nearest_name(typed, candidates);
  return {ErrorKind::kUsage,
          "unknown " + kind + " '" + typed + "'",
          {},
          nearest.empty() ? "see `" + help + "`" : "did you mean '" + nearest + "'?"};
}

Error usage_error(const CLI::App& program, const CLI::ParseError& error) {
  // A word after the unknown verb may be a verb: `nadir lokalize site -o run`.
  const std::vector<std::string> own = program.remaining(false);
  if (!own.empty() && !own.front().starts_with('-')) {
    return unknown("verb", own.front(), verb_names(program), full_name(program) + " --help");
  }
  const CLI::App& verb = chosen(program);
  const std::string help = full_name(verb) + " --help";
  const std::vector<std::string> rest = program.remaining(true);
  const auto dashed = std::ranges::find_if(
      rest, [](const std::string& word) { return word.size() > 1 && word.starts_with('-'); });
  if (!rest.empty() && !rest.front().starts_with('-') && !verb_names(verb).empty()) {
    return unknown("verb", rest.front(), verb_names(verb), help);
  }
  if (dashed != rest.end()) {
    return unknown("option", dashed->substr(0, dashed->find('=')), option_names(verb), help);
  }
  return {ErrorKind::kUsage, error.what(), full_name(verb), "see `" + help + "`"};
}

/// Also where the arguments could not be parsed to their end; behind "--" are names.
bool wants_json(const Invocation& invocation) {
  const auto& words = invocation.arguments;
  const auto names = std::ranges::find(words, "--");
  return invocation.common.json || std::count(words.begin(), names, "--json") > 0;
}

/// The end of a verb that gave no result: one line, unless there is nothing to say, and with --json
/// a document. Neither must throw: this is the last that happens.
int give_up(const Invocation& invocation, const std::string& message, int exit_code,
            bool say = true) {
  if (say) print_error(message);
  try {
    if (wants_json(invocation) && !document_printed()) print(error_document(message, exit_code));
  } catch (const std::exception&) {  // standard output is gone, and that may be what happened
  }
  return exit_code;
}

int run_parsed(CLI::App& program, Invocation& invocation, int argc, char** argv) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const CLI::App& verb = chosen(program);
    print(verb.help(verb.get_parent() == nullptr ? "" : full_name(*verb.get_parent())));
    return 0;
  } catch (const CLI::CallForVersion&) {
    wants_json(invocation) ? print(version_document()) : print(version_text());
    return 0;
  } catch (const CLI::ParseError& error) {
    throw usage_error(program, error);
  }
  if (!invocation.action) {
    print(program.help());
    return 0;
  }
  return invocation.action();
}

constexpr int kFailed = static_cast<int>(ExitCode::kFailed);

}  // namespace

int run(CLI::App& program, Invocation& invocation, int argc, char** argv) {
  std::copy(argv + std::min(argc, 1), argv + argc, std::back_inserter(invocation.arguments));
  expect_document(wants_json(invocation));
  program.require_subcommand(0, 1);
  program.set_version_flag("--version", std::string{}, "Print version, libraries and licences");
  program.footer(std::string(kExample) + exit_codes_in_words());
  try {
    return run_parsed(program, invocation, argc, argv);
  } catch (const Error& error) {
    return give_up(invocation, error.what(), static_cast<int>(error.kind()));
  } catch (const Stopped&) {
    return give_up(invocation, kStopped, interrupted_exit_code(), false);
  } catch (const std::bad_alloc&) {
    return give_up(invocation, "out of memory; a smaller map or a coarser resolution needs less",
                   kFailed);
  } catch (const std::filesystem::filesystem_error& error) {
    return give_up(invocation, error.path1().string() + ": " + error.code().message(), kFailed);
  } catch (const std::exception& error) {
    return give_up(invocation, error.what(), kFailed);
  }
}

}  // namespace nadir::cli
