// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>

#include "nadir/aerial_mapping/mapping_store.hpp"

namespace nadir {

/// The folder beside a map in which its mapping keeps features and matches until the map is
/// written.
class MappingWork : public MappingStore {
 public:
  explicit MappingWork(const std::filesystem::path& map);

  std::optional<std::string> find(const std::string& key) override;
  void keep(const std::string& key, const std::string& bytes) override;

  const std::filesystem::path& folder() const { return folder_; }
  int taken_up() const { return taken_up_; }  ///< values found so far
  bool holds_something() const;
  void remove() const;  ///< the map is written

 private:
  std::filesystem::path file_of(const std::string& key) const;

  std::filesystem::path folder_;
  std::atomic<int> taken_up_{0};
};

}  // namespace nadir
