// SPDX-License-Identifier: Apache-2.0
#include "run_pictures.hpp"

#include <array>
#include <opencv2/imgcodecs.hpp>

#include "nadir/io/image_file_check.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct RunPicture {
  const char* file;
  const char* alternative;
  const char* caption;
};

constexpr std::array<RunPicture, 4> kPictures{{
    {"trajectory.png", "trajectory on the map", "Where the robot went, on the drone's map."},
    {"swarm.png", "particles at several instants",
     "The particles at several instants: a small cloud is a sure one."},
    {"comparison.png", "local maps beside the map",
     "Local maps beside what the map shows at the estimated pose, and both in turn: edges run on "
     "from square to square where the estimate is right."},
    {"coverage.png", "how often the ground was seen",
     "How many local maps show each place, holes left out, laid down at the estimated poses."},
}};

/// What lies in the folder of a run need not be what the run wrote.
bool is_sound_png(const fs::path& file, const std::string& png) {
  try {
    check_image_size(file, png);
    return image_format(png) == ImageFormat::kPng;
  } catch (const Error&) {
    return false;
  }
}

/// A picture of imagery is several times smaller as JPEG, and looks alike.
std::string small_data_uri(const fs::path& file, const std::string& png) {
  constexpr std::size_t kLargestPng = 300'000;  // bytes
  constexpr int kQuality = 88;
  if (png.size() <= kLargestPng || !is_sound_png(file, png)) {
    return html::data_uri("image/png", png);
  }
  const cv::Mat image = cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_COLOR);
  std::vector<std::uint8_t> jpeg;
  if (image.empty() || !cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, kQuality})) {
    return html::data_uri("image/png", png);
  }
  return html::data_uri("image/jpeg", {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
}

}  // namespace

html::Markup pictures_in(const fs::path& folder) {
  std::vector<html::Markup> figures;
  for (const RunPicture& picture : kPictures) {
    const fs::path file = folder / picture.file;
    if (!fs::is_regular_file(file)) continue;
    figures.push_back(html::figure(
        html::image(small_data_uri(file, read_file(file)), picture.alternative), picture.caption));
  }
  if (figures.empty()) return {};
  return html::heading("On the map") + html::side_by_side(figures);
}

}  // namespace nadir::cli
