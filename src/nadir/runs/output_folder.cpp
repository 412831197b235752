// SPDX-License-Identifier: Apache-2.0
#include "nadir/runs/output_folder.hpp"

#include <algorithm>

#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"

namespace nadir {
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

}  // namespace

void require_writable(const fs::path& target, bool overwrite, const std::vector<fs::path>& inputs) {
  const fs::path folder = resolved(target);
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) {
    throw Error(ErrorKind::kUsage, "the output exists and is no folder", target.string(),
                "give another -o");
  }
  if (fs::is_empty(folder)) return;
  if (!overwrite) {
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

OutputFolder::OutputFolder(fs::path target, bool overwrite, const std::vector<fs::path>& inputs)
    : target_(std::move(target)) {
  require_writable(target_, overwrite, inputs);
  const fs::path place = resolved(target_);
  create_folder(place.parent_path());
  remove_abandoned(place);
  unfinished_.emplace(place);
}

void OutputFolder::commit() { unfinished_->become_target(); }

}  // namespace nadir
