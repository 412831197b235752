// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/statistics.hpp"

namespace nadir {

std::string to_string(MappingStatus status) {
  switch (status) {
    case MappingStatus::kOk:
      return "ok";
    case MappingStatus::kNoGround:
      return "no_ground";
    case MappingStatus::kNoPoints:
      return "no_points";
  }
  return {};
}

}  // namespace nadir
