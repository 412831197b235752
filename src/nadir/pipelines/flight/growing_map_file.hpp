// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "nadir/core/orthomosaic.hpp"

namespace nadir {

/// MAP.update.json, in which `nadir map --follow` says what the last photo changed.
std::filesystem::path update_file(const std::filesystem::path& map);

/// Whether the map is in the making: its update says that it is not final.
bool is_growing(const std::filesystem::path& map);

/// A map that `nadir map --follow` writes, for who uses it meanwhile.
class GrowingMapFile {
 public:
  /// The version that lies there now counts as known.
  explicit GrowingMapFile(std::filesystem::path map);

  /// The map where there is a newer version than before. Until the final one its file is looked at
  /// with every call. Throws Error (input) where it cannot be read.
  std::optional<Orthomosaic> newer();
  int version() const { return version_; }

 private:
  std::filesystem::path map_;
  int version_ = 0;
  bool final_ = false;
};

}  // namespace nadir
