// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "cli/invocation.hpp"
#include "nadir/io/drives/drive_reader.hpp"

namespace nadir::cli {

/// What a verb that takes a recorded drive asks of it.
struct DriveOptionsOfVerb {
  std::filesystem::path input;
  DriveReadOptions reading;
  std::string every = "0.5m";
  double size_m = 0.0;  ///< 0 = as the options say
};

/// Adds INPUT and the options of reading and spacing: --poses, --format, --every, ...
void add_drive_options(CLI::App& verb, DriveOptionsOfVerb& options);

/// How far apart local maps are: by distance driven, by time, or by frames.
struct Spacing {
  enum class Unit { kMetres, kSeconds, kFrames };
  double amount = 0.5;
  Unit unit = Unit::kMetres;
};

/// "1m", "0.5s", "3f" or "3" (frames). Throws Error (usage).
Spacing parse_spacing(const std::string& text);

}  // namespace nadir::cli
