// SPDX-License-Identifier: Apache-2.0
#include "run_record.hpp"

#include <algorithm>
#include <charconv>

#include "nadir/core/error.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/tum.hpp"
#include "run_files.hpp"
#include "site.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTrajectory = "trajectory.tum";

/// The number at the end of a name, so that seed_10 comes after seed_9.
int number_of(const fs::path& folder) {
  const std::string name = folder.filename().string();
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  int number = -1;
  std::from_chars(name.data() + digits, name.data() + name.size(), number);
  return number;
}

bool comes_before(const fs::path& one, const fs::path& other) {
  const int first = number_of(one);
  const int second = number_of(other);
  return first != second ? first < second : one < other;
}

/// The truth of the run itself, or of the site that it was made in, where that still is.
Trajectory truth_beside(const fs::path& folder, const Json& manifest) {
  if (is_file(folder / "truth.tum")) return read_tum(folder / "truth.tum");
  const fs::path site = source_in(manifest, "site");
  if (site.empty() || !is_file(site / "sequence.yaml")) return {};
  return read_sequence(site).truth.value_or(Trajectory{});
}

Trajectory between(const Trajectory& truth, Stamp first, Stamp last) {
  Trajectory part;
  std::ranges::copy_if(truth, std::back_inserter(part), [&](const StampedPose<frames::Map>& pose) {
    return !(pose.stamp < first) && !(last < pose.stamp);
  });
  return part;
}

Judgement judge(const RunRecord& record) {
  Trajectory estimated;
  std::vector<StampedCovariance> covariances;
  for (const ViewFrame& frame : record.frames) {
    estimated.push_back({frame.stamp, frame.map_from_robot});
    covariances.push_back({frame.stamp, frame.covariance});
  }
  return judged(estimated, covariances, record.truth);
}

}  // namespace

Json read_manifest(const fs::path& run) {
  const fs::path file = run / "manifest.json";
  if (!is_folder(run)) {
    throw Error(ErrorKind::kInput, "no such folder", run.string(),
                "give a folder that `nadir localize` wrote");
  }
  if (!is_file(file)) {
    throw Error(ErrorKind::kInput, "holds no manifest.json", run.string(),
                "give a folder that `nadir localize` wrote");
  }
  Json manifest = Json::parse(read_file(file), nullptr, false);
  if (!manifest.is_object()) {
    throw Error(ErrorKind::kInput, "is not JSON", file.string(), "run localize again");
  }
  return manifest;
}

fs::path source_in(const Json& manifest, const std::string& role) {
  const Json sources = manifest.value("sources", Json::object());
  return sources.contains(role) ? fs::path(name_at(sources, role)) : fs::path{};
}

std::string option_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  return json_text(value);
}

std::vector<fs::path> runs_below(const fs::path& folder) {
  std::vector<fs::path> runs;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (fs::exists(entry.path() / kTrajectory)) runs.push_back(entry.path());
  }
  std::ranges::sort(runs, comes_before);
  return runs;
}

fs::path first_run_in(const fs::path& run) {
  if (fs::exists(run / kTrajectory)) return run;
  const std::vector<fs::path> runs = runs_below(run);
  if (runs.empty()) {
    throw Error(ErrorKind::kInput, "holds no trajectory.tum", run.string(),
                "give a folder that `nadir localize` wrote");
  }
  return runs.front();
}

RunRecord read_run(const fs::path& folder, const Json& manifest) {
  RunRecord record{manifest, read_view_frames(folder), {}, {}, {}};
  if (record.frames.empty()) {
    throw Error(ErrorKind::kInput, "holds no frame", (folder / kTrajectory).string(),
                "run localize again");
  }
  try {
    const Stamp first = record.frames.front().stamp;
    const Stamp last = record.frames.back().stamp;
    record.truth = between(truth_beside(folder, manifest), first, last);
    if (!record.truth.empty()) record.judgement = judge(record);
    for (ViewFrame& frame : record.frames) frame.truth = truth_at(record.truth, frame.stamp);
  } catch (const Error& error) {
    record.truth.clear();
    record.truth_problem = error.what();
  }
  return record;
}

}  // namespace nadir::cli
