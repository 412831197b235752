// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/flight/mapping_work.hpp"

#include <fmt/format.h>

#include <functional>

#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/unfinished_folder.hpp"
#include "nadir/version.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;

/// Before each value: who found it, and the key, so that two keys of one hash are told apart.
std::string head_of(const std::string& key) { return "nadir " NADIR_VERSION "\n" + key + "\n"; }

}  // namespace

MappingWork::MappingWork(const fs::path& map)
    : folder_(map.parent_path() / ("." + map.stem().string() + ".work")) {
  remove_all_abandoned(folder_);
}

fs::path MappingWork::file_of(const std::string& key) const {
  return folder_ / fmt::format("{:016x}", std::hash<std::string>{}(key));
}

std::optional<std::string> MappingWork::find(const std::string& key) {
  const fs::path file = file_of(key);
  const std::string head = head_of(key);
  if (!is_file(file)) return std::nullopt;
  try {
    std::string bytes = read_file(file);
    if (!bytes.starts_with(head)) return std::nullopt;
    ++taken_up_;
    return bytes.substr(head.size());
  } catch (const Error&) {
    return std::nullopt;
  }
}

void MappingWork::keep(const std::string& key, const std::string& bytes) {
  try {
    create_folder(folder_);
    write_file(file_of(key), head_of(key) + bytes);
  } catch (const Error&) {  // a full disk costs the resuming, not the map
    return;
  }
}

bool MappingWork::holds_something() const {
  std::error_code missing;
  return fs::directory_iterator(folder_, missing) != fs::directory_iterator();
}

void MappingWork::remove() const {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace nadir
