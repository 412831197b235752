// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/aerial_map.hpp"
#include "nadir/aerial_mapping/incremental_mapper.hpp"

namespace nadir::aerial {

/// A map to which pieces are added. All pieces lie on one grid, whole multiples of the resolution
/// from the anchor, so that pixels never move.
class GrowingMap {
 public:
  const AerialMap& map() const { return map_; }

  /// Takes over the pixels of a piece (frame: map minus `anchor`); where `replace`, the piece is
  /// the whole map. Invalid pixels of a piece leave what is there. Returns the tiles that changed.
  std::set<MapTile> put(const AerialMap& piece, const Eigen::Vector3d& anchor, bool replace);

  void set_poses(std::vector<PhotoPose> poses, const std::string& crs);

 private:
  void grow_to(long west, long north, long east, long south, double resolution);

  AerialMap map_;
  long west_ = 0;   ///< of the map, pixels from the anchor
  long north_ = 0;  ///< northwards
};

}  // namespace nadir::aerial
