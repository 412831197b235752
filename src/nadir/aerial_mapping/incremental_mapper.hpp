// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/mapping.hpp"

namespace nadir {

/// A square of the map, kMapTilePx pixels a side, counted from the map's own origin so that it
/// keeps its name as the map grows: x eastwards, y northwards, either may be negative.
struct MapTile {
  int x = 0;
  int y = 0;
  auto operator<=>(const MapTile&) const = default;
};
inline constexpr int kMapTilePx = 256;

/// What one more photo changed.
struct MapUpdate {
  int version = 0;  ///< grows by one with every update
  std::vector<MapTile> changed_tiles;
  bool provisional = false;  ///< the photo was placed by its position alone, or not at all
  bool registered = false;   ///< the photo joins the map
  int photos = 0;            ///< that the map is made of
};

/// The map while the drone flies. Where photos have positions the grid is fixed by the first one:
/// pixels never shift under who uses the map. Without positions each photo makes the frame anew.
/// `finish` gives the very map that map_photos makes of the same photos.
class IncrementalMapper {
 public:
  /// `frame` is a photo set without photos: cameras (may grow with add_camera), control points,
  /// coordinate reference system.
  IncrementalMapper(PhotoSet frame, const AerialMappingOptions& options);
  ~IncrementalMapper();
  IncrementalMapper(const IncrementalMapper&) = delete;
  IncrementalMapper& operator=(const IncrementalMapper&) = delete;
  IncrementalMapper(IncrementalMapper&&) = delete;
  IncrementalMapper& operator=(IncrementalMapper&&) = delete;

  /// Index of the camera, which is added where it is not known yet.
  std::size_t add_camera(const CameraPrior& camera);

  /// Throws Stopped: the photo is among the others then, but not in the map before the next one.
  MapUpdate add(const MappingPhoto& photo, const StopToken& stop = {});

  /// The map as it stands: feathered, quickly made, with poses and views but without report and
  /// sources. Empty before two photos join or one has position, attitude and height.
  const AerialMap& current() const;

  /// All photos adjusted together, seams and blending as in batch mode. Throws Stopped.
  AerialMap finish(const MappingProgress& progress = {}, const StopToken& stop = {});

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir
