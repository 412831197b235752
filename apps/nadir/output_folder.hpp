// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "invocation.hpp"

namespace nadir::cli {

/// A folder that appears at once and complete: files are written into a hidden sibling, which takes
/// the target's name in commit(). Without commit() nothing is left behind.
class OutputFolder {
 public:
  /// Throws Error (usage) where the target holds something and may not be replaced: without
  /// --overwrite, where nadir did not write it, or where one of `inputs` lies in it.
  OutputFolder(std::filesystem::path target, const CommonOptions& common,
               const std::vector<std::filesystem::path>& inputs);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& staging() const { return staging_; }
  /// Where it will be.
  const std::filesystem::path& target() const { return target_; }
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path staging_;
};

/// Checks only, for --dry-run.
void require_writable(const std::filesystem::path& target, const CommonOptions& common,
                      const std::vector<std::filesystem::path>& inputs);

}  // namespace nadir::cli
