// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "nadir/aerial_mapping/mapping.hpp"
#ifdef NADIR_HAS_SFM
#include "nadir/aerial_mapping/sfm/photo_graph.hpp"
#include "nadir/aerial_mapping/sfm/reconstruction.hpp"
#endif

namespace nadir::aerial {

/// A photo set in the order and the frame that the computation uses: sorted by name, moved by
/// whole metres so that the photos lie near the origin.
struct LocalSet {
  PhotoSet set;
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< map = local + anchor
};

/// Throws Error (usage) where the set contradicts itself. The anchor follows from the positions
/// unless it is given.
LocalSet localise(const PhotoSet& photos, const Eigen::Vector3d* anchor = nullptr);

/// Photos in, map out; keeps features and matches for the next run.
class Pipeline {
 public:
  explicit Pipeline(const AerialMappingOptions& options, MappingStore* store = nullptr);

  AerialMap run(const PhotoSet& photos, const MappingProgress& progress, const StopToken& stop);

#ifdef NADIR_HAS_SFM
  PhotoGraph& graph() { return graph_; }
#endif

 private:
  AerialMappingOptions options_;
#ifdef NADIR_HAS_SFM
  PhotoGraph graph_;
#endif
};

}  // namespace nadir::aerial
