// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "run_doubts.hpp"
#include "run_record.hpp"

namespace nadir::cli {

/// A run in words, for who does not want to read tables.
struct RunWords {
  std::string headline;
  bool good = true;
  std::vector<std::string> warnings;
};

RunWords words_of(const RunRecord& run);

/// "3-7, 9" for 3, 4, 5, 6, 7, 9; of many stretches the first ones.
std::string stretches(const std::vector<int>& numbers);

/// A status of frames.csv in words; one that this version does not know as it is.
std::string status_in_words(const std::string& status);

/// Two standard deviations of the heading, radians; of the position: run_doubts.hpp.
double two_sigma_yaw_rad(const PoseCovariance& covariance);

}  // namespace nadir::cli
