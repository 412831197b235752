// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/detail/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include "nadir/aerial_mapping/detail/report.hpp"
#include "nadir/aerial_mapping/flight.hpp"
#include "nadir/aerial_mapping/ortho/cells.hpp"
#include "nadir/aerial_mapping/ortho/orthomosaic.hpp"
#include "nadir/core/error.hpp"

namespace nadir::aerial {
namespace {

void check(const PhotoSet& photos) {
  if (photos.photos.size() > kMostLabels)
    throw Error(ErrorKind::kUsage,
                std::to_string(photos.photos.size()) + " photos are more than a map can name, " +
                    std::to_string(kMostLabels),
                {}, "map the flight in parts");
  std::set<std::string> names;
  for (const MappingPhoto& photo : photos.photos) {
    if (!names.insert(photo.name).second)
      throw Error(ErrorKind::kUsage, "two photos have the same name", photo.name);
    if (photo.camera >= photos.cameras.size())
      throw Error(ErrorKind::kUsage, "the photo's camera is not in the set", photo.name);
    const CameraPrior& camera = photos.cameras[photo.camera];
    if (camera.width < 16 || camera.height < 16)
      throw Error(ErrorKind::kUsage, "the camera has no size", camera.name);
  }
}

/// Middle of the known positions, whole metres: a multiple of any sensible resolution.
Eigen::Vector3d anchor_of(const PhotoSet& photos) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  const auto include = [&](const Eigen::Vector3d& p) {
    sum += p;
    count += 1.0;
  };
  for (const MappingPhoto& photo : photos.photos) {
    if (photo.prior.position) include(photo.prior.position->vector());
    if (photo.pose) include(photo.pose->map_from_camera.translation);
  }
  if (count == 0.0)
    for (const GroundControlPoint& point : photos.control_points) include(point.position.vector());
  if (count == 0.0) return sum;
  // Multiples of 100 m: the same pixels whatever photos there are, in nearly every case.
  return (sum / count / 100.0).array().round().matrix() * 100.0;
}

/// Measures the stages.
class Stopwatch {
 public:
  explicit Stopwatch(AdjustmentReport& report) : report_(report) {}
  void stage(const std::string& name) {
    const auto now = std::chrono::steady_clock::now();
    report_.seconds.emplace_back(name, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  AdjustmentReport& report_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

bool all_posed(const PhotoSet& set) {
  return std::all_of(set.photos.begin(), set.photos.end(),
                     [](const MappingPhoto& photo) { return photo.pose.has_value(); });
}

#ifndef NADIR_HAS_SFM
/// Poses as they are given, on a plane below them at the height that the photos say.
Block given_block(const PhotoSet& set) {
  Block block;
  std::vector<double> grounds;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    const PhotoPose& pose = *set.photos[i].pose;
    View view;
    view.photo = i;
    view.camera = pose.camera;
    view.camera_from_map =
        pose.map_from_camera.rotation.normalized().toRotationMatrix().transpose();
    view.centre = pose.map_from_camera.translation;
    view.flown = pose.flown_in_readout;
    block.views.push_back(view);
    if (set.photos[i].prior.relative_altitude_m)
      grounds.push_back(view.centre.z() - *set.photos[i].prior.relative_altitude_m);
  }
  if (grounds.empty())
    throw Error(ErrorKind::kUsage, "nothing says how high the photos were taken above the ground",
                {}, "this build triangulates no points (NADIR_WITH_SFM)");
  std::nth_element(grounds.begin(),
                   grounds.begin() + static_cast<std::ptrdiff_t>(grounds.size() / 2),
                   grounds.end());
  block.ground = grounds[grounds.size() / 2];
  return block;
}
#endif

#ifdef NADIR_HAS_SFM
/// Blurred photos hold the block together as the others do, but show it only where no sharp one
/// does.
void set_blurred(const PhotoSet& set, const std::vector<std::size_t>& blurred, Block& block,
                 AdjustmentReport& report) {
  if (blurred.empty()) return;
  std::vector<std::string> names;
  for (const std::size_t i : blurred) names.push_back(set.photos[i].name);
  for (View& view : block.views)
    view.blurred = std::find(blurred.begin(), blurred.end(), view.photo) != blurred.end();
  report.warnings.push_back(listed(names) +
                            ": blurred; left out where another photo sees the ground");
}
#endif

void shift_map(AerialMap& map, const Eigen::Vector3d& anchor) {
  map.ortho.geo.west += anchor.x();
  map.ortho.geo.north += anchor.y();
  map.surface.geo.west += anchor.x();
  map.surface.geo.north += anchor.y();
  for (float& z : map.surface.height_m.values()) z = static_cast<float>(z + anchor.z());
  for (PhotoPose& pose : map.poses) pose.map_from_camera.translation += anchor;
}

}  // namespace

LocalSet localise(const PhotoSet& photos, const Eigen::Vector3d* anchor) {
  check(photos);
  LocalSet local{photos, anchor != nullptr ? *anchor : anchor_of(photos)};
  std::sort(local.set.photos.begin(), local.set.photos.end(),
            [](const MappingPhoto& a, const MappingPhoto& b) { return a.name < b.name; });
  std::sort(local.set.control_points.begin(), local.set.control_points.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  const auto move = [&](Point3<frames::Map>& p) {
    p = Point3<frames::Map>::from(p.vector() - local.anchor);
  };
  for (MappingPhoto& photo : local.set.photos) {
    if (photo.prior.position) move(*photo.prior.position);
    if (photo.pose) photo.pose->map_from_camera.translation -= local.anchor;
  }
  for (GroundControlPoint& point : local.set.control_points) move(point.position);
  return local;
}

#ifdef NADIR_HAS_SFM
Pipeline::Pipeline(const AerialMappingOptions& options, MappingStore* store)
    : options_(options), graph_(options, store) {}
#else
Pipeline::Pipeline(const AerialMappingOptions& options, MappingStore* /*store*/)
    : options_(options) {}
#endif

AerialMap Pipeline::run(const PhotoSet& photos, const MappingProgress& progress,
                        const StopToken& stop) {
  if (photos.photos.size() < 2)
    throw Error(ErrorKind::kNoResult, "a map needs two photos at least");
  const LocalSet local = localise(photos);
  const PhotoSet& set = local.set;
  const auto tell = [&](const char* stage, double share) {
    if (progress) progress(stage, share);
  };
  AerialMap map;
  Stopwatch watch(map.report);
  const bool posed = all_posed(set);
#ifdef NADIR_HAS_SFM
  graph_.detect(
      set, [&](double share) { tell("features", share); }, stop);
  watch.stage("features");
  const PhotoPairs pairs = choose_pairs(set.photos, options_.gps_neighbours);
  graph_.match(
      set, pairs, [&](double share) { tell("matching", share); }, stop);
  watch.stage("matching");
  const auto verified = graph_.verified(set, pairs);
  tell("adjustment", 0.0);
  const Reconstruction found =
      posed ? reconstruct_posed(set, graph_.features(set), verified, options_, stop)
            : reconstruct(set, graph_.features(set), verified, options_, stop);
  tell("adjustment", 1.0);
  watch.stage("adjustment");
  Block block = block_of(found);
  set_blurred(set, graph_.blurred(set), block, map.report);
#else
  if (!posed)
    throw Error(ErrorKind::kUsage, "this build finds no poses by itself (NADIR_WITH_SFM)", {},
                "give the photos' poses");
  Block block = given_block(set);
#endif
  sweep_for_points(set, block, options_, stop);
  const Extent extent = extent_of(block, options_);
  const Ground ground = ground_of(block, extent, options_);
  stop.check();
  tell("surface", 1.0);
  watch.stage("surface");
  make_orthomosaic(
      set, block, ground, extent, options_,
      [&](const std::string& stage, double share) { tell(stage.c_str(), share); }, stop, map);
  watch.stage("orthomosaic");
#ifdef NADIR_HAS_SFM
  fill_report(set, found, verified, options_, map.report);
#endif
  stop.check();
  fill_views(set, block, ground, map);
  shift_map(map, local.anchor);
  return map;
}

}  // namespace nadir::aerial
