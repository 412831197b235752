// SPDX-License-Identifier: Apache-2.0
#include "end_to_end/small_flight.hpp"

#include "nadir/core/angle.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/photos/photo_file.hpp"

namespace nadir::testing {

std::vector<std::filesystem::path> write_flight(const std::filesystem::path& folder,
                                                const test::FlightPlan& plan) {
  const GeodeticPosition place{46.0, 8.0, 400.0};
  const MetricFrame frame = MetricFrame::around({place});
  test::FlightErrors errors;
  errors.gps_bias = frame.to_map(place).vector();
  const test::Flight flight = test::fly(std::make_shared<const test::Terrain>(), plan, errors);
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> files;
  for (const MappingPhoto& from : flight.set.photos) {
    Photo photo;
    photo.image = from.load();
    PhotoMetadata& tags = photo.metadata;
    tags.make = "Test";
    tags.model = "T480";
    tags.focal_length_35mm = 36.0 * flight.camera.fx / flight.camera.width;
    tags.position = frame.to_geodetic(*from.prior.position);
    tags.relative_altitude_m = from.prior.relative_altitude_m;
    tags.taken_at = from.prior.taken_at;
    tags.gimbal =
        GimbalAttitude{90.0 - degrees(from.prior.attitude->yaw),
                       degrees(from.prior.attitude->pitch), degrees(from.prior.attitude->roll)};
    files.push_back(folder / from.name);
    write_photo(files.back(), photo);
  }
  return files;
}

}  // namespace nadir::testing
