// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "aerial_mapping/flight.hpp"

namespace nadir::testing {

/// Photos of the aerial tests' painted ground as files, with the tags of a drone, near 46 N 8 E.
/// Returns them in the order of the flight.
std::vector<std::filesystem::path> write_flight(const std::filesystem::path& folder,
                                                const test::FlightPlan& plan);

}  // namespace nadir::testing
