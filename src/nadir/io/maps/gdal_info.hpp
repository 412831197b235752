// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace nadir {

/// What the GDAL and the PROJ that this program runs with can do.
std::string gdal_version();
std::string proj_version();
bool has_gdal_driver(const std::string& name);
/// False where PROJ does not find its database.
bool knows_epsg_codes();

}  // namespace nadir
