// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/orthomosaic.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "nadir/aerial_mapping/detail/median.hpp"
#include "nadir/aerial_mapping/ortho/cells.hpp"
#include "nadir/aerial_mapping/ortho/exposure.hpp"
#include "nadir/aerial_mapping/ortho/sweep.hpp"
#include "nadir/aerial_mapping/ortho/tile.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"

namespace nadir::aerial {
namespace {

constexpr double kCellM = 0.4;         // on which views are chosen
constexpr double kGroundPixels = 4.0;  // side of a cell of the surface, map pixels
constexpr int kTilePx = 512;
constexpr std::size_t kImageBudget = 600U << 20U;  // bytes of photos that are held
constexpr double kSharpness = 0.75;  // photo pixels are shrunk to this share of a map pixel
constexpr double kLargestHoleM2 = 150.0;
constexpr double kObliqueRad = 0.17;
constexpr std::size_t kFewestForSurface = 30;  // points; a plane below that

double off_nadir(const View& view) {
  return std::acos(std::clamp(-view.camera_from_map(2, 2), -1.0, 1.0));
}

CellGrid cell_grid(const Extent& extent, double resolution) {
  CellGrid grid;
  grid.pixels = std::max(1, static_cast<int>(std::lround(kCellM / resolution)));
  const double cell = grid.pixels * resolution;
  grid.geo = {extent.west, extent.north, cell, {}};
  grid.width = static_cast<int>(std::ceil((extent.east - extent.west) / cell - 1e-6));
  grid.height = static_cast<int>(std::ceil((extent.north - extent.south) / cell - 1e-6));
  return grid;
}

/// Cells that may be shown: seen by enough, near a point, and with a view chosen.
cv::Mat valid_cells(const CellGrid& grid, const cv::Mat& count, const cv::Mat& labels,
                    const Ground& ground, const std::vector<View>& views,
                    const AerialMappingOptions& options) {
  cv::Mat valid(grid.height, grid.width, CV_8U, cv::Scalar(0));
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const std::uint16_t label = labels.at<std::uint16_t>(row, column);
      if (label == kNoView) continue;
      const bool provisional = views[label].provisional;
      if (provisional || (count.at<std::uint8_t>(row, column) >= options.min_views &&
                          ground.is_known_at(grid.geo.x_at(column + 0.5), grid.geo.y_at(row + 0.5),
                                             options.max_surface_distance_m)))
        valid.at<std::uint8_t>(row, column) = 1;
    }
  return valid;
}

/// Small patches without points that valid cells enclose on all sides (lawn, asphalt, a car that
/// drove off), or that crowns hide from all views but one, are interpolated from around them: valid
/// too where any view sees them.
void close_holes(const CellGrid& grid, const cv::Mat& labels, cv::Mat& valid) {
  cv::Mat open(valid.size(), CV_8U);
  for (int row = 0; row < valid.rows; ++row)
    for (int column = 0; column < valid.cols; ++column)
      open.at<std::uint8_t>(row, column) = valid.at<std::uint8_t>(row, column) == 0 ? 1 : 0;
  cv::Mat patches;
  cv::Mat statistics;
  cv::Mat centres;
  const int patch_count = cv::connectedComponentsWithStats(open, patches, statistics, centres, 4);
  for (int patch = 1; patch < patch_count; ++patch) {
    const cv::Rect box(statistics.at<int>(patch, cv::CC_STAT_LEFT),
                       statistics.at<int>(patch, cv::CC_STAT_TOP),
                       statistics.at<int>(patch, cv::CC_STAT_WIDTH),
                       statistics.at<int>(patch, cv::CC_STAT_HEIGHT));
    const double area =
        statistics.at<int>(patch, cv::CC_STAT_AREA) * grid.geo.resolution * grid.geo.resolution;
    const bool at_border = box.x == 0 || box.y == 0 || box.x + box.width == valid.cols ||
                           box.y + box.height == valid.rows;
    if (at_border || area > kLargestHoleM2) continue;
    for (int row = box.y; row < box.y + box.height; ++row)
      for (int column = box.x; column < box.x + box.width; ++column)
        if (patches.at<int>(row, column) == patch &&
            labels.at<std::uint16_t>(row, column) != kNoView)
          valid.at<std::uint8_t>(row, column) = 1;
  }
}

/// The part of the grid that holds anything; the whole where nothing does.
cv::Rect used_part(const cv::Mat& valid) {
  cv::Rect used;
  for (int row = 0; row < valid.rows; ++row)
    for (int column = 0; column < valid.cols; ++column)
      if (valid.at<std::uint8_t>(row, column) != 0) used |= cv::Rect(column, row, 1, 1);
  return used.empty() ? cv::Rect(0, 0, valid.cols, valid.rows) : used;
}

float quality_of(const View& view, const CellGrid& grid, const Ground& ground, int column, int row,
                 int count, double max_distance) {
  if (view.provisional) return kProvisionalQuality;
  const double x = grid.geo.x_at(column + 0.5);
  const double y = grid.geo.y_at(row + 0.5);
  const Eigen::Vector3d ray = Eigen::Vector3d(x, y, ground.height_at(x, y)) - view.centre;
  const double upright = -ray.z() / ray.norm();
  const double near = 1.0 - 0.5 * std::min(1.0, ground.distance_at(x, y) / max_distance);
  const double seen = std::min(1.0, count / 4.0);
  const double quality = upright * upright * near * (0.4 + 0.6 * seen);
  return static_cast<float>(std::clamp(quality, 2.0 * kProvisionalQuality, 1.0));
}

void allocate(AerialMap& map, const GeoReference& geo, int width, int height) {
  map.ortho.geo = geo;
  map.ortho.image = Raster<std::uint8_t>(width, height, 0, 3);
  map.ortho.valid = Raster<std::uint8_t>(width, height, 0);
  map.view_count = Raster<std::uint8_t>(width, height, 0);
  map.quality = Raster<float>(width, height, 0.0F);
  map.source = Raster<std::uint16_t>(width, height, kNoView);
}

/// Copies one rendered tile to the map; (left, top) is the tile's corner in the map.
void put_tile(const cv::Mat& tile, const cv::Rect& cells_part, const CellGrid& grid,
              const cv::Rect& part, const cv::Mat& valid, const cv::Mat& labels,
              const cv::Mat& count, const cv::Mat& quality, AerialMap& map) {
  for (int row = 0; row < part.height; ++row)
    for (int column = 0; column < part.width; ++column) {
      const int cell_row = (part.y + row) / grid.pixels;
      const int cell_column = (part.x + column) / grid.pixels;
      const int to_column = part.x + column - cells_part.x * grid.pixels;
      const int to_row = part.y + row - cells_part.y * grid.pixels;
      map.view_count.at(to_column, to_row) = count.at<std::uint8_t>(cell_row, cell_column);
      if (valid.at<std::uint8_t>(cell_row, cell_column) == 0) continue;
      map.ortho.valid.at(to_column, to_row) = 255;
      map.source.at(to_column, to_row) = labels.at<std::uint16_t>(cell_row, cell_column);
      map.quality.at(to_column, to_row) = quality.at<float>(cell_row, cell_column);
      for (int channel = 0; channel < 3; ++channel)
        map.ortho.image.at(to_column, to_row, channel) = tile.at<cv::Vec3b>(row, column)[channel];
    }
}

void check_size(const Extent& extent, const AerialMappingOptions& options) {
  const double megapixels = (extent.east - extent.west) * (extent.north - extent.south) /
                            (options.resolution_m * options.resolution_m) * 1e-6;
  if (megapixels <= options.max_megapixels) return;
  throw Error(
      ErrorKind::kUsage,
      "the orthomosaic would have " + std::to_string(std::lround(megapixels)) + " million pixels",
      {},
      "choose a coarser aerial_mapping.resolution_m or raise "
      "aerial_mapping.max_megapixels");
}

void crop_surface(const Ground& ground, const AerialMappingOptions& options, AerialMap& map) {
  map.surface = ground.heights;
  map.surface.geo.crs = map.ortho.geo.crs;
  for (int row = 0; row < map.surface.height(); ++row)
    for (int column = 0; column < map.surface.width(); ++column)
      if (!ground.is_known(column, row, options.max_surface_distance_m))
        map.surface.height_m.at(column, row) = std::numeric_limits<float>::quiet_NaN();
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Extent kNowhere{kInfinity, kInfinity, -kInfinity, -kInfinity};

void include(double x, double y, Extent& extent) {
  extent.west = std::min(extent.west, x);
  extent.east = std::max(extent.east, x);
  extent.south = std::min(extent.south, y);
  extent.north = std::max(extent.north, y);
}

/// The corners of a photo, as far as the limit on oblique rays lets them go.
void include_footprint(const View& view, double ground, double max_off_nadir_rad, Extent& extent) {
  const CameraModel& camera = view.camera;
  for (const double u : {0.0, camera.width - 1.0})
    for (const double v : {0.0, camera.height - 1.0}) {
      const Eigen::Vector3d ray = view.camera_from_map.transpose() * camera.ray({u, v});
      const double across = std::hypot(ray.x(), ray.y());
      const double down = std::max(-ray.z(), across / std::tan(max_off_nadir_rad));
      const double scale = (view.centre.z() - ground) / std::max(down, 1e-9);
      include(view.centre.x() + scale * ray.x(), view.centre.y() + scale * ray.y(), extent);
    }
}

/// Corners on whole cells of the views' grid, so that the map's pixels lie on whole multiples of
/// the resolution whatever its extent.
Extent on_whole_cells(const Extent& extent, double resolution) {
  const double cell = std::max(1.0, std::round(kCellM / resolution)) * resolution;
  return {std::floor(extent.west / cell) * cell, std::floor(extent.south / cell) * cell,
          std::ceil(extent.east / cell) * cell, std::ceil(extent.north / cell) * cell};
}

}  // namespace

double Block::outlier_tolerance() const {
  double height = 0.0;
  for (const View& view : views)
    height += (view.centre.z() - ground) / static_cast<double>(views.size());
  return 0.01 * height;
}

Extent extent_of(const Block& block, const AerialMappingOptions& options) {
  Extent extent = kNowhere;
  const bool by_points = options.surface != SurfaceKind::kPlane && block.points.size() >= 3;
  for (const View& view : block.views)
    if (!by_points || view.provisional)
      include_footprint(view, block.ground, limits_of(block, options).max_off_nadir_rad, extent);
  if (by_points)
    for (const Eigen::Vector3d& p : block.points) {
      const double d = options.max_surface_distance_m;
      include(p.x() - d, p.y() - d, extent);
      include(p.x() + d, p.y() + d, extent);
    }
  return on_whole_cells(extent, options.resolution_m);
}

void sweep_for_points(const PhotoSet& set, Block& block, const AerialMappingOptions& options,
                      const StopToken& stop) {
  if (options.surface == SurfaceKind::kPlane || block.points.size() < kFewestForSurface) return;
  const ViewLimits limits = limits_of(block, options);
  Extent extent = kNowhere;
  for (const View& view : block.views)
    include_footprint(view, block.ground, limits.max_off_nadir_rad, extent);
  extent = on_whole_cells(extent, options.resolution_m);
  const Ground ground = ground_of(block, extent, options);
  ViewImages images(set, block.views, kImageBudget);
  const std::vector<Eigen::Vector3d> more =
      sweep_gaps(block.views, images, ground, limits, options.max_surface_distance_m, stop);
  block.points.insert(block.points.end(), more.begin(), more.end());
  block.points = without_outliers(std::move(block.points), block.outlier_tolerance());
}

Ground ground_of(const Block& block, const Extent& extent, const AerialMappingOptions& options) {
  const double cell = std::max(kGroundPixels * options.resolution_m, 0.2);
  if (options.surface == SurfaceKind::kPlane || block.points.size() < kFewestForSurface)
    return plane_ground(block.points, extent, cell, block.ground);
  return triangulated_ground(block.points, extent, cell);
}

ViewLimits limits_of(const Block& block, const AerialMappingOptions& options) {
  ViewLimits limits;
  std::vector<double> tilts;
  for (const View& view : block.views) tilts.push_back(off_nadir(view));
  const double tilt = median_of(tilts);
  limits.max_off_nadir_rad = radians(options.max_off_nadir_deg);
  if (tilt > kObliqueRad)
    limits.max_off_nadir_rad = std::min(limits.max_off_nadir_rad + tilt, radians(75.0));
  return limits;
}

void make_orthomosaic(const PhotoSet& set, Block& block, const Ground& ground, const Extent& extent,
                      const AerialMappingOptions& options, const MappingProgress& progress,
                      const StopToken& stop, AerialMap& map) {
  check_size(extent, options);
  const CellGrid grid = cell_grid(extent, options.resolution_m);
  for (View& view : block.views) {
    const double height =
        std::max(1e-6, view.centre.z() - ground.height_at(view.centre.x(), view.centre.y()));
    view.shrink = std::max(1.0, kSharpness * options.resolution_m * view.camera.fx / height);
  }
  ViewImages images(set, block.views, kImageBudget);
  const auto cells = look(block.views, ground, grid, limits_of(block, options), images, stop);
  if (progress) progress("seams", 0.6);
  std::vector<std::optional<double>> exposures;
  for (const View& view : block.views) exposures.push_back(set.photos[view.photo].prior.exposure);
  const auto gains = balance(overlaps_of(cells, stop), exposures, options.gain_prior_sigma);
  for (std::size_t k = 0; k < gains.size(); ++k) block.views[k].gain = gains[k];
  const cv::Mat labels =
      choose_views(cells, block.views, grid, options.blend == BlendKind::kMultiBand, stop);
  stop.check();
  const cv::Mat count = count_views(cells, grid);
  cv::Mat valid = valid_cells(grid, count, labels, ground, block.views, options);
  close_holes(grid, labels, valid);
  keep_from_clipping(cells, labels, block.views);
  cv::Mat quality(grid.height, grid.width, CV_32F, cv::Scalar(0));
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (const std::uint16_t label = labels.at<std::uint16_t>(row, column); label != kNoView)
        quality.at<float>(row, column) =
            quality_of(block.views[label], grid, ground, column, row,
                       count.at<std::uint8_t>(row, column), options.max_surface_distance_m);
  if (progress) progress("seams", 1.0);

  const cv::Rect used = used_part(valid);
  const GeoReference geo{grid.geo.x_at(used.x), grid.geo.y_at(used.y), options.resolution_m,
                         set.crs};
  allocate(map, geo, used.width * grid.pixels, used.height * grid.pixels);
  const Scene scene{block.views,   ground,
                    grid,          labels,
                    images,        {extent.west, extent.north, options.resolution_m, {}},
                    options.blend, options.bands};
  const cv::Rect all(used.x * grid.pixels, used.y * grid.pixels, used.width * grid.pixels,
                     used.height * grid.pixels);
  std::vector<cv::Rect> tiles;
  for (int top = all.y; top < all.y + all.height; top += kTilePx)
    for (int left = all.x; left < all.x + all.width; left += kTilePx)
      tiles.push_back(cv::Rect(left, top, kTilePx, kTilePx) & all);
  std::mutex mutex;
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t k) {
    stop.check();
    const cv::Mat tile = render(scene, tiles[k]);
    put_tile(tile, used, grid, tiles[k], valid, labels, count, quality, map);
    const std::scoped_lock lock(mutex);
    ++done;
    if (progress)
      progress("orthomosaic", static_cast<double>(done) / static_cast<double>(tiles.size()));
  });
  crop_surface(ground, options, map);
}

}  // namespace nadir::aerial
