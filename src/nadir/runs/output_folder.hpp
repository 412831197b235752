// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "nadir/io/unfinished_folder.hpp"

namespace nadir {

/// A folder that appears at once and complete: files are written into a hidden sibling, which takes
/// the target's name in commit(). Without commit() nothing is left behind; what a run that was
/// killed left of the same target goes at the next start.
class OutputFolder {
 public:
  /// Throws Error (usage) where the target holds something and may not be replaced: without
  /// `overwrite`, where nadir did not write it, or where one of `inputs` lies in it.
  OutputFolder(std::filesystem::path target, bool overwrite,
               const std::vector<std::filesystem::path>& inputs);

  /// Where to write.
  const std::filesystem::path& staging() const { return unfinished_->path(); }
  /// Where it will be.
  const std::filesystem::path& target() const { return target_; }
  /// Throws Error (processing).
  void commit();

 private:
  std::filesystem::path target_;
  std::optional<UnfinishedFolder> unfinished_;
};

/// Checks only, for --dry-run.
void require_writable(const std::filesystem::path& target, bool overwrite,
                      const std::vector<std::filesystem::path>& inputs);

}  // namespace nadir
