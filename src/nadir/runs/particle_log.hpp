// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <vector>

#include "nadir/localization/particle_set.hpp"

namespace nadir {

/// One particle as particles.bin and the viewer carry it.
struct LoggedParticle {
  float x = 0.0F;  ///< metres east of the anchor
  float y = 0.0F;  ///< metres north of the anchor
  float yaw = 0.0F;
  float weight = 0.0F;  ///< share of the frame's weight
};

/// Of a larger cloud every n-th particle is kept, so that no more than this are.
inline constexpr std::size_t kMostLoggedParticles = 2000;

/// The cloud as it is logged, relative to `anchor`; the weights of what is kept sum to 1.
std::vector<LoggedParticle> thinned(const ParticleSet& particles, Point2<frames::Map> anchor);

/// The whole metres next to a pose, which float32 coordinates are relative to.
Point2<frames::Map> anchor_near(const Pose2& pose);

/// Writes particles.bin (docs/formats.md): the cloud of every frame of a run. What has been
/// appended can be read at once.
class ParticleLogWriter {
 public:
  /// Throws Error (processing) where the file cannot be created.
  explicit ParticleLogWriter(std::filesystem::path file);
  /// The first frame decides the anchor. Throws Error (processing).
  void append(const ParticleSet& particles);

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
  std::optional<Point2<frames::Map>> anchor_;
};

/// Reads particles.bin, also while it grows. May be asked from several threads.
class ParticleLogReader {
 public:
  /// Throws Error (input) where the file is missing or no particle log.
  explicit ParticleLogReader(std::filesystem::path file);
  /// The cloud of the frame at this position, or nothing where the file has no such frame.
  std::optional<std::vector<LoggedParticle>> read(std::size_t frame);
  Point2<frames::Map> anchor();

 private:
  struct Extent {
    std::uint64_t offset = 0;  ///< of the first particle, bytes
    std::uint32_t count = 0;
  };

  void scan();

  std::filesystem::path file_;
  std::mutex mutex_;
  std::ifstream stream_;
  Point2<frames::Map> anchor_;
  std::uint64_t scanned_ = 0;  ///< bytes that `extents_` covers
  std::vector<Extent> extents_;
};

}  // namespace nadir
