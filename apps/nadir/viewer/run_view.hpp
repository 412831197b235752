// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "cli/streams.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/maps/map_tiles.hpp"
#include "nadir/localizer.hpp"
#include "nadir/runs/particle_log.hpp"
#include "viewer/view_frames.hpp"

namespace nadir::cli {

/// Where a run was made, for the pictures that belong to it.
struct RunSources {
  /// Empty where there is none: then no local map, truth, odometry or heat map is shown.
  std::filesystem::path site;
  std::filesystem::path map;
};

/// A run as the viewer sees it, finished or still growing: frames, particles, local maps, score
/// heat maps and the tiles of the map. May be asked from several threads.
class RunView {
 public:
  /// An empty run that will grow by add(). Throws Error (input) where site or map cannot be read.
  RunView(RunSources sources, const LocalizerOptions& options, std::filesystem::path particle_file,
          bool live);
  /// A finished run. Where the manifest's site or map has moved, `sources` says where to; else they
  /// are empty. Throws Error (input).
  static std::unique_ptr<RunView> open(const std::filesystem::path& run, RunSources sources);

  /// Waits for nobody who asks: what they are told is put together from copies.
  void add(ViewFrame frame);
  void finish();

  /// The whole run but for particles and pictures: see docs/viewer.md, /api/run.
  Json document() const;
  std::optional<std::vector<LoggedParticle>> particles(std::size_t frame) const;
  /// The local map of a frame, PNG with alpha, and where it lies in the robot frame.
  struct LocalMapImage {
    EncodedImage image;
    GeoReference geo;
    int width = 0;
    int height = 0;
  };
  std::optional<LocalMapImage> local_map(std::size_t frame) const;
  /// Scores around the estimate of a frame, at its heading: geo, size, range, and a PNG.
  std::optional<Json> heat_map(std::size_t frame) const;
  MapTiles& tiles() const { return *tiles_; }
  bool live() const;
  std::size_t size() const;

 private:
  std::optional<ViewFrame> frame_at(std::size_t frame) const;
  std::vector<ViewFrame> frames() const;
  ParticleLogReader* particle_log() const;
  Json odometry_track(const std::vector<ViewFrame>& frames) const;

  RunSources sources_;
  Sequence sequence_;
  LocalizerOptions options_;
  std::filesystem::path particle_file_;
  std::unique_ptr<MapTiles> tiles_;
  std::string settings_ = "{}";  ///< what the manifest says, as JSON
  mutable std::mutex mutex_;     ///< of the next three, and held for microseconds
  std::vector<ViewFrame> frames_;
  bool live_ = false;
  std::unique_ptr<ParticleLogReader> particles_;  ///< stays, once it is there
  mutable std::mutex index_mutex_;
  mutable std::unique_ptr<MapIndex> index_;  ///< made when the first heat map is asked for
};

}  // namespace nadir::cli
