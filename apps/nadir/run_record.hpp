// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation_report.hpp"
#include "viewer/view_frames.hpp"

namespace nadir::cli {

/// manifest.json of a run. Throws Error (input) where it is missing or no JSON, or an item of it is
/// of another kind than `write_manifest` gives it.
Json read_manifest(const std::filesystem::path& run);

/// Where the manifest says that the run's `map`, `site`, `surface` or `drive` is; empty where it
/// does not.
std::filesystem::path source_in(const Json& manifest, const std::string& role);

/// The value of an option as the manifest has it, as `--set` takes it.
std::string option_text(const Json& value);

/// The folders of trajectories below a run of several seeds or a demo, sorted by their numbers.
std::vector<std::filesystem::path> runs_below(const std::filesystem::path& folder);

/// The folder of a run's trajectory: its own, or that of the first of several seeds. Throws Error
/// (input) where there is none.
std::filesystem::path first_run_in(const std::filesystem::path& run);

/// What a run left, read again.
struct RunRecord {
  Json manifest;
  std::vector<ViewFrame> frames;  ///< with the truth where there is one
  Trajectory truth;               ///< over these frames; may be empty
  std::optional<Judgement> judgement;
  std::string truth_problem;  ///< why a truth that is there was not used; may be empty
};

/// Reads a folder with a trajectory; the truth is the run's truth.tum or the site's. Throws Error
/// (input) with file:line where a file is missing or damaged.
RunRecord read_run(const std::filesystem::path& folder, const Json& manifest);

}  // namespace nadir::cli
