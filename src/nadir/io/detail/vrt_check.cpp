// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/vrt_check.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <string_view>

#include "nadir/io/detail/gdal_support.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/shell.hpp"

namespace nadir {
namespace {

std::string lower_name(const char* name) { return CPLString(name).tolower(); }

/// GDAL takes names in any letters.
const std::set<std::string, std::less<>>& elements() {
  static const std::set<std::string, std::less<>> names{
      // of the whole and of a band
      "vrtdataset", "srs", "geotransform", "gcplist", "gcp", "metadata", "mdi", "overviewlist",
      "maskband", "vrtrasterband", "description", "unittype", "offset", "scale", "categorynames",
      "category", "colorinterp", "colortable", "entry", "nodatavalue", "hidenodatavalue",
      "histograms", "histitem", "histmin", "histmax", "bucketcount", "includeoutofrange",
      "approximate", "histcounts", "blockxsize", "blockysize",
      // of what lies in it
      "overview", "simplesource", "complexsource", "averagedsource", "sourcefilename", "sourceband",
      "sourceproperties", "srcrect", "dstrect", "nodata", "usemaskband", "lut", "scaleoffset",
      "scaleratio", "exponent", "srcmin", "srcmax", "dstmin", "dstmax", "colortablecomponent"};
  return names;
}

class VrtWalk {
 public:
  explicit VrtWalk(const std::filesystem::path& path) : path_(path) {}

  void walk(const CPLXMLNode* node, int depth) {
    constexpr int kDeepest = 16;
    for (; node != nullptr; node = node->psNext) {
      if (node->eType == CXT_Attribute) look_at_attribute(*node);
      if (node->eType != CXT_Element) continue;
      const std::string_view written = node->pszValue;
      if (written.starts_with('?') || written.starts_with('!')) continue;  // of XML itself
      const std::string name = lower_name(node->pszValue);
      if (!elements().contains(name)) refuse(node->pszValue);
      if (depth > kDeepest) refuse("elements in elements");
      if (name == "vrtdataset" && depth > 1) refuse("a VRTDataset inside");
      if (name == "sourcefilename") take_source(*node);
      walk(node->psChild, depth + 1);
    }
  }

  std::vector<std::filesystem::path> sources() const { return {sources_.begin(), sources_.end()}; }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw input_error(
        path_, "a VRT with " + what + " is not read",
        fmt::format("write it as a GeoTIFF: gdal_translate {} out.tif", shell_quoted_path(path_)));
  }

  void look_at_attribute(const CPLXMLNode& attribute) const {
    if (lower_name(attribute.pszValue) != "subclass") return;
    const std::string value = attribute.psChild == nullptr ? "" : attribute.psChild->pszValue;
    if (value != "VRTSourcedRasterBand") refuse(value);
  }

  void take_source(const CPLXMLNode& element) {
    std::string name;
    bool beside = false;
    for (const CPLXMLNode* child = element.psChild; child != nullptr; child = child->psNext) {
      if (child->eType == CXT_Text) name += child->pszValue;
      if (child->eType == CXT_Attribute && lower_name(child->pszValue) == "relativetovrt") {
        beside = child->psChild != nullptr && std::string_view(child->psChild->pszValue) != "0";
      }
    }
    check_name(name);
    const std::filesystem::path source =
        (beside ? path_.parent_path() : std::filesystem::path()) / name;
    if (!is_file(source)) {
      throw input_error(path_, "it names '" + name + "', which is no file",
                        "put the files of a mosaic where it says they are");
    }
    sources_.insert(source);
  }

  /// Notations of GDAL are no names of files, though such a file might be there: "NETCDF:a:b",
  /// "/vsicurl/...", a document in place of a name.
  void check_name(const std::string& name) const {
    const std::size_t word = static_cast<std::size_t>(
        std::find_if_not(name.begin(), name.end(),
                         [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; }) -
        name.begin());
    const bool notation = name.empty() || name.front() == '<' || name.front() == '{' ||
                          (word < name.size() && name[word] == ':') ||
                          lower_name(name.c_str()).find("/vsi") != std::string::npos;
    if (notation) refuse("the source '" + name + "', which is no local file,");
  }

  const std::filesystem::path& path_;
  std::set<std::filesystem::path> sources_;
};

}  // namespace

std::vector<std::filesystem::path> vrt_sources(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 26U;
  if (std::filesystem::file_size(path) > kMostBytes) {
    throw input_error(
        path, "it is a VRT of more than 64 MiB",
        "write it as a GeoTIFF: gdal_translate " + shell_quoted_path(path) + " out.tif");
  }
  const GdalErrors errors;
  const XmlTree tree(CPLParseXMLString(read_file(path).c_str()));
  if (!tree) {
    throw input_error(path, "its XML cannot be read: " + errors.first_failure(),
                      "copy or make it again");
  }
  VrtWalk walk(path);
  walk.walk(tree.get(), 1);
  return walk.sources();
}

}  // namespace nadir
