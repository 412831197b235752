// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace nadir {

/// Keeps what a mapping finds on its way, features and matches, so that one that was broken off is
/// taken up where it stopped. A key names all that its value follows from. May be asked from
/// several threads, for different keys.
class MappingStore {
 public:
  MappingStore() = default;
  MappingStore(const MappingStore&) = delete;
  MappingStore& operator=(const MappingStore&) = delete;
  MappingStore(MappingStore&&) = delete;
  MappingStore& operator=(MappingStore&&) = delete;
  virtual ~MappingStore() = default;

  virtual std::optional<std::string> find(const std::string& key) = 0;
  /// Cannot fail: what could not be kept is computed again.
  virtual void keep(const std::string& key, const std::string& bytes) = 0;
};

}  // namespace nadir
