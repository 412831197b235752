// SPDX-License-Identifier: Apache-2.0
#include "ground_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "nadir/core/options.hpp"
#include "nadir/report/text_table.hpp"

namespace nadir::cli {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<std::pair<const char*, double StageTimes::*>, 7> kStages{
    {{"rectify", &StageTimes::rectify},
     {"depth", &StageTimes::depth},
     {"points", &StageTimes::points},
     {"aggregate", &StageTimes::aggregate},
     {"fuse", &StageTimes::fuse},
     {"clean", &StageTimes::clean},
     {"colour", &StageTimes::colour}}};

double median(std::vector<double> values) {
  if (values.empty()) return kUnknown;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::vector<std::pair<std::string, double>> medians(const std::vector<MappedFrame>& frames,
                                                    const std::vector<double>& render_ms) {
  const auto over = [&](auto ms_of) {
    std::vector<double> values;
    for (const MappedFrame& frame : frames) {
      if (frame.odom_from_robot) values.push_back(ms_of(frame));
    }
    return median(values);
  };
  std::vector<std::pair<std::string, double>> result;
  result.emplace_back("decode", over([](const MappedFrame& frame) { return frame.decode_ms; }));
  for (const auto& [name, member] : kStages) {
    result.emplace_back(name, over([stage = member](const MappedFrame& frame) {
                          return frame.statistics.ms.*stage;
                        }));
  }
  result.emplace_back("render", median(render_ms));
  return result;
}

double length_of(const std::vector<MappedFrame>& frames) {
  double length = 0.0;
  const MappedFrame* before = nullptr;
  for (const MappedFrame& frame : frames) {
    if (!frame.odom_from_robot) continue;
    if (before != nullptr) {
      length += (frame.odom_from_robot->translation - before->odom_from_robot->translation).norm();
    }
    before = &frame;
  }
  return length;
}

std::string known_percent(double share) { return std::isfinite(share) ? percent(share) : "-"; }

std::string pose_check(const PoseFit& fit) {
  if (fit.pairs == 0) return "not judged";
  return fmt::format("{:.1f} px off, {} of {} pairs fit", fit.offset_px, fit.pairs - fit.misfits,
                     fit.pairs);
}

double shift_of(const MapComparison& comparison) {
  return std::hypot(comparison.shift_columns, comparison.shift_rows);
}

}  // namespace

GroundReport report_of(const DriveMapping& mapping, const std::vector<double>& render_ms,
                       int low_coverage) {
  GroundReport report;
  report.frames = static_cast<int>(mapping.frames().size());
  report.local_maps = static_cast<int>(render_ms.size());
  report.low_coverage = low_coverage;
  report.length_m = length_of(mapping.frames());
  const auto square = mapping.last_square();
  report.coverage_18m = square ? coverage_of(*square, 18.0) : kUnknown;
  report.coverage_9m = square ? coverage_of(*square, 9.0) : kUnknown;
  report.pose_fit = mapping.pose_fit();
  report.comparison = mapping.comparison();
  report.ms_per_frame = medians(mapping.frames(), render_ms);
  report.doubts = mapping.doubts(report.comparison);
  report.warnings = report.doubts;
  const std::vector<std::string> others = mapping.warnings();
  report.warnings.insert(report.warnings.end(), others.begin(), others.end());
  return report;
}

Json to_json(const GroundReport& report) {
  Json document{{"frames", report.frames},
                {"coverage_18m", report.coverage_18m},
                {"coverage_9m", report.coverage_9m}};
  if (report.comparison) {
    document["odd_even_zncc"] = report.comparison->zncc;
    document["odd_even_shift_px"] = shift_of(*report.comparison);
    document["height_disagreement_m"] = {{"median", report.comparison->height_median_m},
                                         {"p90", report.comparison->height_p90_m}};
  }
  document["ms_per_frame"] = Json::object();
  for (const auto& [stage, ms] : report.ms_per_frame) document["ms_per_frame"][stage] = ms;
  document["warnings"] = report.warnings;
  return document;
}

std::string to_table(const GroundReport& report) {
  std::string text =
      fmt::format("{} frames, {:.1f} m driven, {} local maps ({} of low coverage)\n", report.frames,
                  report.length_m, report.local_maps, report.low_coverage);
  std::vector<std::vector<std::string>> rows{
      {"at the last pose", "value"},
      {"coverage of 18 m", known_percent(report.coverage_18m)},
      {"coverage of 9 m", known_percent(report.coverage_9m)},
      {"pose check", pose_check(report.pose_fit)}};
  if (const auto& comparison = report.comparison) {
    rows.push_back({"odd/even ZNCC", fixed(comparison->zncc, 3)});
    rows.push_back({"odd/even shift, px", fixed(shift_of(*comparison), 1)});
    rows.push_back({"odd/even height, median, cm", fixed(100.0 * comparison->height_median_m, 1)});
    rows.push_back({"odd/even height, p90, cm", fixed(100.0 * comparison->height_p90_m, 1)});
  }
  text += text_table(rows);
  rows = {{"stage", "median ms"}};
  double sum = 0.0;
  for (const auto& [stage, ms] : report.ms_per_frame) {
    rows.push_back({stage, fixed(ms, 1)});
    if (std::isfinite(ms)) sum += ms;
  }
  rows.push_back({"sum", fixed(sum, 1)});
  text += text_table(rows);
  for (const std::string& warning : report.warnings) text += "warning: " + warning + "\n";
  return text;
}

std::string frames_csv(const std::vector<MappedFrame>& frames) {
  std::string text =
      "frame,stamp_s,status,points_in,no_disparity,range,height,outside,texture,sparse,gate,"
      "cells_new,cells_updated,cells_rejected,cells_replaced,cells_cleared,innovation_median_m,"
      "innovation_p90_m,exposure_gain,map_dropped\n";
  for (const MappedFrame& frame : frames) {
    const FrameStatistics& s = frame.statistics;
    const DroppedPoints& d = s.dropped;
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", frame.number,
        to_string(frame.stamp), frame.odom_from_robot ? to_string(s.status) : "no_pose",
        s.points_in, d.no_disparity, d.range, d.height, d.outside, d.texture, d.sparse, d.gate,
        s.cells_new, s.cells_updated, s.cells_rejected, s.cells_replaced, s.cells_cleared,
        nadir::to_text(s.innovation_median_m), nadir::to_text(s.innovation_p90_m),
        nadir::to_text(s.exposure_gain), s.map_dropped ? 1 : 0);
  }
  return text;
}

}  // namespace nadir::cli
