// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/libraries.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/version.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

#include "nadir/io/maps/gdal_info.hpp"
#include "nadir/map_matching/cuda_status.hpp"

namespace nadir {

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
      {"CLI11", NADIR_CLI11_VERSION, "BSD-3-Clause"},
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

}  // namespace nadir
