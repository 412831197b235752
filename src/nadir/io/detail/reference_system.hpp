// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ogr_spatialref.h>

#include <string>

namespace nadir {

/// Sets `crs` from "EPSG:code" (also "EPSG:code+code", with a vertical one), a PROJ string that
/// begins with +proj= or +init=, or WKT; x is east or longitude. False for all else, and for texts
/// longer than 64 KiB. GDAL's SetFromUserInput would also open files, fetch addresses of the
/// network and search PROJ's database for names, which a text out of a file must not make it do.
bool set_reference_system(const std::string& text, OGRSpatialReference& crs);

}  // namespace nadir
