// SPDX-License-Identifier: Apache-2.0
#include "run_files.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <sstream>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/trajectories/tum.hpp"

namespace nadir::cli {
namespace {

constexpr const char* kCovarianceHead =
    "stamp_s,xx_m2,xy_m2,xyaw_mrad,yy_m2,yyaw_mrad,yawyaw_rad2\n";

/// The upper triangle, row by row.
constexpr std::array<std::pair<int, int>, 6> kUpperTriangle{
    {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

std::string covariance_csv(const std::vector<StampedCovariance>& covariances) {
  std::string text = kCovarianceHead;
  for (const auto& [stamp, covariance] : covariances) {
    text += to_string(stamp);
    for (const auto& [row, column] : kUpperTriangle)
      text += "," + nadir::to_text(covariance(row, column));
    text += "\n";
  }
  return text;
}

std::string frames_csv(const std::vector<FrameRecord>& records) {
  std::string text =
      "frame,stamp_s,status,effective_particles,best_score,valid_weight,cluster_mass,clusters,"
      "resampled\n";
  for (const FrameRecord& record : records) {
    const Estimate& e = record.estimate;
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", record.number, to_string(e.stamp),
                        to_string(e.status), nadir::to_text(e.effective_particles),
                        nadir::to_text(e.best_score), nadir::to_text(e.valid_weight),
                        nadir::to_text(e.cluster_mass), e.clusters, e.resampled ? 1 : 0);
  }
  return text;
}

std::string timing_csv(const std::vector<FrameRecord>& records) {
  std::string text = "frame,decode_ms,update_ms\n";
  for (const FrameRecord& record : records) {
    text += fmt::format("{},{:.3f},{:.3f}\n", record.number, 1e3 * record.decode_s,
                        1e3 * record.update_s);
  }
  return text;
}

StampedCovariance parse_covariance(const std::string& line, const std::string& where) {
  std::istringstream cells(line);
  std::string cell;
  std::getline(cells, cell, ',');
  const auto stamp = parse_stamp(cell);
  if (!stamp) throw Error(ErrorKind::kInput, "'" + cell + "' is not a stamp", where);
  StampedCovariance result{*stamp, {}};
  for (const auto& [row, column] : kUpperTriangle) {
    if (!std::getline(cells, cell, ',')) {
      throw Error(ErrorKind::kInput, "the line is too short", where, "seven values are expected");
    }
    try {
      result.covariance(row, column) = parse_number(cell, "the covariance");
    } catch (const Error& error) {
      throw Error(ErrorKind::kInput, error.what(), where);
    }
    result.covariance(column, row) = result.covariance(row, column);
  }
  return result;
}

}  // namespace

std::vector<StampedCovariance> covariances_of(const RunResult& result) {
  std::vector<StampedCovariance> covariances;
  for (const FrameRecord& record : result.records) {
    covariances.push_back({record.estimate.stamp, record.estimate.covariance});
  }
  return covariances;
}

void write_run(const std::filesystem::path& folder, const RunResult& result,
               const Trajectory& truth) {
  create_folder(folder);
  write_tum(folder / "trajectory.tum", result.trajectory());
  write_file(folder / "covariance.csv", covariance_csv(covariances_of(result)));
  write_file(folder / "frames.csv", frames_csv(result.records));
  write_file(folder / "timing.csv", timing_csv(result.records));
  if (!truth.empty()) write_tum(folder / "truth.tum", truth);
}

std::vector<StampedCovariance> read_covariances(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::kInput, "cannot read the file", path.string());
  std::vector<StampedCovariance> covariances;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (number == 1 || line.empty()) continue;
    covariances.push_back(parse_covariance(line, path.string() + ":" + std::to_string(number)));
  }
  return covariances;
}

}  // namespace nadir::cli
