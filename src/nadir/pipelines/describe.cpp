// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/describe.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "nadir/core/error.hpp"
#include "nadir/io/bags/bag_topics.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/trajectories/tum.hpp"

namespace nadir {
namespace {

double share(std::ptrdiff_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

Json describe(const GeoReference& geo, int width, int height) {
  return {{"width_px", width},
          {"height_px", height},
          {"resolution_m", geo.resolution},
          {"extent_m",
           {{"west", geo.west},
            {"south", geo.y_at(height)},
            {"east", geo.x_at(width)},
            {"north", geo.north}}},
          {"crs", geo.crs.empty() ? Json("local metres") : Json(geo.crs)}};
}

Json describe(const Orthomosaic& orthomosaic) {
  Json document = describe(orthomosaic.geo, orthomosaic.width(), orthomosaic.height());
  const auto& valid = orthomosaic.valid.values();
  const auto holes = std::ranges::count(valid, std::uint8_t{0});
  document["channels"] = orthomosaic.image.channels();
  document["valid_share"] = 1.0 - share(holes, valid.size());
  return document;
}

Json describe(const ElevationMap& surface) {
  Json document = describe(surface.geo, surface.width(), surface.height());
  std::vector<float> known;
  std::ranges::copy_if(surface.height_m.values(), std::back_inserter(known),
                       [](float height) { return std::isfinite(height); });
  const auto middle = known.begin() + std::ssize(known) / 2;
  std::ranges::nth_element(known, middle);
  document["heights_m"] = {{"lowest", *std::ranges::min_element(known)},
                           {"median", *middle},
                           {"highest", *std::ranges::max_element(known)}};
  document["known_share"] = share(std::ssize(known), surface.height_m.values().size());
  return document;
}

/// A gap is a step of time beyond 1.5 times the usual one.
constexpr double kGapFactor = 1.5;

template <class Stamped>
Json describe_stamps(const std::vector<Stamped>& items) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < items.size(); ++i) {
    steps.push_back(Stamp{items[i].stamp.nanoseconds - items[i - 1].stamp.nanoseconds}.seconds());
  }
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted);
  const double usual = sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
  const auto gaps =
      std::ranges::count_if(steps, [=](double step) { return step > kGapFactor * usual; });
  return {{"first_s", to_string(items.front().stamp)},
          {"last_s", to_string(items.back().stamp)},
          {"median_step_s", usual},
          {"longest_step_s", sorted.empty() ? 0.0 : sorted.back()},
          {"gaps", gaps}};
}

template <class In>
Json describe_poses(const TrajectoryIn<In>& trajectory) {
  Json document{{"poses", trajectory.size()}};
  if (trajectory.empty()) return document;
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += std::hypot(trajectory[i].pose.x - trajectory[i - 1].pose.x,
                         trajectory[i].pose.y - trajectory[i - 1].pose.y);
  }
  document["length_m"] = length;
  document["stamps"] = describe_stamps(trajectory);
  return document;
}

/// Messages a second, to hundredths; null for one alone.
Json rate_of(const BagTopic& topic) {
  const double seconds = Stamp{topic.last.nanoseconds - topic.first.nanoseconds}.seconds();
  if (!(seconds > 0.0)) return nullptr;
  return std::round(100.0 * static_cast<double>(topic.messages - 1) / seconds) / 100.0;
}

}  // namespace

Json describe_site(const std::filesystem::path& folder) {
  const Sequence sequence = read_sequence(folder);
  const auto& maps = sequence.local_maps;
  Json document{{"kind", "site"}, {"path", folder.string()}, {"name", sequence.name}};
  document["map"] = sequence.map ? describe(read_orthomosaic(*sequence.map)) : Json(nullptr);
  document["local_maps"] = {{"count", maps.size()},
                            {"first_frame", maps.front().number},
                            {"last_frame", maps.back().number},
                            {"stamps", describe_stamps(maps)},
                            {"first", describe(read_frame(sequence, maps.front()).local)}};
  document["odometry"] = sequence.odometry ? describe_poses(*sequence.odometry) : Json(nullptr);
  document["truth"] = sequence.truth ? describe_poses(*sequence.truth) : Json(nullptr);
  return document;
}

Json describe_drive(const std::filesystem::path& place) {
  const Drive drive = open_drive(place);
  Json document{{"kind", "drive"}, {"path", place.string()}};
  for (const auto& [format, name] : kDriveFormatNames) {
    if (format == drive.format) document["format"] = name;
  }
  document["sensor"] = drive.is_stereo() ? "stereo" : "lidar";
  document["frames"] = drive.frames.size();
  document["stamps"] = describe_stamps(drive.frames);
  if (const auto* rig = std::get_if<StereoRig>(&drive.rig)) {
    document["image_px"] = {rig->left.width, rig->left.height};
    document["focal_px"] = rig->left.fx;
    document["baseline_m"] = rig->baseline_m();
    document["rectified"] = rig->rectified;
  }
  document["poses"] = drive.odometry ? Json(drive.odometry->size()) : Json(nullptr);
  document["notes"] = drive.notes;
  return document;
}

Json describe_bag(const std::filesystem::path& file) {
  Json document{{"kind", "bag"}, {"path", file.string()}, {"topics", Json::object()}};
  for (const BagTopic& topic : list_bag(file)) {
    document["topics"][topic.name] = {{"type", topic.type},
                                      {"messages", topic.messages},
                                      {"rate_hz", rate_of(topic)},
                                      {"first_s", to_string(topic.first)},
                                      {"last_s", to_string(topic.last)}};
  }
  return document;
}

Json describe_image(const std::filesystem::path& path) {
  if (looks_like_heights(path)) {
    Json document{{"kind", "surface"}, {"path", path.string()}};
    document.update(describe(read_elevation_map(path)));
    return document;
  }
  const auto pixels = read_image(path);
  Json document{{"kind", "image"}, {"path", path.string()}};
  try {
    document.update(describe(read_orthomosaic(path)));
    document["kind"] = "orthomosaic";
  } catch (const Error& error) {
    // An image that is readable and lies nowhere is still worth describing.
    document.update(Json{{"width_px", pixels.width()},
                         {"height_px", pixels.height()},
                         {"channels", pixels.channels()},
                         {"georeference", nullptr},
                         {"note", error.what()}});
  }
  return document;
}

Json describe_trajectory(const std::filesystem::path& path) {
  Json document{{"kind", "trajectory"}, {"path", path.string()}};
  document.update(describe_poses(read_tum(path)));
  return document;
}

}  // namespace nadir
