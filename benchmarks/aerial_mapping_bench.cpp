// SPDX-License-Identifier: Apache-2.0
// Aerial mapping of a folder of photos: what became of them, errors and CPU seconds by stage.
//
//   aerial_mapping_bench PHOTOS [--picture FILE.png] [--threads N] [--no-gps] [--set name=value]
//                        [--incremental]
//
// --no-gps forgets positions, gimbals, altitudes and focal lengths: the photos of a kite.

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/incremental_mapper.hpp"
#include "nadir/aerial_mapping/mapping.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/photos/photo_file.hpp"

namespace {

using namespace nadir;
namespace fs = std::filesystem;

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

long peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

struct Arguments {
  fs::path folder;
  fs::path picture;
  int threads = 2;
  bool no_gps = false;
  bool incremental = false;
  AerialMappingOptions options;
};

Arguments arguments_of(const std::vector<std::string>& words) {
  Arguments arguments;
  OptionTable table;
  declare(table, arguments.options);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto value = [&] { return i + 1 < words.size() ? words[++i] : std::string{}; };
    if (words[i] == "--picture") {
      arguments.picture = value();
    } else if (words[i] == "--threads") {
      arguments.threads = std::stoi(value());
    } else if (words[i] == "--no-gps") {
      arguments.no_gps = true;
    } else if (words[i] == "--incremental") {
      arguments.incremental = true;
    } else if (words[i] == "--set") {
      const std::string pair = value();
      const auto equals = pair.find('=');
      table.set("aerial_mapping." + pair.substr(0, equals), pair.substr(equals + 1));
    } else {
      arguments.folder = words[i];
    }
  }
  return arguments;
}

void add_priors(const PhotoMetadata& metadata, const MetricFrame& frame, PhotoPrior& prior) {
  prior.position = frame.to_map(*metadata.position);
  prior.horizontal_sigma_m = metadata.position->horizontal_sigma_m;
  prior.vertical_sigma_m = metadata.position->vertical_sigma_m;
  prior.relative_altitude_m = metadata.relative_altitude_m;
  if (!metadata.gimbal) return;
  constexpr double kDegree = std::numbers::pi / 180.0;
  prior.attitude = PhotoAttitude{
      frame.yaw_of_true_heading(metadata.gimbal->yaw_deg * kDegree, *metadata.position),
      metadata.gimbal->pitch_deg * kDegree, metadata.gimbal->roll_deg * kDegree};
}

PhotoSet read(const Arguments& arguments) {
  std::vector<PhotoMetadata> all;
  std::vector<GeodeticPosition> positions;
  const std::vector<fs::path> files = photo_files(arguments.folder);
  for (const fs::path& file : files) {
    all.push_back(read_photo_metadata(file));
    if (all.back().position) positions.push_back(*all.back().position);
  }
  std::optional<MetricFrame> frame;
  if (!positions.empty() && !arguments.no_gps) frame = MetricFrame::around(positions);
  PhotoSet set;
  const int limit = arguments.options.max_image_px;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PhotoMetadata& metadata = all[i];
    MappingPhoto photo;
    photo.name = metadata.name;
    photo.load = [file = files[i], limit] { return read_photo(file, limit).image; };
    if (metadata.position && frame) add_priors(metadata, *frame, photo.prior);
    photo.prior.taken_at = metadata.taken_at;
    if (metadata.exposure_s && metadata.iso && metadata.f_number)
      photo.prior.exposure =
          *metadata.exposure_s * *metadata.iso / (*metadata.f_number * *metadata.f_number);
    const Raster<std::uint8_t> pixels = photo.load();
    CameraPrior camera;
    camera.width = pixels.width();
    camera.height = pixels.height();
    camera.name = metadata.make + " " + metadata.model + " " + std::to_string(pixels.width()) +
                  "x" + std::to_string(pixels.height());
    PhotoMetadata tags = metadata;
    if (arguments.no_gps) {
      tags.make.clear();
      tags.focal_length_35mm.reset();
    }
    camera.focal = focal_prior(tags, camera.width);
    photo.camera = set.cameras.size();
    for (std::size_t k = 0; k < set.cameras.size(); ++k)
      if (set.cameras[k].name == camera.name) photo.camera = k;
    if (photo.camera == set.cameras.size()) set.cameras.push_back(camera);
    set.photos.push_back(std::move(photo));
  }
  if (frame) set.crs = frame->crs();
  return set;
}

void print(const AerialMap& map) {
  const AdjustmentReport& r = map.report;
  std::printf("photos %zu, registered %d, groups %zu, points %d, observations %d\n",
              r.photos.size(), r.registered, r.components.size(), r.points, r.observations);
  std::printf("reprojection %.3f px, ground %.2f m below, photo pixel %.4f m\n", r.reprojection_px,
              r.ground_below_camera_m, r.photo_pixel_m);
  if (r.position_rms_m)
    std::printf("position residual rms %.2f %.2f %.2f m, horizontal %.2f m\n",
                (*r.position_rms_m)[0], (*r.position_rms_m)[1], (*r.position_rms_m)[2],
                *r.position_residual_m);
  std::printf("time offset %.3f s, scale from %s sigma %.4f, heading sigma %.2f deg\n",
              r.time_offset_s.value_or(0.0), to_string(r.scale_source).c_str(), r.scale_sigma,
              r.heading_sigma_deg);
  for (const CameraReport& c : r.cameras)
    std::printf("camera %s: focal %.1f px (prior %.1f, %s), sigma %.4f, k1 %.4f k2 %.4f\n",
                c.name.c_str(), c.model.fx, c.prior_focal_px, c.focal_source.c_str(), c.focal_sigma,
                c.model.k1, c.model.k2);
  for (const PhotoReport& p : r.photos)
    std::printf("  %s %s %5d obs %.2f px, %.2f m, tilt %.1f, gain %.3f\n", p.name.c_str(),
                p.registered ? "in " : "OUT", p.observations, p.reprojection_px,
                p.ground_below_camera_m, p.off_nadir_deg, p.gain);
  for (const std::string& warning : r.warnings) std::printf("warning: %s\n", warning.c_str());
  for (const auto& [stage, seconds] : r.seconds)
    std::printf("  %-12s %7.2f s\n", stage.c_str(), seconds);
  std::printf("map %d x %d px at %.3f m\n", map.ortho.width(), map.ortho.height(),
              map.ortho.geo.resolution);
}

void write(const fs::path& file, const AerialMap& map) {
  Raster<std::uint8_t> rgba(map.ortho.width(), map.ortho.height(), 0, 4);
  for (int row = 0; row < rgba.height(); ++row)
    for (int column = 0; column < rgba.width(); ++column) {
      for (int k = 0; k < 3; ++k) rgba.at(column, row, k) = map.ortho.image.at(column, row, k);
      rgba.at(column, row, 3) = map.ortho.valid.at(column, row) != 0 ? 255 : 0;
    }
  write_png(file, rgba);
}

AerialMap map_one_by_one(const PhotoSet& set, const AerialMappingOptions& options) {
  PhotoSet frame = set;
  frame.photos.clear();
  IncrementalMapper mapper(frame, options);
  for (const MappingPhoto& photo : set.photos) {
    const double cpu = cpu_seconds();
    const auto start = std::chrono::steady_clock::now();
    const MapUpdate update = mapper.add(photo);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    std::printf("add %s: version %d, %s, %zu tiles, %.2f s wall, %.2f s CPU\n", photo.name.c_str(),
                update.version, update.provisional ? "provisional" : "registered",
                update.changed_tiles.size(), wall.count(), cpu_seconds() - cpu);
  }
  return mapper.finish();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = arguments_of({argv + 1, argv + argc});
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(arguments.threads));
    const PhotoSet set = read(arguments);
    const double before = cpu_seconds();
    const AerialMap map = arguments.incremental ? map_one_by_one(set, arguments.options)
                                                : map_photos(set, arguments.options);
    print(map);
    std::printf("CPU %.1f s, peak %ld MiB\n", cpu_seconds() - before, peak_mib());
    if (!arguments.picture.empty()) write(arguments.picture, map);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
