// SPDX-License-Identifier: Apache-2.0
#include "follow_job.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "cli/interrupt.hpp"
#include "cli/verdict.hpp"
#include "nadir/aerial_mapping/incremental_mapper.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/image_file_check.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/photos/photo_file.hpp"
#include "nadir/io/shell.hpp"
#include "nadir/pipelines/flight/growing_map_file.hpp"
#include "nadir/pipelines/flight/photo_pixels.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/pipelines/threads.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Finds files of a folder that have come and whose size has stood still.
class Arrivals {
 public:
  explicit Arrivals(fs::path folder) : folder_(std::move(folder)) {}

  /// The next whole photos, by name.
  std::vector<fs::path> next() {
    std::vector<fs::path> ready;
    for (const fs::path& file : files()) {
      if (taken_.contains(file)) continue;
      std::error_code gone;
      const auto size = fs::file_size(file, gone);
      if (gone || size == 0) continue;
      if (const auto bad = refused_.find(file); bad != refused_.end() && bad->second == size) {
        continue;
      }
      const auto [seen, added] = seen_.try_emplace(file, Seen{size, Clock::now()});
      if (seen->second.size != size) seen->second = {size, Clock::now()};
      if (Clock::now() - seen->second.since < kStable) continue;
      ready.push_back(file);
      taken_.insert(file);
    }
    return ready;
  }

  /// The photo was not whole: it comes again once its size has changed.
  void refuse(const fs::path& file) {
    taken_.erase(file);
    refused_[file] = seen_.at(file).size;
  }

 private:
  struct Seen {
    std::uintmax_t size;
    Clock::time_point since;
  };
  static constexpr std::chrono::milliseconds kStable{500};

  std::vector<fs::path> files() const {
    try {
      return photo_files(folder_);
    } catch (const Error&) {
      return {};  // none yet
    }
  }

  fs::path folder_;
  std::map<fs::path, Seen> seen_;
  std::set<fs::path> taken_;
  std::map<fs::path, std::uintmax_t> refused_;
};

/// The map that grows, and what is known of its flight.
class Growing {
 public:
  Growing(const MapOptions& options, const AerialMappingOptions& stage, const CommonOptions& common)
      : options_(options), stage_(stage), common_(common), pixels_(stage.max_image_px) {
    if (!options.flight.positions.empty()) positions_ = read_positions(options.flight.positions);
  }

  /// False where the photo cannot be read, or not yet.
  bool add(const fs::path& file) {
    std::vector<FlightPhoto> photo;
    try {
      photo.push_back({file, read_photo_metadata(file)});
      check_image_is_whole(file, read_file(file));
    } catch (const Error& error) {
      skip(error.what());
      return false;
    }
    ++input_.found;
    apply_positions(positions_, photo);
    std::vector<PhotoMetadata> metadata{photo.front().metadata};
    const FlightCameras cameras = cameras_of(metadata, stage_.max_image_px);
    begin(metadata.front(), cameras.cameras.front());
    add_to_map(file, metadata.front(), cameras);
    return true;
  }

  bool empty() const { return input_.photos.empty(); }
  int photos() const { return static_cast<int>(input_.photos.size()); }
  const FlightInput& input() const { return input_; }
  AerialMap finish() { return mapper_->finish({}, interrupt_token()); }
  /// The map as it stands.
  const AerialMap& current() const { return mapper_->current(); }
  /// Says that this map will not change any more; every tile may have changed.
  void write_final(const AerialMap& map) const {
    write_file(update_file(options_.map), json_text(update_of(map, version_ + 1, true), 1) + "\n");
  }

 private:
  void skip(const std::string& why) {
    input_.warnings.push_back(why + "; skipped");
    print_note(input_.warnings.back(), common_.quiet);
  }

  /// The first photo fixes the frame: pixels never shift under who uses the map.
  void begin(const PhotoMetadata& photo, const CameraPrior& camera) {
    if (mapper_) return;
    const double pixel = options_.flight.metres_per_pixel;
    if (photo.position) input_.frame = MetricFrame::around({*photo.position});
    if (!input_.frame && !photo.relative_altitude_m && !(pixel > 0.0)) {
      throw Error(ErrorKind::kUsage, "no position: the map will have no scale", photo.name,
                  "give --metres-per-pixel or --positions");
    }
    if (input_.frame) input_.set.crs = input_.frame->crs();
    if (pixel > 0.0) input_.set.metres_per_photo_pixel = pixel * photo.width / camera.width;
    mapper_ = std::make_unique<IncrementalMapper>(input_.set, stage_);
  }

  void add_to_map(const fs::path& file, const PhotoMetadata& metadata,
                  const FlightCameras& cameras) {
    const Stopwatch stopwatch;
    MappingPhoto photo;
    photo.name = metadata.name;
    photo.camera = mapper_->add_camera(cameras.cameras.front());
    photo.prior = prior_of(metadata, input_.frame ? &*input_.frame : nullptr);
    photo.load = pixels_.loader(file);
    const MapUpdate update = mapper_->add(photo, interrupt_token());
    input_.photos.push_back(metadata);
    input_.set.photos.push_back(std::move(photo));
    const AerialMap& map = mapper_->current();
    if (map.ortho.width() > 0) write_orthomosaic(options_.map, map.ortho);
    write_update(update, map, stopwatch.seconds());
  }

  Json update_of(const AerialMap& map, int version, bool final) const {
    return {{"version", version},
            {"final", final},
            {"photos", photos()},
            {"west", map.ortho.geo.west},
            {"north", map.ortho.geo.north},
            {"resolution_m", map.ortho.geo.resolution},
            {"width_px", map.ortho.width()},
            {"height_px", map.ortho.height()}};
  }

  void write_update(const MapUpdate& update, const AerialMap& map, double seconds) {
    version_ = update.version;
    Json document = update_of(map, version_, false);
    document["registered"] = update.registered;
    document["provisional"] = update.provisional;
    document["tile_px"] = kMapTilePx;
    document["changed_tiles"] = Json::array();
    for (const MapTile& tile : update.changed_tiles) {
      document["changed_tiles"].push_back({tile.x, tile.y});
    }
    write_file(update_file(options_.map), json_text(document, 1) + "\n");
    print_note(
        fmt::format("{}: version {}, {}{} tiles changed, {:.1f} s", input_.photos.back().name,
                    update.version, update.provisional ? "provisional, " : "",
                    update.changed_tiles.size(), seconds),
        common_.quiet);
  }

  const MapOptions& options_;
  const AerialMappingOptions& stage_;
  const CommonOptions& common_;
  PhotoPixels pixels_;
  std::vector<ListedPosition> positions_;
  FlightInput input_;
  std::unique_ptr<IncrementalMapper> mapper_;
  int version_ = 0;
};

/// Takes photos until there are enough, none comes any more, or the user stops. Throws Stopped
/// where that happens while a photo is taken up.
void take_photos(const MapOptions& options, Growing& growing) {
  constexpr std::chrono::milliseconds kLook{200};
  Arrivals arrivals(options.flight.photos);
  Clock::time_point last = Clock::now();
  const std::chrono::duration<double> idle(options.idle_s);
  while (!interrupted() && Clock::now() - last < idle) {
    for (const fs::path& file : arrivals.next()) {
      if (interrupted() || (options.photos > 0 && growing.photos() >= options.photos)) return;
      if (!growing.add(file)) arrivals.refuse(file);
      last = Clock::now();
    }
    if (options.photos > 0 && growing.photos() >= options.photos) return;
    std::this_thread::sleep_for(kLook);
  }
}

/// False where the user ended it: within a photo it stays out of the map.
bool follow_to_the_end(const MapOptions& options, Growing& growing) {
  interrupt_is_the_end(true);
  try {
    take_photos(options, growing);
  } catch (const Stopped&) {
  }
  interrupt_is_the_end(interrupted());
  return !interrupted();
}

/// The map stays as the last photo left it: to adjust all photos together takes longer than who
/// ends a program waits.
int end_here(const MapOptions& options, const CommonOptions& common, const Growing& growing) {
  if (!growing.empty()) growing.write_final(growing.current());
  const std::string again = "nadir " + shell_line({"map", options.flight.photos.string(), "-o",
                                                   options.map.string(), "--overwrite"});
  const std::string text =
      growing.empty() ? "stopped before the first photo\n"
                      : fmt::format(
                            "stopped after {} photos; {} is as the last of them left it. `{}` "
                            "adjusts all of them together\n",
                            growing.photos(), options.map.string(), again);
  print_result({{"map", options.map.string()}, {"photos", growing.photos()}, {"adjusted", false}},
               text, Verdict{}, common);
  return 0;
}

}  // namespace

int follow_flight(const MapOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  const ThreadLimit limit(common.threads);
  const EffectiveOptions effective(options.sources);
  require_new(options.map, common);
  require_room_for_sisters(options.map);
  if (!options.flight.control_points.empty() || !options.flight.poses.empty() ||
      options.sfm != "nadir") {
    throw Error(ErrorKind::kUsage, "a map in the making takes no --gcp, --poses or --sfm",
                "--follow", "map the photos once more without --follow when the flight is over");
  }
  if (!is_folder(options.flight.photos)) {
    throw Error(ErrorKind::kInput, "there is no such folder", options.flight.photos.string());
  }
  make_folder_of(options.map);
  Growing growing(options, effective.aerial_mapping(), common);
  print_note("waiting for photos in " + options.flight.photos.string(), common.quiet);
  if (!follow_to_the_end(options, growing)) return end_here(options, common, growing);
  if (growing.empty()) {
    stop_if_interrupted();
    throw Error(ErrorKind::kInput, "no photo came", options.flight.photos.string(),
                "give a longer --idle");
  }
  const AerialMap map = growing.finish();
  const int code = write_map(map, growing.input(), options, common);
  growing.write_final(map);
  return code;
}

}  // namespace nadir::cli
