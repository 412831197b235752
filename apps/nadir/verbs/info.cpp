// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/add_verb.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/pipelines/describe.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct InfoOptions {
  fs::path path;
};

bool is_drive(const fs::path& folder) {
  try {
    guess_drive_format(folder);
    return true;
  } catch (const Error&) {
    return false;
  }
}

Json describe(const fs::path& path) {
  static const std::set<std::string> images{".tif", ".tiff", ".vrt", ".png",
                                            ".jpg", ".jpeg", ".asc"};
  static const std::set<std::string> trajectories{".tum", ".txt"};
  if (!is_file(path) && !is_folder(path)) {
    throw Error(ErrorKind::kInput, "there is no such file or folder", path.string());
  }
  if (lower_extension(path) == ".bag") return describe_bag(path);
  if (is_folder(path)) {
    const bool site = is_file(path / "sequence.yaml") || !is_drive(path);
    return site ? describe_site(path) : describe_drive(path);
  }
  if (images.contains(lower_extension(path))) return describe_image(path);
  if (trajectories.contains(lower_extension(path))) return describe_trajectory(path);
  throw Error(
      ErrorKind::kInput, "unknown kind of file", path.string(),
      "info reads sites, recorded drives, ROS 1 bags, GeoTIFF, VRT, PNG, JPEG, ASCII grids (.asc) "
      "and TUM files (.tum, .txt)");
}

/// "key: value" lines, nested by indentation.
std::string readable(const Json& document, const std::string& indent) {
  std::string text;
  for (const auto& [key, value] : document.items()) {
    if (value.is_object()) {
      text += indent + key + ":\n" + readable(value, indent + "  ");
    } else {
      const std::string shown = value.is_null() ? "none" : json_text(value);
      text += indent + key + ": " + (value.is_string() ? value.get<std::string>() : shown) + "\n";
    }
  }
  return text;
}

int run(const InfoOptions& options, const Invocation& invocation) {
  const Json document = describe(options.path);
  invocation.common.json ? print(document) : print(readable(document, ""));
  return 0;
}

}  // namespace

void add_info(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<InfoOptions>(
      program, invocation, "info",
      "Say what a site, a drive, a bag, an orthomosaic, a surface or a trajectory holds", run);
  verb->add_option("path", options.path,
                   "Site or drive folder, ROS 1 bag, GeoTIFF of colours or heights, image, or TUM "
                   "trajectory")
      ->type_name("PATH")
      ->required();
  verb->footer(
      "Examples:\n"
      "  nadir info out/aeroground\n"
      "  nadir info campus.tif --json\n"
      "  nadir info drive.bag\n");
}

}  // namespace nadir::cli
