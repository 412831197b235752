// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "map_files.hpp"
#include "nadir/pages/html_page.hpp"
#include "nadir/pages/map_pictures.hpp"
#include "nadir/report/charts.hpp"
#include "nadir/report/markup.hpp"
#include "nadir/version.hpp"

namespace nadir::cli {
namespace {

using html::Markup;
using report::escaped;

Markup facts(const AerialMap& map, const FlightInput& input) {
  const AdjustmentReport& r = map.report;
  std::vector<html::Row> rows{
      {"Photos joined", fmt::format("{} of {}", r.registered, input.set.photos.size())},
      {"Map", fmt::format("{} × {} px of {} m", map.ortho.width(), map.ortho.height(),
                          map.ortho.geo.resolution)},
      {"Frame", input.frame ? input.frame->name() : "local metres"},
      {"Reprojection", fmt::format("{:.2f} px", r.reprojection_px)}};
  if (r.position_residual_m) {
    rows.push_back({"Positions differ by", fmt::format("{:.2f} m", *r.position_residual_m)});
  }
  rows.push_back({"Ground below the photos", fmt::format("{:.1f} m", r.ground_below_camera_m)});
  rows.push_back({"A photo's pixel on the ground", fmt::format("{:.3f} m", r.photo_pixel_m)});
  rows.push_back({"Scale from", to_string(r.scale_source)});
  rows.push_back({"Scale uncertain by", fmt::format("{:.2f} %", 100.0 * r.scale_sigma)});
  rows.push_back({"Heading uncertain by", fmt::format("{:.2f}°", r.heading_sigma_deg)});
  for (const CameraReport& camera : r.cameras) {
    rows.push_back({camera.name, fmt::format("focal {:.1f} px (before: {:.1f}, {}), ±{:.2f} %",
                                             camera.model.fx, camera.prior_focal_px,
                                             camera.focal_source, 100.0 * camera.focal_sigma)});
  }
  return html::table({}, rows, html::Columns::kTexts);
}

/// In words: how much of the flight is in the map, and how well it fits.
Markup headline(const AerialMap& map, const FlightInput& input) {
  const AdjustmentReport& r = map.report;
  const std::size_t photos = input.set.photos.size();
  const bool whole = r.registered == static_cast<int>(photos);
  return html::headline(
      fmt::format("{} of {} photos are in the map; what they see agrees to {:.2f} px.",
                  r.registered, photos, r.reprojection_px),
      whole && input.warnings.empty() && r.warnings.empty());
}

Markup warnings(const AerialMap& map, const FlightInput& input) {
  Markup markup;
  for (const auto* list : {&input.warnings, &map.report.warnings}) {
    for (const std::string& warning : *list) markup += html::warning(warning);
  }
  return markup;
}

html::Row photo_row(const PhotoReport& photo) {
  if (!photo.registered) return {photo.name, "not joined", "", "", "", "", ""};
  const auto residual = photo.position_residual_m;
  return {photo.name,
          std::to_string(photo.observations),
          fmt::format("{:.2f}", photo.reprojection_px),
          fmt::format("{:.1f}", photo.ground_below_camera_m),
          fmt::format("{:.1f}", photo.off_nadir_deg),
          fmt::format("{:.2f}", photo.gain),
          residual ? fmt::format("{:.2f}, {:.2f}, {:.2f}", (*residual)[0], (*residual)[1],
                                 (*residual)[2])
                   : "none"};
}

Markup photo_table(const AerialMap& map) {
  std::vector<html::Row> rows;
  for (const PhotoReport& photo : map.report.photos) rows.push_back(photo_row(photo));
  return html::table({"photo", "points", "reprojection px", "above ground m", "off nadir °", "gain",
                      "position residual m (x, y, z)"},
                     rows, html::Columns::kNumbers);
}

Markup control_table(const AerialMap& map) {
  if (map.report.control_points.empty()) return {};
  std::vector<html::Row> rows;
  for (const ControlPointReport& point : map.report.control_points) {
    rows.push_back({point.name, std::to_string(point.marks),
                    fmt::format("{:.3f}, {:.3f}, {:.3f}", point.residual_m[0], point.residual_m[1],
                                point.residual_m[2]),
                    fmt::format("{:.2f}", point.reprojection_px),
                    point.outlier ? "does not fit" : ""});
  }
  return html::heading("Control points") +
         html::table({"point", "marks", "residual m (x, y, z)", "reprojection px", ""}, rows,
                     html::Columns::kNumbers);
}

Markup run_times(const AerialMap& map) {
  if (map.report.seconds.empty()) return {};
  std::vector<Sample> stages;
  for (const auto& [stage, seconds] : map.report.seconds) stages.push_back({stage, {seconds}});
  return html::heading("Run time") +
         html::side_by_side(
             {html::figure(html::inline_svg(svg_rows(stages, "time, s", "Run time by stage")),
                           "Seconds that each stage of the mapping took.")});
}

/// Drawings over the picture of the map, in its pixels.
class Overlay {
 public:
  Overlay(const AerialMap& map, const Picture& picture)
      : map_(map),
        scale_(static_cast<double>(picture.width) / std::max(1, map.ortho.width())),
        width_(picture.width),
        height_(picture.height) {}

  std::array<double, 2> at(const Eigen::Vector3d& point) const {
    const PixelCoordinate pixel = map_.ortho.geo.pixel_at(point.x(), point.y());
    return {pixel.column * scale_, pixel.row * scale_};
  }
  double pixels_per_metre() const { return scale_ / map_.ortho.geo.resolution; }
  std::string svg(const std::string& background, const std::string& drawing) const {
    return fmt::format(
        "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\"><image "
        "href=\"{2}\" width=\"{0}\" height=\"{1}\" opacity=\"0.75\"/>{3}</svg>",
        width_, height_, background, drawing);
  }

 private:
  const AerialMap& map_;
  double scale_;
  int width_;
  int height_;
};

/// Where the corners of a photo meet the plane of the ground below it.
std::string footprint(const PhotoPose& pose, double ground_z, const Overlay& overlay) {
  std::string points;
  const double w = pose.camera.width;
  const double h = pose.camera.height;
  for (const auto& [u, v] : {std::pair{0.0, 0.0}, {w, 0.0}, {w, h}, {0.0, h}}) {
    const Eigen::Vector3d ray = pose.map_from_camera.rotation * pose.camera.ray({u - 0.5, v - 0.5});
    if (ray.z() > -1e-3) return {};
    const Eigen::Vector3d& centre = pose.map_from_camera.translation;
    const auto [x, y] = overlay.at(centre + ray * ((ground_z - centre.z()) / ray.z()));
    points += fmt::format("{:.1f},{:.1f} ", x, y);
  }
  return R"(<polygon points=")" + points +
         R"(" fill="#2b6cb0" fill-opacity="0.05" stroke="#2b6cb0" stroke-width="1"/>)";
}

const PhotoReport* report_of_photo(const AerialMap& map, const std::string& name) {
  const auto found = std::ranges::find(map.report.photos, name, &PhotoReport::name);
  return found == map.report.photos.end() ? nullptr : &*found;
}

std::string footprints(const AerialMap& map, const Overlay& overlay) {
  std::string drawing;
  for (const PhotoPose& pose : map.poses) {
    const PhotoReport* report = report_of_photo(map, pose.name);
    const Eigen::Vector3d& centre = pose.map_from_camera.translation;
    const double below = report == nullptr ? 0.0 : report->ground_below_camera_m;
    drawing += footprint(pose, centre.z() - below, overlay);
    const auto [x, y] = overlay.at(centre);
    drawing += fmt::format(
        R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="#c53030"><title>{}</title></circle>)", x, y,
        escaped(pose.name));
  }
  return drawing;
}

constexpr double kResidualGain = 10.0;

std::string residuals(const AerialMap& map, const Overlay& overlay) {
  std::string drawing;
  for (const PhotoPose& pose : map.poses) {
    const PhotoReport* report = report_of_photo(map, pose.name);
    if (report == nullptr || !report->position_residual_m) continue;
    const auto [x, y] = overlay.at(pose.map_from_camera.translation);
    const double step = kResidualGain * overlay.pixels_per_metre();
    drawing += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{3:.1f}\" stroke=\"#c53030\" "
        "stroke-width=\"2\"/><circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"3\" fill=\"#222\"/>",
        x, y, x + step * (*report->position_residual_m)[0],
        y - step * (*report->position_residual_m)[1]);
  }
  return drawing;
}

}  // namespace

std::string report_page(const AerialMap& map, const FlightInput& input, const std::string& title) {
  Markup markup = html::title(title, fmt::format("nadir {}, map of a flight", NADIR_VERSION));
  markup += headline(map, input) + warnings(map, input) + facts(map, input);
  if (map.ortho.width() > 0) {
    const Picture colours = colour_picture(map);
    const Overlay overlay(map, colours);
    markup += html::heading("Map") +
              html::figure(html::image(colours.uri, "orthomosaic"), "The orthomosaic.");
    markup += html::heading("Photos and surface");
    markup += html::side_by_side(
        {html::figure(overlay.svg(colours.uri, footprints(map, overlay)),
                      "Footprints on the ground; red: cameras."),
         html::figure(overlay.svg(colours.uri, residuals(map, overlay)),
                      fmt::format("Red: adjusted minus given position, {:.0f} times as long, from "
                                  "the adjusted one.",
                                  kResidualGain)),
         html::figure(html::image(seam_picture(map).uri, "seams"),
                      "Seams: which photo gives each pixel its colour."),
         html::figure(html::image(view_picture(map).uri, "views"),
                      "How many photos see each pixel: dark 1, bright 10 and more."),
         html::figure(html::image(surface_picture(map).uri, "heights"),
                      "The surface, lit from the north-west.")});
  }
  markup += run_times(map) + control_table(map) + html::heading("All photos") + photo_table(map);
  return html::page(title + " - nadir", markup);
}

}  // namespace nadir::cli
