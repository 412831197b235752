// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "nadir/core/options.hpp"
#include "nadir/io/options/yaml_options.hpp"

namespace nadir {

/// What it took to make an output: enough to make it again. Times and host facts stand here and
/// nowhere else, so that the outputs themselves are equal byte by byte from run to run.
struct Manifest {
  struct Stage {
    std::string name;
    double seconds = 0.0;
  };

  std::string program_version;
  std::vector<std::string> arguments;  ///< the command line
  std::uint64_t seed = 0;
  int threads = 1;
  std::string device = "cpu";
  /// Files, and folders for all files below them.
  std::vector<std::filesystem::path> inputs;
  /// The parts that a later look at the output needs again, by their role: "site", "map".
  std::vector<std::pair<std::string, std::filesystem::path>> sources;
  std::vector<Stage> stages;
  std::vector<std::string> doubts;  ///< why the output must not be relied on unseen
  std::chrono::system_clock::time_point started = std::chrono::system_clock::now();
};

/// Writes `folder`/manifest.json, atomically: the manifest, the effective value and the origin of
/// every option of `table`, size and SHA-256 of every input, and facts about this host. Throws
/// Error (input) where an input cannot be read, (processing) where the file cannot be written.
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest,
                    const OptionTable& table, const OptionOrigins& origins = {});

}  // namespace nadir
