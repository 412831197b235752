// SPDX-License-Identifier: Apache-2.0
#include "viewer/view_frames.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/trajectories/tum.hpp"
#include "nadir/pipelines/site.hpp"
#include "run_files.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// A CSV file with a head, as write_run() makes it.
class Table {
 public:
  explicit Table(const fs::path& file) : file_(file) {
    std::istringstream text(read_file(file));
    std::string line;
    if (std::getline(text, line)) head_ = cells_of(line);
    while (std::getline(text, line)) {
      if (line.empty()) continue;
      rows_.push_back(cells_of(line));
      if (rows_.back().size() != head_.size())
        throw error(rows_.size() - 1, "the line is too short");
    }
  }

  std::size_t size() const { return rows_.size(); }

  const std::string& text(std::size_t row, const std::string& column) const {
    const auto found = std::ranges::find(head_, column);
    if (found == head_.end()) throw error(0, "has no column '" + column + "'");
    return rows_[row][static_cast<std::size_t>(found - head_.begin())];
  }

  /// NaN where the run wrote that it had no value.
  double number(std::size_t row, const std::string& column) const {
    const std::string& cell = text(row, column);
    if (cell == "nan" || cell == "-nan") return std::numeric_limits<double>::quiet_NaN();
    try {
      return parse_number(cell, column);
    } catch (const Error& reason) {
      throw error(row, reason.what());
    }
  }

  int integer(std::size_t row, const std::string& column) const {
    return checked_integer(number(row, column), column,
                           file_.string() + ":" + std::to_string(row + 2), 0,
                           std::numeric_limits<int>::max());
  }

 private:
  Error error(std::size_t row, const std::string& problem) const {
    return {ErrorKind::kInput, problem, file_.string() + ":" + std::to_string(row + 2),
            "run localize again"};
  }

  fs::path file_;
  std::vector<std::string> head_;
  std::vector<std::vector<std::string>> rows_;
};

Json pose_json(const std::optional<Pose2>& pose) {
  if (!pose) return nullptr;
  return Json::array({pose->x, pose->y, pose->yaw});
}

}  // namespace

std::vector<ViewFrame> read_view_frames(const fs::path& run) {
  const Trajectory trajectory = read_tum(run / "trajectory.tum");
  const std::vector<StampedCovariance> covariances = read_covariances(run / "covariance.csv");
  const Table table(run / "frames.csv");
  const Table timing(run / "timing.csv");
  if (covariances.size() != trajectory.size() || table.size() != trajectory.size() ||
      timing.size() != trajectory.size()) {
    throw Error(ErrorKind::kInput, "its files have different numbers of frames", run.string(),
                "run localize again");
  }
  std::vector<ViewFrame> frames;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    ViewFrame frame;
    frame.number = table.integer(i, "frame");
    frame.stamp = trajectory[i].stamp;
    frame.status = table.text(i, "status");
    frame.map_from_robot = trajectory[i].pose;
    frame.covariance = covariances[i].covariance;
    frame.effective_particles = table.number(i, "effective_particles");
    frame.best_score = table.number(i, "best_score");
    frame.valid_weight = table.number(i, "valid_weight");
    frame.cluster_mass = table.number(i, "cluster_mass");
    frame.clusters = table.integer(i, "clusters");
    frame.resampled = table.text(i, "resampled") == "1";
    frame.decode_ms = timing.number(i, "decode_ms");
    frame.update_ms = timing.number(i, "update_ms");
    frames.push_back(std::move(frame));
  }
  return frames;
}

ViewFrame view_of(const FrameRecord& record, const Sequence& sequence) {
  const Estimate& e = record.estimate;
  ViewFrame frame;
  frame.number = record.number;
  frame.stamp = e.stamp;
  frame.status = to_string(e.status);
  frame.map_from_robot = e.map_from_robot;
  frame.covariance = e.covariance;
  frame.effective_particles = e.effective_particles;
  frame.best_score = e.best_score;
  frame.valid_weight = e.valid_weight;
  frame.cluster_mass = e.cluster_mass;
  frame.clusters = e.clusters;
  frame.resampled = e.resampled;
  frame.decode_ms = 1e3 * record.decode_s;
  frame.update_ms = 1e3 * record.update_s;
  frame.truth = truth_at(sequence, e.stamp);
  return frame;
}

Json to_json(const ViewFrame& frame) {
  const PoseCovariance& c = frame.covariance;
  return {{"number", frame.number},
          {"stamp", frame.stamp.seconds()},
          {"status", frame.status},
          {"pose", pose_json(frame.map_from_robot)},
          {"covariance", {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)}},
          {"effective_particles", frame.effective_particles},
          {"best_score", frame.best_score},
          {"valid_weight", frame.valid_weight},
          {"cluster_mass", frame.cluster_mass},
          {"clusters", frame.clusters},
          {"resampled", frame.resampled},
          {"decode_ms", frame.decode_ms},
          {"update_ms", frame.update_ms},
          {"truth", pose_json(frame.truth)}};
}

}  // namespace nadir::cli
