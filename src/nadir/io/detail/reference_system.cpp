// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/reference_system.hpp"

#include <algorithm>
#include <string_view>

namespace nadir {
namespace {

constexpr std::size_t kLongestText = 65'536;
constexpr std::string_view kEpsg = "EPSG:";

/// "32632" and "25832+7837".
bool is_code(std::string_view text) {
  return !text.empty() && text.size() <= 13 && text.front() != '+' && text.back() != '+' &&
         text.find_first_not_of("0123456789+") == std::string_view::npos;
}

/// PROJCS[...], GEOGCRS[...] and the like.
bool looks_like_wkt(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const std::size_t bracket = text.find_first_of("[(");
  return bracket != std::string_view::npos && bracket > 0 &&
         text.substr(0, bracket).find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") ==
             std::string_view::npos;
}

OGRErr set_from(const std::string& text, OGRSpatialReference& crs) {
  if (text.size() > kLongestText || text.find('\0') != std::string::npos)
    return OGRERR_CORRUPT_DATA;
  if (text.starts_with(kEpsg) && is_code(std::string_view(text).substr(kEpsg.size()))) {
    return crs.SetFromUserInput(text.c_str(),
                                OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get());
  }
  if (text.starts_with("+proj=") || text.starts_with("+init=")) {
    return crs.importFromProj4(text.c_str());
  }
  return looks_like_wkt(text) ? crs.importFromWkt(text.c_str()) : OGRERR_UNSUPPORTED_SRS;
}

}  // namespace

bool set_reference_system(const std::string& text, OGRSpatialReference& crs) {
  if (set_from(text, crs) != OGRERR_NONE) return false;
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return true;
}

}  // namespace nadir
