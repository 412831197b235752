// SPDX-License-Identifier: Apache-2.0
#include "output_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>

#include "nadir/core/error.hpp"
#include "nadir/io/file_names.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

/// The target without a trailing slash or a link, so that a sibling is really beside it.
fs::path resolved(const fs::path& path) {
  fs::path normal = fs::weakly_canonical(fs::absolute(path));
  return normal.has_filename() ? normal : normal.parent_path();
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path inner = resolved(path);
  const auto [end, unused] =
      std::mismatch(folder.begin(), folder.end(), inner.begin(), inner.end());
  return end == folder.end();
}

/// Only what nadir wrote is replaced: `-o .` must never cost a user their files.
bool written_by_nadir(const fs::path& folder) {
  return fs::exists(folder / "manifest.json") || fs::exists(folder / "sequence.yaml");
}

void flush_to_disk(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  fsync(file);
  close(file);
}

}  // namespace

void require_writable(const fs::path& target, const CommonOptions& common,
                      const std::vector<fs::path>& inputs) {
  const fs::path folder = resolved(target);
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) {
    throw Error(ErrorKind::kUsage, "the output exists and is no folder", target.string(),
                "give another -o");
  }
  if (fs::is_empty(folder)) return;
  if (!common.overwrite) {
    throw Error(ErrorKind::kUsage, "the output folder exists and is not empty", target.string(),
                "give --overwrite to replace it, or another -o");
  }
  if (!written_by_nadir(folder)) {
    throw Error(ErrorKind::kUsage, "the output folder was not written by nadir", target.string(),
                "give another -o, or empty it yourself");
  }
  for (const fs::path& input : inputs) {
    if (lies_in(input, folder)) {
      throw Error(ErrorKind::kUsage, "the output folder holds the input " + input.string(),
                  target.string(), "give another -o");
    }
  }
}

OutputFolder::OutputFolder(fs::path target, const CommonOptions& common,
                           const std::vector<fs::path>& inputs)
    : target_(std::move(target)) {
  require_writable(target_, common, inputs);
  const fs::path place = resolved(target_);
  staging_ = place.parent_path() /
             ("." + short_name(place.filename()) + ".unfinished-" + std::to_string(getpid()));
  std::error_code error;
  fs::create_directories(staging_, error);
  if (error) {
    throw Error(ErrorKind::kProcessing, "cannot create the output folder: " + error.message(),
                target_.string(), "check the place and its rights");
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
}

void OutputFolder::commit() {
  const fs::path place = resolved(target_);
  const fs::path old = staging_.string() + "-old";
  std::error_code error;
  const bool replaces = fs::exists(place);
  flush_to_disk(staging_);
  if (replaces) fs::rename(place, old, error);
  if (!error) fs::rename(staging_, place, error);
  if (error) {
    std::error_code ignored;
    if (replaces && !fs::exists(place)) fs::rename(old, place, ignored);
    throw Error(ErrorKind::kProcessing, "cannot put the output in place: " + error.message(),
                target_.string());
  }
  staging_.clear();
  if (replaces) fs::remove_all(old, error);
  flush_to_disk(place.parent_path());
}

}  // namespace nadir::cli
