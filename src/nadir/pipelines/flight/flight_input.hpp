// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/flight.hpp"
#include "nadir/aerial_mapping/options.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/photos/position_list.hpp"

namespace nadir {

/// The files that a map is made from.
struct FlightFiles {
  std::filesystem::path photos;          ///< folder
  std::filesystem::path positions;       ///< empty = none
  std::filesystem::path control_points;  ///< empty = none
  std::filesystem::path poses;           ///< empty = none
  double metres_per_pixel = 0.0;         ///< of the photos as stored; 0 = not given
};

/// A flight as it was read, ready to be mapped.
struct FlightInput {
  PhotoSet set;
  std::optional<MetricFrame> frame;          ///< none = local metres
  int found = 0;                             ///< photos in the folder
  std::vector<PhotoMetadata> photos;         ///< those that take part, in the order of the set
  std::vector<std::filesystem::path> files;  ///< of these photos
  std::vector<std::string> warnings;
  std::vector<std::string> doubts;  ///< why the map will be doubtful
  FlightEstimate estimate;
};

/// A photo of the flight: its file and its name, which is unique.
struct FlightPhoto {
  std::filesystem::path file;
  PhotoMetadata metadata;
  std::string digest = {};  ///< of the file's bytes
};

/// Reads tags and lists; the pixels stay in their files until the map asks for them. Throws Error
/// (input) where fewer than 60 % of the photos can be read, (usage) where nothing gives the map a
/// scale, and as the readers of the lists do.
FlightInput read_flight(const FlightFiles& files, const AerialMappingOptions& options,
                        const std::function<void(int, int)>& progress);

/// Overwrites what the tags say with what a list says. Returns the names of the list that are not
/// among the photos.
std::vector<std::string> apply_positions(const std::vector<ListedPosition>& list,
                                         std::vector<FlightPhoto>& photos);

/// What a photo's tags say, in the map frame.
PhotoPrior prior_of(const PhotoMetadata& photo, const MetricFrame* frame);

}  // namespace nadir
