// SPDX-License-Identifier: Apache-2.0
#include "run_charts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "nadir/core/angle.hpp"
#include "nadir/report/charts.hpp"
#include "run_words.hpp"

namespace nadir::cli {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kTime = "time since the first frame, s";

using Value = std::function<double(const ViewFrame&)>;

std::vector<double> over(const RunRecord& run, const Value& value) {
  std::vector<double> values;
  for (const ViewFrame& frame : run.frames) values.push_back(value(frame));
  return values;
}

/// Whole nanoseconds are subtracted: stamps may count from 1970.
std::vector<double> seconds(const RunRecord& run) {
  const Stamp first = run.frames.front().stamp;
  return over(run, [first](const ViewFrame& frame) {
    return Stamp{frame.stamp.nanoseconds - first.nanoseconds}.seconds();
  });
}

Curve curve(const RunRecord& run, const std::string& name, const Value& value) {
  return {name, seconds(run), over(run, value)};
}

/// From `low` to `high`, both of a frame.
Band band(const RunRecord& run, const Value& low, const Value& high) {
  return {"2 sigma", seconds(run), over(run, low), over(run, high)};
}

double zero(const ViewFrame& /*frame*/) { return 0.0; }

double sigma_position(const ViewFrame& frame) { return two_sigma_m(frame.covariance); }
double sigma_yaw(const ViewFrame& frame) { return degrees(two_sigma_yaw_rad(frame.covariance)); }

double position_error(const ViewFrame& frame) {
  if (!frame.truth) return kNan;
  return std::hypot(frame.map_from_robot.x - frame.truth->x,
                    frame.map_from_robot.y - frame.truth->y);
}

double yaw_error(const ViewFrame& frame) {
  if (!frame.truth) return kNan;
  return std::abs(degrees(wrap_angle(frame.map_from_robot.yaw - frame.truth->yaw)));
}

Chart errors(const RunRecord& run) {
  return {
      "error",
      svg_panels({{"position error, m",
                   {curve(run, "error", position_error)},
                   {band(run, zero, sigma_position)}},
                  {"heading error, \u00b0",
                   {curve(run, "error", yaw_error)},
                   {band(run, zero, sigma_yaw)}}},
                 kTime, "Error and uncertainty over time"),
      "How far the estimate is from the truth, and how far the filter thinks that it may be: an "
      "honest filter stays in the band in 19 of 20 frames. The band of the position is that of "
      "its most uncertain direction."};
}

/// Signed, so that a constant offset is told from noise.
Chart offsets(const RunRecord& run) {
  const auto panel = [&](const char* label, double Pose2::*part, int row) {
    const Value sigma = [row](const ViewFrame& frame) {
      return 2.0 * std::sqrt(std::max(0.0, frame.covariance(row, row)));
    };
    const Value error = [part](const ViewFrame& frame) {
      return frame.truth ? frame.map_from_robot.*part - (*frame.truth).*part : kNan;
    };
    return Panel{label,
                 {curve(run, "estimate - truth", error)},
                 {band(
                     run, [sigma](const ViewFrame& frame) { return -sigma(frame); }, sigma)}};
  };
  return {
      "offset",
      svg_panels({panel("east, m", &Pose2::x, 0), panel("north, m", &Pose2::y, 1)}, kTime,
                 "Error to the east and to the north over time"),
      "The error with its sign. What stays on one side is an offset, of the map or of the truth."};
}

Chart uncertainty(const RunRecord& run) {
  return {"uncertainty",
          svg_panels({{"2 sigma of the position, m", {curve(run, "", sigma_position)}},
                      {"2 sigma of the heading, \u00b0", {curve(run, "", sigma_yaw)}}},
                     kTime, "Uncertainty over time"),
          "What the filter says of its own error, in the most uncertain direction."};
}

Chart filter(const RunRecord& run) {
  return {
      "filter",
      svg_panels(
          {{"effective particles",
            {curve(run, "", [](const ViewFrame& f) { return f.effective_particles; })}},
           {"best score", {curve(run, "", [](const ViewFrame& f) { return f.best_score; })}},
           {"share",
            {curve(run, "local map compared", [](const ViewFrame& f) { return f.valid_weight; }),
             curve(run, "heaviest cluster", [](const ViewFrame& f) { return f.cluster_mass; })}}},
          kTime, "Particles and scores over time"),
      "How many particles carry the weight (N_eff), how well the best one matches, how much of "
      "the local map could be compared, and how much of the weight is in one place. Gaps: "
      "nothing was compared."};
}

Chart times(const RunRecord& run) {
  return {
      "run_time",
      svg_rows({{"reading", over(run, [](const ViewFrame& f) { return f.decode_ms; })},
                {"localizing", over(run, [](const ViewFrame& f) { return f.update_ms; })}},
               "time of a frame, ms", "Run time by stage"),
      "Box: half of the frames; whiskers: 5 to 95 %; line and number: median; dot: slowest. Where "
      "a drive is mapped on the way, reading is that too."};
}

Chart times_over_run(const RunRecord& run) {
  return {"run_time_over_run",
          svg_panels({{"time of a frame, ms",
                       {curve(run, "localizing", [](const ViewFrame& f) { return f.update_ms; }),
                        curve(run, "reading", [](const ViewFrame& f) { return f.decode_ms; })}}},
                     kTime, "Run time over the run"),
          "The first frame starts the filter, with more particles than the others have."};
}

}  // namespace

std::vector<Chart> charts_of(const RunRecord& run) {
  std::vector<Chart> charts;
  if (run.judgement) {
    charts.push_back(errors(run));
    charts.push_back(offsets(run));
  } else {
    charts.push_back(uncertainty(run));
  }
  charts.push_back(times(run));
  charts.push_back(times_over_run(run));
  charts.push_back(filter(run));
  return charts;
}

}  // namespace nadir::cli
