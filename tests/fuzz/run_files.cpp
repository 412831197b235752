// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "fuzz/fuzz_run.hpp"
#include "fuzz/fuzz_target.hpp"
#include "run_files.hpp"
#include "run_record.hpp"

// trajectory.tum, covariance.csv, frames.csv, timing.csv and truth.tum of a run.
NADIR_FUZZ_TARGET(run_files) {
  const std::filesystem::path run = nadir::fuzz::scratch_folder() / "files_of_run";
  const auto parts = nadir::fuzz::parts_of(input, 5);
  nadir::fuzz::as_file("files_of_run/trajectory.tum", parts[0]);
  nadir::fuzz::as_file("files_of_run/covariance.csv", parts[1]);
  nadir::fuzz::as_file("files_of_run/frames.csv", parts[2]);
  nadir::fuzz::as_file("files_of_run/timing.csv", parts[3]);
  nadir::fuzz::as_file("files_of_run/truth.tum", parts[4]);
  nadir::fuzz::attempt([&] { nadir::cli::read_covariances(run / "covariance.csv"); });
  const auto record = nadir::cli::read_run(run, nadir::Json::object());
  for (const auto& frame : record.frames) {
    nadir::fuzz::require(frame.map_from_robot.is_finite(), "a pose is not finite");
  }
}
