// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "nadir/map_matching/cuda/device.hpp"
#include "nadir/map_matching/cuda/sinks.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir::cuda {

struct DeviceMap;

/// The backend `cuda` on any Device. It holds nothing itself: a prepared map has a device of its
/// own, with the map on it.
class DeviceBackend : public MatchingBackend {
 public:
  using MakeDevice = std::function<std::unique_ptr<Device>()>;
  explicit DeviceBackend(MakeDevice make) : make_(std::move(make)) {}

  std::shared_ptr<PreparedMap> prepare(const MapIndex& map) const override;
  std::vector<ScoreSurface> score_surfaces(const MapIndex& map,
                                           std::span<const RotatedTemplate> templates,
                                           const PixelWindow& window,
                                           const StopToken& stop = {}) const override;
  std::vector<PoseScore> score_poses(const MapIndex& map, const Template& local,
                                     std::span<const Pose2> map_from_robot,
                                     const StopToken& stop = {}) const override;

 private:
  MakeDevice make_;
};

/// A map on the device of a backend: the one that its index prepared, or a new one where another
/// backend did. `map` must outlive it.
class KeptMap {
 public:
  KeptMap(const DeviceBackend& backend, const MapIndex& map);

  std::vector<ScoreSurface> score_surfaces(std::span<const RotatedTemplate> templates,
                                           const PixelWindow& window,
                                           const StopToken& stop = {}) const;
  std::vector<PoseScore> score_poses(const Template& local,
                                     std::span<const Pose2> map_from_robot) const;
  /// The best local maxima of a search, best first, without the surfaces leaving the device.
  /// Templates are turned there too where the score is a correlation and holes take no part.
  std::vector<Place> best_places(const Template& local, std::span<const double> yaws,
                                 const PixelWindow& window, int wanted) const;
  /// Of the transforms of the last search over most of the map.
  PlaneShape shape() const;

 private:
  SurfaceJob job_over(const Box& box, const PixelWindow& window, std::size_t templates,
                      const StopToken& stop) const;

  const MapIndex& map_;
  std::shared_ptr<DeviceMap> on_device_;
};

/// Matches a small map on the backend and compares with the reference: what is wrong, or nothing.
std::string self_test(const MatchingBackend& backend);

}  // namespace nadir::cuda
