// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/incremental_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "nadir/aerial_mapping/detail/growing_map.hpp"
#include "nadir/aerial_mapping/detail/pipeline.hpp"
#include "nadir/aerial_mapping/detail/report.hpp"
#include "nadir/aerial_mapping/ortho/orthomosaic.hpp"
#include "nadir/core/error.hpp"
#ifdef NADIR_HAS_SFM
#include "nadir/aerial_mapping/sfm/pose_start.hpp"
#endif

namespace nadir {

namespace {

constexpr std::size_t kAlwaysWhole = 5;  // photos, up to which everything is solved anew
constexpr std::size_t kWholeEvery = 8;   // and then at every so many
constexpr int kNeighbours = 7;           // a new photo is matched with

}  // namespace

class IncrementalMapper::State {
 public:
  State(PhotoSet frame, const AerialMappingOptions& options)
      : photos(std::move(frame)), options_(options), quick_(options), pipeline_(options) {
    photos.photos.clear();
    if (quick_.blend == BlendKind::kMultiBand) quick_.blend = BlendKind::kFeather;
    quick_.gps_neighbours = kNeighbours;
  }

  MapUpdate add(const MappingPhoto& photo, const StopToken& stop);
  AerialMap finish(const MappingProgress& progress, const StopToken& stop) {
    return pipeline_.run(photos, progress, stop);
  }
  const AerialMap& map() const { return map_.map(); }

  PhotoSet photos;

 private:
#ifdef NADIR_HAS_SFM
  void solve(const PhotoSet& set, const StopToken& stop);
  void remember(const PhotoSet& set, const aerial::Reconstruction& found);
  aerial::Block block(const PhotoSet& set) const;
  std::set<MapTile> draw(const PhotoSet& set, const std::string& fresh, const StopToken& stop);

  aerial::KnownPoses known_;
  std::vector<Eigen::Vector3d> points_;
  double ground_ = 0.0;
  bool by_positions_ = false;
  bool everything_moved_ = false;
#endif
  AerialMappingOptions options_;
  AerialMappingOptions quick_;
  aerial::Pipeline pipeline_;
  aerial::GrowingMap map_;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  int version_ = 0;
};

#ifdef NADIR_HAS_SFM

void IncrementalMapper::State::remember(const PhotoSet& set, const aerial::Reconstruction& found) {
  known_.poses.clear();
  for (std::size_t i = 0; i < set.photos.size(); ++i)
    if (found.model.poses[i].known) known_.poses[set.photos[i].name] = found.model.poses[i];
  known_.cameras = found.model.cameras;
  known_.readout_s = found.model.readout_s;
  const aerial::Block block = aerial::block_of(found);
  points_ = block.points;
  ground_ = block.ground;
  by_positions_ = found.scale_source == ScaleSource::kPositions ||
                  found.scale_source == ScaleSource::kControlPoints;
}

void IncrementalMapper::State::solve(const PhotoSet& set, const StopToken& stop) {
  aerial::PhotoGraph& graph = pipeline_.graph();
  graph.detect(set, {}, stop);
  const aerial::PhotoPairs pairs = aerial::choose_pairs(set.photos, quick_.gps_neighbours);
  graph.match(set, pairs, {}, stop);
  const auto verified = graph.verified(set, pairs);
  const auto features = graph.features(set);
  const std::size_t count = set.photos.size();
  everything_moved_ = !by_positions_ || count <= kAlwaysWhole || count % kWholeEvery == 0;
  try {
    remember(set, everything_moved_
                      ? aerial::reconstruct(set, features, verified, quick_, stop)
                      : aerial::reconstruct_next(set, features, verified, quick_, known_, stop));
  } catch (const Error& error) {
    // Too few photos join as yet: they stay provisional.
    if (error.kind() != ErrorKind::kNoResult) throw;
    everything_moved_ = false;
  }
}

/// Photos with poses, and, provisionally, those that their priors place.
aerial::Block IncrementalMapper::State::block(const PhotoSet& set) const {
  aerial::Block block;
  block.points = points_;
  block.ground = ground_;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    aerial::View view;
    view.photo = i;
    const std::size_t camera = set.photos[i].camera;
    view.camera = camera < known_.cameras.size()
                      ? known_.cameras[camera]
                      : aerial::start_model(set, {}, {}, 0).cameras[camera];
    const auto found = known_.poses.find(set.photos[i].name);
    const PhotoPrior& prior = set.photos[i].prior;
    if (found != known_.poses.end()) {
      view.camera_from_map = found->second.camera_from_map;
      view.centre = found->second.centre;
      view.flown = found->second.flown;
    } else if (const auto pose = aerial::pose_of_prior(prior)) {
      if (known_.poses.empty()) {
        if (!prior.relative_altitude_m) continue;
        block.ground = pose->centre.z() - *prior.relative_altitude_m;
      } else if (!by_positions_) {
        continue;  // the frame is not that of the positions
      }
      view.camera_from_map = pose->camera_from_map;
      view.centre = pose->centre;
      view.provisional = true;
    } else {
      continue;
    }
    block.views.push_back(view);
  }
  return block;
}

std::set<MapTile> IncrementalMapper::State::draw(const PhotoSet& set, const std::string& fresh,
                                                 const StopToken& stop) {
  aerial::Block all = block(set);
  aerial::Block part = all;
  if (!everything_moved_) {
    const auto newest = std::find_if(all.views.begin(), all.views.end(), [&](const auto& view) {
      return set.photos[view.photo].name == fresh;
    });
    if (newest == all.views.end()) return {};
    // Only what the new photo sees is drawn again, from it and its neighbours.
    const Eigen::Vector3d centre = newest->centre;
    const double reach =
        2.0 * (centre.z() - all.ground) * newest->camera.width / std::max(1.0, newest->camera.fx);
    std::erase_if(part.views, [&](const aerial::View& view) {
      return (view.centre - centre).head<2>().norm() > reach;
    });
    aerial::Block footprint;
    footprint.ground = all.ground;
    footprint.views = {*newest};
    footprint.views[0].provisional = true;
    const aerial::Extent extent = aerial::extent_of(footprint, quick_);
    AerialMap piece;
    aerial::make_orthomosaic(set, part, aerial::ground_of(part, extent, quick_), extent, quick_, {},
                             stop, piece);
    return map_.put(piece, anchor_, false);
  }
  if (part.views.empty()) return {};
  const aerial::Extent extent = aerial::extent_of(part, quick_);
  const aerial::Ground ground = aerial::ground_of(part, extent, quick_);
  AerialMap whole;
  aerial::make_orthomosaic(set, part, ground, extent, quick_, {}, stop, whole);
  return map_.put(whole, anchor_, true);
}

MapUpdate IncrementalMapper::State::add(const MappingPhoto& photo, const StopToken& stop) {
  photos.photos.push_back(photo);
  if (photos.photos.size() == 1 && photo.prior.position)
    // Whole multiples of 100 m, as for a block (pipeline.cpp).
    anchor_ = (photo.prior.position->vector() / 100.0).array().round().matrix() * 100.0;
  aerial::LocalSet local;
  try {
    local = aerial::localise(photos, &anchor_);
  } catch (...) {
    photos.photos.pop_back();
    throw;
  }
  const PhotoSet& set = local.set;
  solve(set, stop);
  const std::set<MapTile> changed = draw(set, photo.name, stop);
  AerialMap poses;
  const aerial::Block now = block(set);
  for (const aerial::View& view : now.views) {
    if (view.provisional) continue;
    poses.poses.push_back(aerial::pose_of(view, set.photos[view.photo].name));
    poses.poses.back().map_from_camera.translation += anchor_;
  }
  map_.set_poses(std::move(poses.poses), set.crs);

  MapUpdate update;
  update.version = ++version_;
  update.changed_tiles.assign(changed.begin(), changed.end());
  update.registered = known_.poses.contains(photo.name);
  update.provisional = !update.registered;
  update.photos = static_cast<int>(known_.poses.size());
  return update;
}

#else

MapUpdate IncrementalMapper::State::add(const MappingPhoto& photo, const StopToken& /*stop*/) {
  photos.photos.push_back(photo);
  MapUpdate update;
  update.version = ++version_;
  update.provisional = true;
  return update;
}

#endif

IncrementalMapper::IncrementalMapper(PhotoSet frame, const AerialMappingOptions& options)
    : state_(std::make_unique<State>(std::move(frame), options)) {}

IncrementalMapper::~IncrementalMapper() = default;

std::size_t IncrementalMapper::add_camera(const CameraPrior& camera) {
  auto& cameras = state_->photos.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (cameras[i].name == camera.name) return i;
  cameras.push_back(camera);
  return cameras.size() - 1;
}

MapUpdate IncrementalMapper::add(const MappingPhoto& photo, const StopToken& stop) {
  return state_->add(photo, stop);
}

const AerialMap& IncrementalMapper::current() const { return state_->map(); }

AerialMap IncrementalMapper::finish(const MappingProgress& progress, const StopToken& stop) {
  return state_->finish(progress, stop);
}

}  // namespace nadir
