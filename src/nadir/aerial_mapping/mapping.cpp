// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/mapping.hpp"

#include "nadir/core/error.hpp"

namespace nadir {

std::string to_string(ScaleSource source) {
  for (const auto& [value, name] : kScaleSourceNames)
    if (value == source) return name;
  return {};
}

AerialMap map_photos(const PhotoSet& /*photos*/, const AerialMappingOptions& /*options*/,
                     const MappingProgress& /*progress*/) {
  throw Error(ErrorKind::kProcessing, "aerial mapping is not finished yet");
}

bool can_solve_poses() {
#ifdef NADIR_HAS_SFM
  return true;
#else
  return false;
#endif
}

}  // namespace nadir
