// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "nadir/io/unfinished_folder.hpp"

namespace nadir {

/// A file that appears under its name only when it is whole: it is written in a hidden folder
/// beside it (UnfinishedFolder), flushed to disk and renamed. Without `commit` nothing of it stays.
///
/// For libraries that write to a path themselves: the temporary file has the name of the target,
/// and files that they put beside it vanish with the folder.
class AtomicFile {
 public:
  /// Throws Error (processing) where the folder of `target` does not exist or cannot be written.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;

  const std::filesystem::path& target() const { return target_; }
  /// Where to write before `commit`.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Creates the temporary file with these bytes. Throws Error (processing).
  void write(std::string_view bytes);
  /// Makes the temporary file durable and gives it its name, replacing what was there.
  /// Throws Error (processing).
  void commit();

 private:
  std::filesystem::path target_;
  UnfinishedFolder folder_;
  std::filesystem::path temporary_;
};

/// Writes a whole file by AtomicFile. Throws Error (processing).
void write_file(const std::filesystem::path& target, std::string_view bytes);

/// Removes a file where there is one. Throws Error (processing).
void remove_file(const std::filesystem::path& target);

/// Creates a folder and its parents. Throws Error (processing).
void create_folder(const std::filesystem::path& folder);

}  // namespace nadir
