// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace nadir {

/// A hidden folder beside a target, `.NAME.unfinished-RANDOM`, in which the target is written until
/// it is whole. No other writer has its name, in whatever container it runs; a lock on the folder
/// tells that its writer lives. What is still in it goes with the object.
class UnfinishedFolder {
 public:
  /// Throws Error (processing) where it cannot be made.
  explicit UnfinishedFolder(std::filesystem::path target);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
  UnfinishedFolder(UnfinishedFolder&&) = delete;
  UnfinishedFolder& operator=(UnfinishedFolder&&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Gives the whole folder the target's name; a folder of that name is exchanged for it in one
  /// step, where the file system can, and removed. Throws Error (processing); what was there is
  /// there then.
  void become_target();
  /// Removes it and what it holds now.
  void remove();

 private:
  bool make();

  std::filesystem::path target_;
  std::filesystem::path path_;  ///< empty where it is gone
  int lock_ = -1;
};

/// Removes what writers that did not live to their end, as after SIGKILL, have left of a target,
/// beside it. Whose writer lives stays. Never throws: what cannot be removed stays too.
void remove_abandoned(const std::filesystem::path& target);

/// The same of every target in a folder.
void remove_all_abandoned(const std::filesystem::path& folder);

}  // namespace nadir
