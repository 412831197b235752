// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/provenance/manifest.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/json.hpp"
#include "nadir/io/provenance/sha256.hpp"

namespace nadir {
namespace {

/// The files of a folder in a fixed order, so that the same inputs give the same list.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& input) {
  return is_folder(input) ? files_in(input, Depth::kAllBelow) : std::vector{input};
}

Json describe_inputs(const std::vector<std::filesystem::path>& inputs) {
  Json list = Json::array();
  for (const std::filesystem::path& input : inputs) {
    for (const std::filesystem::path& file : files_of(input)) {
      const std::string digest = sha256_of_file(file);
      list.push_back({{"path", file.string()},
                      {"bytes", std::filesystem::file_size(file)},
                      {"sha256", digest}});
    }
  }
  return list;
}

/// The value in the type that JSON has for it.
Json value_of(const Option& option) {
  const std::string text = option.get();
  if (option.type == "switch") return text == "on";
  if (option.type != "integer" && option.type != "number") return text;
  const Json number = Json::parse(text, nullptr, false);
  return number.is_discarded() ? Json(text) : number;  // JSON has no infinity
}

Json describe_options(const OptionTable& table, const OptionOrigins& origins) {
  Json options = Json::object();
  for (const Option& option : table.options()) {
    const auto origin = origins.find(option.name);
    options[option.name] = {{"value", value_of(option)},
                            {"from", origin == origins.end() ? "default" : origin->second}};
  }
  return options;
}

/// Absolute, so that they are found from wherever the output is looked at.
Json describe_sources(const std::vector<std::pair<std::string, std::filesystem::path>>& sources) {
  Json described = Json::object();
  for (const auto& [role, path] : sources) {
    set_name(described, role, std::filesystem::absolute(path).lexically_normal().string());
  }
  return described;
}

Json describe_stages(const std::vector<Manifest::Stage>& stages) {
  Json list = Json::array();
  for (const Manifest::Stage& stage : stages) {
    list.push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  return list;
}

/// The processor's name as Linux gives it; empty elsewhere.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name"))
      return line.substr(std::min(line.find(':') + 2, line.size()));
  }
  return {};
}

Json describe_host() {
  utsname system{};
  ::uname(&system);
  const std::int64_t memory = std::int64_t{::sysconf(_SC_PHYS_PAGES)} * ::sysconf(_SC_PAGESIZE);
  return {{"name", system.nodename},
          {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
          {"processor", processor()},
          {"logical_processors", std::thread::hardware_concurrency()},
          {"memory_bytes", memory}};
}

}  // namespace

void write_manifest(const std::filesystem::path& folder, const Manifest& manifest,
                    const OptionTable& table, const OptionOrigins& origins) {
  const Json document = {
      {"program", "nadir"},
      {"version", manifest.program_version},
      {"arguments", manifest.arguments},
      {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                              fmt::gmtime(std::chrono::system_clock::to_time_t(manifest.started)))},
      {"seed", manifest.seed},
      {"threads", manifest.threads},
      {"device", manifest.device},
      {"options", describe_options(table, origins)},
      {"inputs", describe_inputs(manifest.inputs)},
      {"sources", describe_sources(manifest.sources)},
      {"stages", describe_stages(manifest.stages)},
      {"doubtful", manifest.doubts},
      {"host", describe_host()}};
  write_file(folder / "manifest.json", json_text(document, 2) + "\n");
}

}  // namespace nadir
