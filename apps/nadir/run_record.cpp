// SPDX-License-Identifier: Apache-2.0
#include "run_record.hpp"

#include <algorithm>
#include <charconv>

#include "nadir/core/error.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/trajectories/tum.hpp"
#include "run_files.hpp"

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

/// A manifest while its items are looked at: everything that is there must be of its kind, so that
/// whoever reads on may take it as such. What is missing is the reader's concern.
class ManifestCheck {
 public:
  explicit ManifestCheck(fs::path file) : file_(std::move(file)) {}

  using Kind = bool (Json::*)() const noexcept;

  /// The item, an empty one of the kind where it is not there.
  Json item(const Json& object, const char* key, Kind is_of_kind, const char* kind) const {
    if (!object.is_object())
      throw error(std::string("what should hold '") + key + "' is no object");
    if (!object.contains(key)) return {};
    const Json& value = object[key];
    if (!(value.*is_of_kind)()) throw error(std::string("'") + key + "' is no " + kind);
    return value;
  }

  void texts(const Json& object, std::initializer_list<const char*> keys) const {
    for (const char* key : keys) item(object, key, &Json::is_string, "text");
  }

  void numbers(const Json& object, std::initializer_list<const char*> keys) const {
    for (const char* key : keys) item(object, key, &Json::is_number, "number");
  }

  Error error(const std::string& problem) const {
    return {ErrorKind::kInput, problem, file_.string(), "run localize again"};
  }

 private:
  fs::path file_;
};

void check_manifest(const Json& manifest, const fs::path& file) {
  const ManifestCheck check(file);
  check.texts(manifest, {"program", "version", "started", "device"});
  check.item(manifest, "seed", &Json::is_number_unsigned, "whole number");
  check.item(manifest, "threads", &Json::is_number_unsigned, "whole number");
  check.item(manifest, "arguments", &Json::is_array, "list");
  const Json options = check.item(manifest, "options", &Json::is_object, "object");
  for (const auto& option : options.items()) check.texts(option.value(), {"from"});
  const Json sources = check.item(manifest, "sources", &Json::is_object, "object");
  for (const auto& source : sources.items()) {
    if (!source.value().is_string()) throw check.error("'" + source.key() + "' is no path");
    std::error_code problem;
    static_cast<void>(fs::status(source.value().get<std::string>(), problem));
    // A name that is too long, say; that it is not there is for those who need it.
    if (problem && problem != std::errc::no_such_file_or_directory &&
        problem != std::errc::not_a_directory) {
      throw check.error("'" + source.key() + "' is no path: " + problem.message());
    }
  }
  const Json inputs = check.item(manifest, "inputs", &Json::is_array, "list");
  for (const Json& input : inputs) {
    check.texts(input, {"path", "sha256"});
    check.numbers(input, {"bytes"});
  }
  const Json stages = check.item(manifest, "stages", &Json::is_array, "list");
  for (const Json& stage : stages) {
    check.texts(stage, {"name"});
    check.numbers(stage, {"seconds"});
  }
  const Json host = check.item(manifest, "host", &Json::is_object, "object");
  if (!host.is_null()) check.numbers(host, {"logical_processors", "memory_bytes"});
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
  // Values are written again by recursion, which a text of brackets alone would make too deep.
  constexpr int kDeepest = 32;
  bool deep = false;
  const auto is_shallow = [&](int depth, Json::parse_event_t, const Json&) {
    deep = deep || depth > kDeepest;
    return !deep;
  };
  Json manifest = Json::parse(read_file(file), is_shallow, false);
  if (deep) {
    throw Error(ErrorKind::kInput, "is nested too deeply", file.string(), "run localize again");
  }
  if (!manifest.is_object()) {
    throw Error(ErrorKind::kInput, "is not JSON", file.string(), "run localize again");
  }
  check_manifest(manifest, file);
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
    for (ViewFrame& frame : record.frames) frame.truth = pose_at(record.truth, frame.stamp);
  } catch (const Error& error) {
    record.truth.clear();
    record.truth_problem = error.what();
  }
  return record;
}

}  // namespace nadir::cli
