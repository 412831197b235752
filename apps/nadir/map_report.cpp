// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "map_files.hpp"

namespace nadir::cli {
namespace {

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json seconds_of(const AdjustmentReport& report) {
  Json seconds = Json::object();
  for (const auto& [stage, value] : report.seconds) seconds[stage] = value;
  return seconds;
}

std::vector<std::string> warnings_of(const AerialMap& map, const FlightInput& input) {
  std::vector<std::string> warnings = input.warnings;
  warnings.insert(warnings.end(), map.report.warnings.begin(), map.report.warnings.end());
  return warnings;
}

double valid_share(const AerialMap& map) {
  const auto& valid = map.ortho.valid.values();
  const auto holes = std::ranges::count(valid, std::uint8_t{0});
  return valid.empty() ? 0.0 : 1.0 - static_cast<double>(holes) / static_cast<double>(valid.size());
}

Json photo_json(const PhotoReport& photo) {
  Json item{{"name", photo.name},
            {"registered", photo.registered},
            {"observations", photo.observations},
            {"reprojection_px", photo.reprojection_px},
            {"ground_below_camera_m", photo.ground_below_camera_m},
            {"off_nadir_deg", photo.off_nadir_deg},
            {"gain", photo.gain}};
  item["position_residual_m"] =
      photo.position_residual_m ? Json(*photo.position_residual_m) : Json(nullptr);
  return item;
}

Json camera_json(const CameraReport& camera) {
  const CameraModel& m = camera.model;
  return {{"name", camera.name},
          {"width", m.width},
          {"height", m.height},
          {"focal_px", m.fx},
          {"prior_focal_px", camera.prior_focal_px},
          {"focal_sigma", camera.focal_sigma},
          {"focal_source", camera.focal_source},
          {"readout_s", camera.readout_s},
          {"cx", m.cx},
          {"cy", m.cy},
          {"k1", m.k1},
          {"k2", m.k2},
          {"p1", m.p1},
          {"p2", m.p2}};
}

Json control_json(const ControlPointReport& point) {
  return {{"name", point.name},
          {"marks", point.marks},
          {"residual_m", point.residual_m},
          {"reprojection_px", point.reprojection_px},
          {"outlier", point.outlier}};
}

/// "photos A..F do not join B..K", where they do not.
std::optional<std::string> parts_of(const AdjustmentReport& report) {
  if (report.components.size() < 2) return std::nullopt;
  std::vector<std::string> others;
  for (std::size_t i = 1; i < report.components.size(); ++i) {
    others.insert(others.end(), report.components[i].begin(), report.components[i].end());
  }
  return fmt::format(
      "{} do not join {}: the map shows the latter alone; give --allow-parts to take that as a "
      "success",
      listed(others), listed(report.components.front()));
}

}  // namespace

Verdict verdict_of(const AerialMap& map, const FlightInput& input, bool allow_parts) {
  Verdict verdict(input.doubts);
  verdict.doubt(map.report.doubts);
  const auto parts = parts_of(map.report);
  if (parts && !allow_parts) verdict.doubt(*parts);
  return verdict;
}

Json summary_of(const AerialMap& map, const FlightInput& input) {
  const AdjustmentReport& report = map.report;
  Json document{
      {"photos", input.found},
      {"used", input.set.photos.size()},
      {"registered", report.registered},
      {"components", report.components},
      {"reprojection_px", report.reprojection_px},
      {"gps_residual_m", or_null(report.position_residual_m)},
      {"ground_below_camera_m", report.ground_below_camera_m},
      {"focal_px", report.cameras.empty() ? Json(nullptr) : Json(report.cameras.front().model.fx)},
      {"scale_source", to_string(report.scale_source)},
      {"scale_sigma", report.scale_sigma},
      {"heading_sigma_deg", report.heading_sigma_deg},
      {"gsd_m", map.ortho.geo.resolution},
      {"photo_pixel_m", report.photo_pixel_m},
      {"crs", input.frame ? Json(input.frame->name()) : Json(nullptr)},
      {"width_px", map.ortho.width()},
      {"height_px", map.ortho.height()},
      {"valid_share", valid_share(map)},
      {"seconds", seconds_of(report)},
      {"warnings", warnings_of(map, input)}};
  return document;
}

Json report_of(const AerialMap& map, const FlightInput& input) {
  const AdjustmentReport& report = map.report;
  Json document = summary_of(map, input);
  document["points"] = report.points;
  document["observations"] = report.observations;
  document["position_rms_m"] = report.position_rms_m ? Json(*report.position_rms_m) : Json(nullptr);
  document["time_offset_s"] = or_null(report.time_offset_s);
  for (const char* list : {"cameras", "control_points", "photo_reports", "pairs"}) {
    document[list] = Json::array();
  }
  for (const auto& camera : report.cameras) document["cameras"].push_back(camera_json(camera));
  for (const auto& point : report.control_points) {
    document["control_points"].push_back(control_json(point));
  }
  for (const auto& photo : report.photos) document["photo_reports"].push_back(photo_json(photo));
  for (const PairReport& pair : report.pairs) {
    document["pairs"].push_back({{"first", pair.first},
                                 {"second", pair.second},
                                 {"matches", pair.matches},
                                 {"epipolar_inliers", pair.epipolar_inliers},
                                 {"homography_inliers", pair.homography_inliers}});
  }
  return document;
}

std::string text_of(const AerialMap& map, const FlightInput& input) {
  const AdjustmentReport& report = map.report;
  std::string text =
      fmt::format("{} of {} photos joined, reprojection {:.2f} px\n", report.registered,
                  input.set.photos.size(), report.reprojection_px);
  if (report.position_residual_m) {
    text += fmt::format("positions differ by {:.2f} m (root mean square, horizontal)\n",
                        *report.position_residual_m);
  }
  text += fmt::format("ground {:.1f} m below the photos, a photo's pixel {:.3f} m\n",
                      report.ground_below_camera_m, report.photo_pixel_m);
  if (report.scale_source == ScaleSource::kNone) {
    text += "scale arbitrary\n";
  } else {
    text += fmt::format("scale from {}, uncertain by {:.2f} %\n", to_string(report.scale_source),
                        100.0 * report.scale_sigma);
  }
  text += fmt::format("map {} x {} px of {} m, {}, {:.0f} % valid\n", map.ortho.width(),
                      map.ortho.height(), map.ortho.geo.resolution,
                      input.frame ? input.frame->name() : "local metres", 100.0 * valid_share(map));
  return text;
}

}  // namespace nadir::cli
