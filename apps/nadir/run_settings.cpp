// SPDX-License-Identifier: Apache-2.0
#include "run_settings.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/verb_call.hpp"
#include "nadir/pipelines/effective_options.hpp"
#include "nadir/report/text_table.hpp"
#include "nadir/version.hpp"
#include "run_record.hpp"

namespace nadir::cli {
namespace {

using html::Markup;

/// "0.5" is 0.50: numbers are compared as numbers.
bool same_value(const std::string& one, const std::string& other) {
  if (one == other) return true;
  try {
    return parse_number(one, "") == parse_number(other, "");
  } catch (const std::exception&) {
    return false;
  }
}

std::string text_at(const Json& object, const char* key) {
  const Json value = object.value(key, Json());
  return value.is_null() ? std::string{} : option_text(value);
}

std::string size_text(double bytes) {
  if (bytes < 1e3) return fmt::format("{:.0f} B", bytes);
  if (bytes < 1e6) return fmt::format("{:.1f} kB", bytes / 1e3);
  return bytes < 1e9 ? fmt::format("{:.1f} MB", bytes / 1e6)
                     : fmt::format("{:.2f} GB", bytes / 1e9);
}

Markup stages(const Json& manifest) {
  std::vector<html::Row> rows;
  for (const Json& stage : manifest.value("stages", Json::array())) {
    rows.push_back({stage.value("name", ""), fixed(stage.value("seconds", 0.0), 1) + " s"});
  }
  return rows.empty() ? Markup{} : html::table({"stage", "time"}, rows, html::Columns::kTexts);
}

Markup inputs(const Json& manifest) {
  std::vector<html::Row> rows;
  double bytes = 0.0;
  for (const Json& input : manifest.value("inputs", Json::array())) {
    bytes += input.value("bytes", 0.0);
    rows.push_back(
        {input.value("path", ""), size_text(input.value("bytes", 0.0)), input.value("sha256", "")});
  }
  if (rows.empty()) return {};
  const std::string summary =
      fmt::format("{} input files, {}, with their SHA-256", rows.size(), size_text(bytes));
  return html::folded(summary,
                      html::table({"file", "size", "SHA-256"}, rows, html::Columns::kTexts));
}

}  // namespace

Markup settings_of(const Json& manifest) {
  const Json options = manifest.value("options", Json::object());
  if (options.empty()) return {};
  StageOptions defaults;
  const OptionTable table = option_table(defaults);
  std::vector<html::Row> changed;
  std::vector<html::Row> all;
  for (const auto& [name, entry] : options.items()) {
    const Option* option = table.find(name);
    const std::string value = text_at(entry, "value");
    const std::string usual = option == nullptr ? "unknown to this version" : option->default_value;
    const std::string meaning = option == nullptr ? std::string{} : option->description;
    all.push_back({name, value, text_at(entry, "from"), meaning});
    if (!same_value(value, usual)) {
      changed.push_back({name, value, usual, text_at(entry, "from"), meaning});
    }
  }
  Markup markup = html::heading("Settings");
  markup += changed.empty() ? html::paragraph("Every option has its default.")
                            : html::table({"option", "value", "default", "set by", "meaning"},
                                          changed, html::Columns::kTexts);
  return markup + html::folded(fmt::format("All {} options", all.size()),
                               html::table({"option", "value", "set by", "meaning"}, all,
                                           html::Columns::kTexts));
}

Markup provenance_of(const Json& manifest) {
  const Json host = manifest.value("host", Json::object());
  Markup markup = html::heading("Where this comes from");
  std::vector<std::string> arguments;
  for (const Json& argument : manifest.value("arguments", Json::array())) {
    arguments.push_back(option_text(argument));
  }
  markup += html::code(command_line(arguments));
  const std::string cores = text_at(host, "logical_processors");
  std::vector<html::Row> rows{
      {"nadir", fmt::format("{} (this page: {})", manifest.value("version", ""), NADIR_VERSION)},
      {"Started", manifest.value("started", "")},
      {"Seed, threads, device",
       fmt::format("{}, {}, {}", manifest.value("seed", 0U), manifest.value("threads", 0),
                   manifest.value("device", ""))},
      {"Machine", fmt::format("{}, {} logical processors, {} memory", text_at(host, "processor"),
                              cores, size_text(host.value("memory_bytes", 0.0)))},
      {"System", text_at(host, "system")}};
  for (const char* role : {"map", "site", "drive", "surface"}) {
    const std::string path = source_in(manifest, role).string();
    if (!path.empty()) rows.push_back({std::string("Made of the ") + role, path});
  }
  return markup + html::table({}, rows, html::Columns::kTexts) + stages(manifest) +
         inputs(manifest);
}

}  // namespace nadir::cli
