// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/unfinished_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "nadir/core/error.hpp"
#include "nadir/io/file_names.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".unfinished-";
/// Of what a target held before, for the moment between two renames (see exchange()).
constexpr const char* kOld = "-old";

/// Room for the marks and the number around a name.
constexpr std::size_t kLongestKept = kLongestName - 40;

std::string prefix_of(const fs::path& target) {
  return "." + short_name(target.filename(), kLongestKept) + kMark;
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

std::uint64_t any_number() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device();
}

/// A file system that knows no locks has the name alone to tell writers apart.
bool take(int folder) { return flock(folder, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

/// Whether the open folder still has this name: another process may have taken it for abandoned
/// before it was locked.
bool is_still(const fs::path& path, int folder) {
  struct stat named {};
  struct stat open {};
  return stat(path.c_str(), &named) == 0 && fstat(folder, &open) == 0 &&
         named.st_ino == open.st_ino && named.st_dev == open.st_dev;
}

Error not_made(const fs::path& target, int system_error) {
  return {ErrorKind::kProcessing,
          "cannot be written: " + std::generic_category().message(system_error), target.string(),
          "check the folder, its permissions and the free space"};
}

/// Removes the folder where its writer is dead.
void remove_if_abandoned(const fs::path& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  std::error_code ignored;
  if (flock(folder, LOCK_EX | LOCK_NB) == 0) fs::remove_all(path, ignored);
  close(folder);
}

/// A run that died between the two renames of exchange() had put the old output here. A name beyond
/// kLongestKept comes back shortened: what it held is not lost.
void restore_old(const fs::path& old, const std::string& name) {
  const fs::path target = old.parent_path() / name.substr(1, name.find(kMark) - 1);
  std::error_code ignored;
  if (fs::exists(target, ignored)) {
    fs::remove_all(old, ignored);
  } else {
    fs::rename(old, target, ignored);
  }
}

void remove_abandoned(const fs::path& folder, const std::string& prefix) {
  std::error_code error;
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(prefix) && name.find(kMark) != std::string::npos) {
      found.push_back(entry->path());
    }
  }
  for (const fs::path& path : found) {
    const std::string name = path.filename().string();
    if (!name.ends_with(kOld)) {
      remove_if_abandoned(path);
    } else if (!fs::exists(path.string().substr(0, path.string().size() - std::string(kOld).size()),
                           error)) {
      restore_old(path, name);
    }
  }
}

/// Two names change places. Not every file system can do that in one step (NFS cannot): then a
/// process that dies between the two leaves the old folder beside the target's name, where the next
/// one finds it.
bool exchange(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS && errno != ENOTSUP) return false;
  const fs::path old = from.string() + kOld;
  if (std::rename(to.c_str(), old.c_str()) != 0) return false;
  if (std::rename(from.c_str(), to.c_str()) == 0) {
    return std::rename(old.c_str(), from.c_str()) == 0;
  }
  const int error = errno;
  std::error_code ignored;
  fs::rename(old, to, ignored);
  errno = error;
  return false;
}

}  // namespace

UnfinishedFolder::UnfinishedFolder(fs::path target) : target_(std::move(target)) {
  constexpr int kAttempts = 100;
  for (int i = 0; i < kAttempts; ++i) {
    if (make()) return;
  }
  throw not_made(target_, EEXIST);
}

UnfinishedFolder::~UnfinishedFolder() { remove(); }

/// False where the name is taken, or was.
bool UnfinishedFolder::make() {
  constexpr mode_t kByUmask = 0777;
  path_ = folder_of(target_) / fmt::format("{}{:016x}", prefix_of(target_), any_number());
  if (mkdir(path_.c_str(), kByUmask) != 0) {
    const int error = errno;
    path_.clear();
    if (error == EEXIST) return false;
    throw not_made(target_, error);
  }
  lock_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ >= 0 && take(lock_) && is_still(path_, lock_)) return true;
  const int error = errno;
  remove();
  if (error == EMFILE || error == ENFILE || error == EACCES) throw not_made(target_, error);
  return false;
}

void UnfinishedFolder::become_target() {
  fsync(lock_);
  const bool replaces = fs::exists(target_);
  const bool done =
      replaces ? exchange(path_, target_) : std::rename(path_.c_str(), target_.c_str()) == 0;
  if (!done) throw not_made(target_, errno);
  if (!replaces) path_.clear();
  remove();  // what was there before
  const int folder = open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

void UnfinishedFolder::remove() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  path_.clear();
  if (lock_ >= 0) close(lock_);
  lock_ = -1;
}

void remove_abandoned(const fs::path& target) {
  remove_abandoned(folder_of(target), prefix_of(target));
}

void remove_all_abandoned(const fs::path& folder) { remove_abandoned(folder, "."); }

}  // namespace nadir
