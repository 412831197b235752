// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace nadir::cli {

/// Simulates a drive and writes it as a site.
void write_demo_site(const std::filesystem::path& site, std::uint64_t seed);

}  // namespace nadir::cli
