// SPDX-License-Identifier: Apache-2.0
#include "libraries.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/version.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

#include "nadir/io/gdal_info.hpp"
#include "nadir/map_matching/cuda_status.hpp"
#include "text_table.hpp"

namespace nadir::cli {

std::string program_version() { return NADIR_VERSION; }

std::vector<Library> libraries() {
  std::vector<Library> libraries{
      {"Eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION),
       "MPL-2.0"},
      {"OpenCV", cv::getVersionString(), "Apache-2.0"},
      {"GDAL", gdal_version(), "MIT"},
      {"PROJ", proj_version(), "MIT"},
      {"oneTBB", TBB_runtime_version(), "Apache-2.0"},
      {"pocketfft", "", "BSD-3-Clause"},
      {"yaml-cpp", NADIR_YAML_CPP_VERSION, "MIT"},
      {"CLI11", CLI11_VERSION, "BSD-3-Clause"},
      {"nlohmann-json",
       fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                   NLOHMANN_JSON_VERSION_PATCH),
       "MIT"},
      {"fmt",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100),
       "MIT"},
  };
  const std::string cuda = cuda_version();
  if (!cuda.empty()) libraries.push_back({"CUDA", cuda, "NVIDIA EULA"});
  return libraries;
}

std::string version_text() {
  std::vector<std::vector<std::string>> rows{{"library", "version", "licence"}};
  for (const Library& library : libraries()) {
    rows.push_back(
        {library.name, library.version.empty() ? "-" : library.version, library.licence});
  }
  return "nadir " + program_version() + ", Apache-2.0\n\n" + text_table(rows);
}

Json version_document() {
  Json document{{"nadir", program_version()}, {"licence", "Apache-2.0"}};
  document["libraries"] = Json::array();
  for (const Library& library : libraries()) {
    document["libraries"].push_back(
        {{"name", library.name}, {"version", library.version}, {"licence", library.licence}});
  }
  return document;
}

}  // namespace nadir::cli
