// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/detail/growing_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nadir::aerial {
namespace {

template <class T>
Raster<T> moved(const Raster<T>& from, int width, int height, int left, int top, T fill,
                int channels) {
  Raster<T> to(width, height, fill, channels);
  for (int row = 0; row < from.height(); ++row)
    std::copy(from.row(row).begin(), from.row(row).end(),
              to.row(row + top).begin() + static_cast<std::ptrdiff_t>(left) * channels);
  return to;
}

MapTile tile_of(long column, long north) {
  const auto floor_div = [](long a) {
    return static_cast<int>(std::floor(static_cast<double>(a) / kMapTilePx));
  };
  return {floor_div(column), floor_div(north)};
}

}  // namespace

void GrowingMap::grow_to(long west, long north, long east, long south, double resolution) {
  const bool fresh = map_.ortho.image.empty();
  const long new_west = fresh ? west : std::min(west, west_);
  const long new_north = fresh ? north : std::max(north, north_);
  const long new_east = fresh ? east : std::max(east, west_ + map_.ortho.width());
  const long new_south = fresh ? south : std::min(south, north_ - map_.ortho.height());
  const auto width = static_cast<int>(new_east - new_west);
  const auto height = static_cast<int>(new_north - new_south);
  const auto left = static_cast<int>(fresh ? 0 : west_ - new_west);
  const auto top = static_cast<int>(fresh ? 0 : new_north - north_);
  if (!fresh && width == map_.ortho.width() && height == map_.ortho.height()) return;
  map_.ortho.image = moved<std::uint8_t>(map_.ortho.image, width, height, left, top, 0, 3);
  map_.ortho.valid = moved<std::uint8_t>(map_.ortho.valid, width, height, left, top, 0, 1);
  map_.view_count = moved<std::uint8_t>(map_.view_count, width, height, left, top, 0, 1);
  map_.quality = moved<float>(map_.quality, width, height, left, top, 0.0F, 1);
  map_.source = Raster<std::uint16_t>(width, height, 65535);
  map_.ortho.geo.resolution = resolution;
  west_ = new_west;
  north_ = new_north;
}

std::set<MapTile> GrowingMap::put(const AerialMap& piece, const Eigen::Vector3d& anchor,
                                  bool replace) {
  std::set<MapTile> changed;
  const double resolution = piece.ortho.geo.resolution;
  const long west = std::lround(piece.ortho.geo.west / resolution);
  const long north = std::lround(piece.ortho.geo.north / resolution);
  grow_to(west, north, west + piece.ortho.width(), north - piece.ortho.height(), resolution);
  if (replace) {
    std::fill(map_.ortho.valid.values().begin(), map_.ortho.valid.values().end(), 0);
    std::fill(map_.quality.values().begin(), map_.quality.values().end(), 0.0F);
    std::fill(map_.view_count.values().begin(), map_.view_count.values().end(), 0);
  }
  const auto left = static_cast<int>(west - west_);
  const auto top = static_cast<int>(north_ - north);
  for (int row = 0; row < piece.ortho.height(); ++row)
    for (int column = 0; column < piece.ortho.width(); ++column) {
      if (piece.ortho.valid.at(column, row) == 0) continue;
      for (int channel = 0; channel < 3; ++channel)
        map_.ortho.image.at(left + column, top + row, channel) =
            piece.ortho.image.at(column, row, channel);
      map_.ortho.valid.at(left + column, top + row) = 255;
      map_.view_count.at(left + column, top + row) = piece.view_count.at(column, row);
      map_.quality.at(left + column, top + row) = piece.quality.at(column, row);
      if (column % 16 == 0 || row % 16 == 0 || column + 1 == piece.ortho.width())
        changed.insert(tile_of(west + column, north - row - 1));
    }
  map_.ortho.geo.west = static_cast<double>(west_) * resolution + anchor.x();
  map_.ortho.geo.north = static_cast<double>(north_) * resolution + anchor.y();
  if (replace || map_.surface.height_m.empty()) {
    map_.surface = piece.surface;
    map_.surface.geo.west += anchor.x();
    map_.surface.geo.north += anchor.y();
    for (float& z : map_.surface.height_m.values()) z = static_cast<float>(z + anchor.z());
  }
  return changed;
}

void GrowingMap::set_poses(std::vector<PhotoPose> poses, const std::string& crs) {
  map_.poses = std::move(poses);
  map_.ortho.geo.crs = crs;
  map_.surface.geo.crs = crs;
}

}  // namespace nadir::aerial
