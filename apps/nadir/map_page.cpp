// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "map_files.hpp"
#include "map_pictures.hpp"

namespace nadir::cli {
namespace {

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;"
    "color:#222;background:#fff}h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}"
    "table{border-collapse:collapse;font-size:.9em}td,th{padding:.2em .7em;text-align:right;"
    "border-bottom:1px solid #ddd}td:first-child,th:first-child{text-align:left}"
    "figure{margin:1em 0}img,svg{max-width:100%;height:auto;border:1px solid #ccc}"
    "figcaption{font-size:.9em;color:#555}.warn{background:#fff6e0;border-left:4px solid #d9962b;"
    "padding:.4em .8em;margin:.4em 0}";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string figure(const std::string& content, const std::string& caption) {
  return "<figure>" + content + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string image(const std::string& data_uri, const std::string& alternative) {
  return "<img alt=\"" + alternative + "\" src=\"" + data_uri + "\">";
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><td>" + name + "</td><td>" + value + "</td></tr>\n";
}

std::string facts(const AerialMap& map, const FlightInput& input) {
  const AdjustmentReport& r = map.report;
  std::string text = "<table>\n";
  text += row("Photos joined", fmt::format("{} of {}", r.registered, input.set.photos.size()));
  text += row("Map", fmt::format("{} × {} px of {} m", map.ortho.width(), map.ortho.height(),
                                 map.ortho.geo.resolution));
  text += row("Frame", input.frame ? escaped(input.frame->name()) : "local metres");
  text += row("Reprojection", fmt::format("{:.2f} px", r.reprojection_px));
  if (r.position_residual_m) {
    text += row("Positions differ by", fmt::format("{:.2f} m", *r.position_residual_m));
  }
  text += row("Ground below the photos", fmt::format("{:.1f} m", r.ground_below_camera_m));
  text += row("A photo's pixel on the ground", fmt::format("{:.3f} m", r.photo_pixel_m));
  text += row("Scale from", escaped(to_string(r.scale_source)));
  text += row("Scale uncertain by", fmt::format("{:.2f} %", 100.0 * r.scale_sigma));
  text += row("Heading uncertain by", fmt::format("{:.2f}°", r.heading_sigma_deg));
  for (const CameraReport& camera : r.cameras) {
    text += row(escaped(camera.name),
                fmt::format("focal {:.1f} px (before: {:.1f}, {}), ±{:.2f} %", camera.model.fx,
                            camera.prior_focal_px, escaped(camera.focal_source),
                            100.0 * camera.focal_sigma));
  }
  return text + "</table>\n";
}

std::string warnings(const AerialMap& map, const FlightInput& input) {
  std::string text;
  for (const auto* list : {&input.warnings, &map.report.warnings}) {
    for (const std::string& warning : *list) {
      text += "<p class=\"warn\">" + escaped(warning) + "</p>\n";
    }
  }
  return text;
}

std::string photo_table(const AerialMap& map) {
  std::string text =
      "<table><tr><th>photo</th><th>points</th><th>reprojection px</th><th>above ground m</th>"
      "<th>off nadir °</th><th>gain</th><th>position residual m (x, y, z)</th></tr>\n";
  for (const PhotoReport& photo : map.report.photos) {
    if (!photo.registered) {
      text += "<tr><td>" + escaped(photo.name) + "</td><td colspan=\"6\">not joined</td></tr>\n";
      continue;
    }
    const auto residual = photo.position_residual_m;
    text += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.2f}</td>"
        "<td>{}</td></tr>\n",
        escaped(photo.name), photo.observations, photo.reprojection_px, photo.ground_below_camera_m,
        photo.off_nadir_deg, photo.gain,
        residual
            ? fmt::format("{:.2f}, {:.2f}, {:.2f}", (*residual)[0], (*residual)[1], (*residual)[2])
            : "none");
  }
  return text + "</table>\n";
}

std::string control_table(const AerialMap& map) {
  if (map.report.control_points.empty()) return {};
  std::string text =
      "<h2>Control points</h2><table><tr><th>point</th><th>marks</th><th>residual m (x, y, z)</th>"
      "<th>reprojection px</th><th></th></tr>\n";
  for (const ControlPointReport& point : map.report.control_points) {
    text += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{:.3f}, {:.3f}, {:.3f}</td><td>{:.2f}</td><td>{}</td></tr>"
        "\n",
        escaped(point.name), point.marks, point.residual_m[0], point.residual_m[1],
        point.residual_m[2], point.reprojection_px, point.outlier ? "does not fit" : "");
  }
  return text + "</table>\n";
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
  return "<polygon points=\"" + points +
         "\" fill=\"#2b6cb0\" fill-opacity=\"0.05\" stroke=\"#2b6cb0\" stroke-width=\"1\"/>";
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
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"#c53030\"><title>{}</title></circle>",
        x, y, escaped(pose.name));
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
  std::string page = "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                     escaped(title) + "</title><style>" + kStyle + "</style></head><body><h1>" +
                     escaped(title) + "</h1>\n";
  page += facts(map, input) + warnings(map, input);
  if (map.ortho.width() > 0) {
    const Picture colours = colour_picture(map);
    const Overlay overlay(map, colours);
    page += "<h2>Map</h2>" + figure(image(colours.uri, "orthomosaic"), "The orthomosaic.");
    page += "<h2>Photos</h2>" + figure(overlay.svg(colours.uri, footprints(map, overlay)),
                                       "Footprints on the ground; red: cameras.");
    page += "<h2>Positions</h2>" +
            figure(overlay.svg(colours.uri, residuals(map, overlay)),
                   fmt::format("Red: adjusted minus given position, {:.0f} times as long, from the "
                               "adjusted one.",
                               kResidualGain));
    page += "<h2>Seams</h2>" + figure(image(seam_picture(map).uri, "seams"),
                                      "Which photo gives each pixel its colour.");
    page +=
        "<h2>Views</h2>" + figure(image(view_picture(map).uri, "views"),
                                  "How many photos see each pixel: dark 1, bright 10 and more.");
    page += "<h2>Heights</h2>" + figure(image(surface_picture(map).uri, "heights"),
                                        "The surface, lit from the north-west.");
  }
  page += control_table(map) + "<h2>All photos</h2>" + photo_table(map);
  return page + "</body></html>\n";
}

}  // namespace nadir::cli
