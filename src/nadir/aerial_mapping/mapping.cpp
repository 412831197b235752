// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/mapping.hpp"

#include "nadir/aerial_mapping/detail/pipeline.hpp"

namespace nadir {

std::string to_string(ScaleSource source) {
  for (const auto& [value, name] : kScaleSourceNames)
    if (value == source) return name;
  return {};
}

bool can_solve_poses() {
#ifdef NADIR_HAS_SFM
  return true;
#else
  return false;
#endif
}

AerialMap map_photos(const PhotoSet& photos, const AerialMappingOptions& options,
                     const MappingProgress& progress, MappingStore* store, const StopToken& stop) {
  aerial::Pipeline pipeline(options, store);
  return pipeline.run(photos, progress, stop);
}

}  // namespace nadir
