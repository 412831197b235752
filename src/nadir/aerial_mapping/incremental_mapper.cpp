// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/incremental_mapper.hpp"

#include <utility>

namespace nadir {

class IncrementalMapper::State {
 public:
  State(PhotoSet frame, const AerialMappingOptions& options)
      : photos_(std::move(frame)), options_(options) {}
  PhotoSet photos_;
  AerialMappingOptions options_;
  AerialMap map_;
};

IncrementalMapper::IncrementalMapper(PhotoSet frame, const AerialMappingOptions& options)
    : state_(std::make_unique<State>(std::move(frame), options)) {}

IncrementalMapper::~IncrementalMapper() = default;

std::size_t IncrementalMapper::add_camera(const CameraPrior& camera) {
  auto& cameras = state_->photos_.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (cameras[i].name == camera.name) return i;
  cameras.push_back(camera);
  return cameras.size() - 1;
}

MapUpdate IncrementalMapper::add(const MappingPhoto& photo) {
  state_->photos_.photos.push_back(photo);
  return {};
}

const AerialMap& IncrementalMapper::current() const { return state_->map_; }

AerialMap IncrementalMapper::finish(const MappingProgress& progress) {
  return map_photos(state_->photos_, state_->options_, progress);
}

}  // namespace nadir
