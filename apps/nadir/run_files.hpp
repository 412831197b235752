// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "localize_run.hpp"
#include "nadir/evaluation/consistency.hpp"

namespace nadir::cli {

/// Writes trajectory.tum, covariance.csv and frames.csv, which are the same bytes for the same
/// seed, and timing.csv, which is not; truth.tum where there is a truth.
void write_run(const std::filesystem::path& folder, const RunResult& result,
               const Trajectory& truth = {});

std::vector<StampedCovariance> covariances_of(const RunResult& result);

/// Reads covariance.csv. Throws Error (input) with file:line.
std::vector<StampedCovariance> read_covariances(const std::filesystem::path& path);

}  // namespace nadir::cli
