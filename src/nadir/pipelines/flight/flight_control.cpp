// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/flight/flight_control.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

using Points = std::vector<ListedControlPoint>;

constexpr double kFarM = 5000.0;  // farther from every photo than any drone map is wide

std::map<std::string, std::size_t> positions_by_name(const FlightInput& input) {
  std::map<std::string, std::size_t> positions;
  for (std::size_t i = 0; i < input.photos.size(); ++i) positions[input.photos[i].name] = i;
  return positions;
}

bool is_inside(const ListedControlPoint::Mark& mark, double width, double height) {
  return mark.u >= -0.5 && mark.v >= -0.5 && mark.u <= width - 0.5 && mark.v <= height - 0.5;
}

/// Pixels of the list over pixels of the file: 1, or more where the list means the full size.
double list_scale(const Points& points, const FlightInput& input) {
  const auto names = positions_by_name(input);
  double scale = 1.0;
  for (const ListedControlPoint& point : points) {
    for (const auto& mark : point.marks) {
      const auto found = names.find(mark.photo);
      if (found == names.end()) continue;
      const PhotoMetadata& photo = input.photos[found->second];
      if (is_inside(mark, photo.width, photo.height)) continue;
      const double full = photo.exif_width.value_or(photo.width);
      const double ratio = full / photo.width;
      if (!(ratio > 1.0) || !is_inside(mark, full, photo.height * ratio)) {
        throw Error(ErrorKind::kUsage,
                    fmt::format("the mark {:.1f}, {:.1f} lies outside of {} ({} x {} px)", mark.u,
                                mark.v, mark.photo, photo.width, photo.height),
                    mark.where, "give pixels of the photos that are mapped, column before row");
      }
      scale = std::max(scale, ratio);
    }
  }
  return scale;
}

void check_places(const Points& points, const std::vector<Eigen::Vector3d>& places,
                  const std::filesystem::path& file, const FlightInput& input) {
  constexpr std::size_t kFewest = 3;
  if (points.size() < kFewest) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} control points, 3 at least are needed", points.size()),
                file.string(), "measure more, or map without --gcp");
  }
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& place : places) mean += place.head<2>() / static_cast<double>(places.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const auto& place : places) {
    const Eigen::Vector2d d = place.head<2>() - mean;
    scatter += d * d.transpose();
  }
  const Eigen::Vector2d spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter)
                                     .eigenvalues()
                                     .cwiseMax(0.0)
                                     .cwiseSqrt();
  if (spread[0] < 0.02 * spread[1]) {
    throw Error(ErrorKind::kUsage, "the control points lie on a line", file.string(),
                "they cannot hold the tilt across it: measure one beside the line");
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    double nearest = HUGE_VAL;
    for (const MappingPhoto& photo : input.set.photos) {
      if (!photo.prior.position) continue;
      nearest = std::min(nearest, (photo.prior.position->vector() - places[i]).head<2>().norm());
    }
    if (std::isfinite(nearest) && nearest > kFarM) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("control point {} lies {:.0f} km from the photos", points[i].name,
                              nearest / 1000.0),
                  file.string(), "check the reference system in its first line");
    }
  }
}

}  // namespace

void add_control_points(const Points& points, const std::filesystem::path& file,
                        FlightInput& input) {
  std::vector<Eigen::Vector3d> places;
  for (const ListedControlPoint& point : points) {
    places.push_back(input.frame->to_map(point.position).vector());
  }
  check_places(points, places, file, input);
  const double scale = list_scale(points, input);
  if (scale > 1.0) {
    input.warnings.push_back(fmt::format(
        "{}: marks lie outside of the photos; all are taken as pixels of the full size, {:.3g} "
        "times the photos'",
        file.string(), scale));
  }
  const auto names = positions_by_name(input);
  std::vector<std::string> unknown;
  for (std::size_t i = 0; i < points.size(); ++i) {
    GroundControlPoint point;
    point.name = points[i].name;
    point.position = Point3<frames::Map>::from(places[i]);
    for (const auto& mark : points[i].marks) {
      const auto found = names.find(mark.photo);
      if (found == names.end()) {
        unknown.push_back(mark.photo);
        continue;
      }
      const CameraPrior& camera = input.set.cameras[input.set.photos[found->second].camera];
      const double factor = camera.width / (scale * input.photos[found->second].width);
      // Pixel centres: the same place keeps its distance from the outer edge.
      point.marks.push_back(
          {mark.photo, (mark.u + 0.5) * factor - 0.5, (mark.v + 0.5) * factor - 0.5});
    }
    input.set.control_points.push_back(std::move(point));
  }
  if (!unknown.empty()) {
    input.warnings.push_back(listed(unknown) + ": marked in " + file.string() +
                             ", but not among the photos");
  }
}

}  // namespace nadir
