// SPDX-License-Identifier: Apache-2.0
// Aerial mapping of a simulated flight against its exact truth: every map pixel on bare ground is
// followed into the photo that it comes from and, by the true pose, back to the ground.
//
// Open ground is what nothing stands on or within 2 m of: nearer to a crown or a wall the surface
// model leans against it, and the map shows what stands there. All bare ground is printed beside
// it.
//
//   aerial_truth_bench [--photos N] [--reduce K] [--control] [--seed N] [--threads N]
//                      [--picture FILE.png]

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/mapping.hpp"
#include "nadir/core/rolling_shutter.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/simulation/simulated_flight.hpp"

namespace {

using namespace nadir;
using Complex = std::complex<double>;

struct Arguments {
  int photos = 40;
  int reduce = 1;
  int threads = 2;
  std::uint64_t seed = 7;  ///< of the flight and its errors; the place is always the same
  bool control = false;
  std::string picture;
};

Arguments arguments_of(const std::vector<std::string>& words) {
  Arguments arguments;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto value = [&] { return i + 1 < words.size() ? words[++i] : std::string("0"); };
    if (words[i] == "--photos") arguments.photos = std::stoi(value());
    if (words[i] == "--reduce") arguments.reduce = std::stoi(value());
    if (words[i] == "--threads") arguments.threads = std::stoi(value());
    if (words[i] == "--seed") arguments.seed = std::stoull(value());
    if (words[i] == "--control") arguments.control = true;
    if (words[i] == "--picture") arguments.picture = value();
  }
  return arguments;
}

/// The photos of the flight nearest to the middle of the site: a block of the wanted size.
std::vector<int> block_of(const SimulatedFlight& flight, const SimulatedWorld& world, int count) {
  std::vector<std::pair<double, int>> order;
  for (int i = 0; i < flight.size(); ++i) {
    const auto& p = flight.plan().waypoints[static_cast<std::size_t>(i)].position;
    order.emplace_back(
        std::max(std::abs(p.x - 0.5 * world.width_m()), std::abs(p.y - 0.5 * world.depth_m())), i);
  }
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), static_cast<std::size_t>(count)));
  std::vector<int> chosen;
  for (const auto& [distance, i] : order) chosen.push_back(i);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// The drone as it was, and the flight in the frame of the map.
struct Truth {
  std::map<std::string, PhotoPose> poses;  ///< local metres
  Eigen::Vector3d map_from_local;          ///< a shift: both are grid metres
};

PhotoSet photos_of(const SimulatedFlight& flight, const std::vector<int>& chosen,
                   const FlightOptions& options, const SimulatedWorld& world, Truth& truth) {
  std::vector<PhotoMetadata> tags;
  std::vector<GeodeticPosition> positions;
  for (const int i : chosen) {
    tags.push_back(flight.metadata(i));
    positions.push_back(*tags.back().position);
  }
  const MetricFrame frame = MetricFrame::around(positions);
  const SiteAnchor& anchor = world.anchor();
  truth.map_from_local = {anchor.easting_m, anchor.northing_m, anchor.altitude_m};
  PhotoSet set;
  set.crs = frame.crs();
  set.cameras.push_back({"simulated",
                         options.image_width,
                         options.image_height,
                         {options.focal_px * 1.01, 0.02, "nominal, 1 per cent off"}});
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    MappingPhoto photo;
    photo.name = std::to_string(1000 + chosen[k]);
    PhotoPrior& prior = photo.prior;
    prior.position = frame.to_map(*tags[k].position);
    prior.relative_altitude_m = tags[k].relative_altitude_m;
    prior.taken_at = tags[k].taken_at;
    if (tags[k].gimbal)
      prior.attitude = PhotoAttitude{
          frame.yaw_of_true_heading(tags[k].gimbal->yaw_deg * kDegree, *tags[k].position),
          tags[k].gimbal->pitch_deg * kDegree, tags[k].gimbal->roll_deg * kDegree};
    const auto pixels = std::make_shared<Raster<std::uint8_t>>(flight.render(chosen[k]).image);
    photo.load = [pixels] { return *pixels; };
    truth.poses[photo.name] = flight.truth(chosen[k]);
    set.photos.push_back(photo);
  }
  return set;
}

/// Four corners of the block, marked in every photo that sees them, to half a pixel.
void add_control(const SimulatedWorld& world, const Truth& truth, PhotoSet& set) {
  Eigen::Vector2d low{1e9, 1e9};
  Eigen::Vector2d high{-1e9, -1e9};
  for (const auto& [name, pose] : truth.poses) {
    low = low.cwiseMin(pose.map_from_camera.translation.head<2>());
    high = high.cwiseMax(pose.map_from_camera.translation.head<2>());
  }
  for (const double x : {low.x(), high.x()})
    for (const double y : {low.y(), high.y()}) {
      const Point3<frames::Map> local{x, y, world.ground_height(x, y)};
      GroundControlPoint point;
      point.name = "gcp" + std::to_string(set.control_points.size());
      point.position = Point3<frames::Map>::from(local.vector() + truth.map_from_local);
      for (const auto& [name, pose] : truth.poses) {
        const auto pixel = pose.camera.project((pose.map_from_camera.inverse() * local).vector());
        if (pixel && pixel->x() > 2 && pixel->y() > 2 && pixel->x() < pose.camera.width - 3 &&
            pixel->y() < pose.camera.height - 3)
          point.marks.push_back(
              {name, std::round(2 * pixel->x()) / 2, std::round(2 * pixel->y()) / 2});
      }
      set.control_points.push_back(point);
    }
}

/// Points of a map beside where they are.
struct Pairs {
  std::vector<Complex> shown;
  std::vector<Complex> real;
};

/// The similarity from the real points to the shown ones, by least squares, and what it leaves.
struct Similarity {
  Complex shift;
  double scale = 1.0;
  double heading_rad = 0.0;
  double rms_m = 0.0;
  double median_m = 0.0;
  double scale_sigma = 0.0;  ///< of white errors of the size that it leaves
};

Similarity similarity_of(const Pairs& pairs) {
  const auto n = static_cast<double>(pairs.shown.size());
  Complex shown_mean{};
  Complex real_mean{};
  for (std::size_t k = 0; k < pairs.shown.size(); ++k) {
    shown_mean += pairs.shown[k] / n;
    real_mean += pairs.real[k] / n;
  }
  Complex cross{};
  double norm = 0.0;
  for (std::size_t k = 0; k < pairs.shown.size(); ++k) {
    cross += std::conj(pairs.real[k] - real_mean) * (pairs.shown[k] - shown_mean);
    norm += std::norm(pairs.real[k] - real_mean);
  }
  const Complex fit = cross / norm;
  std::vector<double> left;
  double squares = 0.0;
  for (std::size_t k = 0; k < pairs.shown.size(); ++k) {
    left.push_back(std::abs(pairs.shown[k] - shown_mean - fit * (pairs.real[k] - real_mean)));
    squares += left.back() * left.back();
  }
  std::nth_element(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(left.size() / 2),
                   left.end());
  return {shown_mean - real_mean, std::abs(fit),         std::arg(fit),
          std::sqrt(squares / n), left[left.size() / 2], std::sqrt(0.5 * squares / n / norm)};
}

void print(const char* what, const Pairs& pairs) {
  const Similarity fit = similarity_of(pairs);
  double squares = 0.0;
  for (std::size_t k = 0; k < pairs.shown.size(); ++k) {
    squares += std::norm(pairs.shown[k] - pairs.real[k]);
  }
  std::printf(
      "%s, %zu points: relative rms %.3f m (median %.3f), scale error %.3f %%, heading error %.3f "
      "deg, absolute rms %.3f m (shift %.2f, %.2f)\n",
      what, pairs.shown.size(), fit.rms_m, fit.median_m, 100.0 * (fit.scale - 1.0),
      fit.heading_rad * 180.0 / std::numbers::pi,
      std::sqrt(squares / static_cast<double>(pairs.shown.size())), fit.shift.real(),
      fit.shift.imag());
}

/// What the fixes say by themselves: no adjustment knows the scale better than they do.
void print_positions(const PhotoSet& set, const Truth& truth) {
  Pairs pairs;
  for (const MappingPhoto& photo : set.photos) {
    const Eigen::Vector3d exact = truth.poses.at(photo.name).map_from_camera.translation;
    pairs.shown.emplace_back(photo.prior.position->x - truth.map_from_local.x(),
                             photo.prior.position->y - truth.map_from_local.y());
    pairs.real.emplace_back(exact.x(), exact.y());
  }
  print("positions of the photos", pairs);
  std::printf("  their errors leave the scale to +-%.3f %% (1 sigma)\n",
              100.0 * similarity_of(pairs).scale_sigma);
}

bool is_open(const SimulatedScene& scene, const SimulatedWorld& world, double x, double y) {
  constexpr double kStands = 0.1;  // metres
  for (const double distance : {1.0, 2.0}) {
    for (int direction = 0; direction < 8; ++direction) {
      const double angle = direction * std::numbers::pi / 4.0;
      const double at_x = x + distance * std::cos(angle);
      const double at_y = y + distance * std::sin(angle);
      if (scene.surface_height(at_x, at_y) > world.ground_height(at_x, at_y) + kStands) {
        return false;
      }
    }
  }
  return true;
}

void print_errors(const AerialMap& map, const SimulatedWorld& world, const SimulatedScene& scene,
                  const Truth& truth) {
  Pairs open;
  Pairs bare;
  for (int row = 3; row < map.ortho.height(); row += 7)
    for (int column = 3; column < map.ortho.width(); column += 7) {
      if (map.ortho.valid.at(column, row) == 0) continue;
      const double x = map.ortho.geo.x_at(column + 0.5);
      const double y = map.ortho.geo.y_at(row + 0.5);
      const PixelCoordinate at = map.surface.geo.pixel_at(x, y);
      const int c = static_cast<int>(at.column);
      const int r = static_cast<int>(at.row);
      if (!map.surface.height_m.contains(c, r)) continue;
      const double z = map.surface.height_m.at(c, r);
      if (!std::isfinite(z)) continue;
      const PhotoPose& pose = map.poses[map.source.at(column, row)];
      const auto pixel = project_row_by_row(
          pose.camera, pose.map_from_camera.rotation.inverse().toRotationMatrix(),
          Eigen::Vector3d(x, y, z) - pose.map_from_camera.translation, pose.flown_in_readout);
      if (!pixel) continue;
      const PhotoPose& exact = truth.poses.at(pose.name);
      const Eigen::Vector3d ray = exact.map_from_camera.rotation * exact.camera.ray(*pixel);
      const Eigen::Vector3d centre =
          exact.map_from_camera.translation +
          readout_share(exact.camera, pixel->y()) * exact.flown_in_readout;
      double ground = 0.0;
      Eigen::Vector3d p = centre;
      for (int pass = 0; pass < 10; ++pass) {
        p = centre + ray * ((ground - centre.z()) / ray.z());
        ground = world.ground_height(p.x(), p.y());
      }
      // Ground alone: no car, crown or roof there, and none in the way.
      if (scene.surface_height(p.x(), p.y()) > ground + 0.1) continue;
      if (!scene.sees(Point3<frames::Map>::from(centre), {p.x(), p.y(), ground + 0.05})) continue;
      const Complex shown{x - truth.map_from_local.x(), y - truth.map_from_local.y()};
      const Complex real{p.x(), p.y()};
      bare.shown.push_back(shown);
      bare.real.push_back(real);
      if (!is_open(scene, world, p.x(), p.y())) continue;
      open.shown.push_back(shown);
      open.real.push_back(real);
    }
  print("open ground", open);
  print("all bare ground", bare);
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = arguments_of({argv + 1, argv + argc});
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(arguments.threads));
  const SimulatedWorld world = SimulatedWorld::make(7, {});
  const SimulatedScene scene = world.seen({});
  FlightOptions options;
  options.image_width /= arguments.reduce;
  options.image_height /= arguments.reduce;
  options.focal_px /= arguments.reduce;
  const SimulatedFlight flight(world, scene, options, arguments.seed);
  Truth truth;
  PhotoSet set =
      photos_of(flight, block_of(flight, world, arguments.photos), options, world, truth);
  print_positions(set, truth);
  if (arguments.control) add_control(world, truth, set);
  const AerialMap map = map_photos(set, {});
  const AdjustmentReport& report = map.report;
  std::printf(
      "%zu photos, registered %d, reprojection %.2f px, focal %.1f (true %.1f), readout %.1f ms "
      "(true %.1f), ground %.2f m below, scale from %s\n",
      set.photos.size(), report.registered, report.reprojection_px, report.cameras[0].model.fx,
      options.focal_px, 1e3 * report.cameras[0].readout_s, 1e3 * options.readout_s,
      report.ground_below_camera_m, to_string(report.scale_source).c_str());
  if (report.position_rms_m)
    std::printf("position residual rms %.2f %.2f %.2f m, time offset %.3f s\n",
                (*report.position_rms_m)[0], (*report.position_rms_m)[1],
                (*report.position_rms_m)[2], report.time_offset_s.value_or(0.0));
  for (const std::string& warning : report.warnings) std::printf("warning: %s\n", warning.c_str());
  for (const auto& [stage, seconds] : report.seconds)
    std::printf("  %-12s %7.2f s\n", stage.c_str(), seconds);
  print_errors(map, world, scene, truth);
  if (!arguments.picture.empty()) write_png(arguments.picture, map.ortho.image);
  return 0;
}
