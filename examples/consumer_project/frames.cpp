// SPDX-License-Identifier: Apache-2.0
// Uses nadir::core alone: no OpenCV, no GDAL.
#include <iostream>

#include "nadir/core/frames.hpp"

int main() {
  const nadir::Pose2 map_from_robot{12.0, 30.5, nadir::radians(90.0)};
  const nadir::Point2<nadir::frames::Robot> lamp_in_robot{2.0, 0.5};

  const nadir::Point2<nadir::frames::Map> lamp_in_map = map_from_robot * lamp_in_robot;

  std::cout << "the lamp stands at " << lamp_in_map.x << " m east, " << lamp_in_map.y
            << " m north\n";
}
