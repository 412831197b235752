// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "nadir/core/options.hpp"

namespace nadir {

/// Where the values that are not defaults came from, by option name: "run.yaml:3", "--set".
using OptionOrigins = std::map<std::string, std::string>;

/// Sets the options that a YAML file gives, as nested maps (`map_matching: {score: zncc}`) or
/// dotted keys (`map_matching.score: zncc`), and returns the file:line of each. Throws Error with
/// file:line: input where the file cannot be read; usage where it is not YAML, or an option is
/// unknown, given twice, out of range or without a value.
OptionOrigins read_yaml_options(const std::filesystem::path& path, OptionTable& table);

/// The effective values as YAML that read_yaml_options reads back, grouped by stage; comments give
/// the description, what is allowed, the default with its source, and the origin of the value.
std::string dump_yaml_options(const OptionTable& table, const OptionOrigins& origins);

}  // namespace nadir
