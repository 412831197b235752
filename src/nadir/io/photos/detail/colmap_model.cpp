// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "nadir/io/detail/text_table.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/photos/detail/pose_formats.hpp"

// COLMAP's text model: cameras.txt `ID MODEL WIDTH HEIGHT PARAMS...`; images.txt in pairs of lines,
// `ID QW QX QY QZ TX TY TZ CAMERA NAME` and the image points. Its pixel (0, 0) is the outer corner.
namespace nadir {
namespace {

CameraModel camera_of(const TextRow& row) {
  const std::vector<std::string>& f = row.words;
  if (f.size() < 5) throw Error(ErrorKind::kInput, "is no camera of COLMAP", row.where);
  std::vector<double> p;
  for (std::size_t i = 4; i < f.size(); ++i)
    p.push_back(number_in_file(f[i], "parameter", row.where));
  const std::map<std::string, std::size_t> parameters{{"SIMPLE_PINHOLE", 3}, {"PINHOLE", 4},
                                                      {"SIMPLE_RADIAL", 4},  {"RADIAL", 5},
                                                      {"OPENCV", 8},         {"FULL_OPENCV", 12}};
  const auto known = parameters.find(f[1]);
  if (known == parameters.end() || p.size() != known->second) {
    throw Error(ErrorKind::kInput, "the camera model " + f[1] + " cannot be expressed", row.where,
                "use SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL or OPENCV, or undistort");
  }
  CameraModel camera;
  camera.width = checked_side(number_in_file(f[2], "width", row.where), "width", row.where);
  camera.height = checked_side(number_in_file(f[3], "height", row.where), "height", row.where);
  const bool one_focal = f[1].starts_with("SIMPLE") || f[1] == "RADIAL";
  const std::size_t centre = one_focal ? 1 : 2;
  camera.fx = p[0];
  camera.fy = one_focal ? p[0] : p[1];
  camera.cx = p[centre] - 0.5;
  camera.cy = p[centre + 1] - 0.5;
  if (p.size() > centre + 2) camera.k1 = p[centre + 2];
  if (p.size() > centre + 3) camera.k2 = p[centre + 3];
  if (p.size() >= 8) {
    camera.p1 = p[6];
    camera.p2 = p[7];
  }
  if (p.size() == 12) camera.k3 = p[8];
  if (p.size() == 12 && (p[9] != 0.0 || p[10] != 0.0 || p[11] != 0.0)) {
    throw Error(ErrorKind::kInput, "a rational distortion cannot be expressed", row.where,
                "use the camera model OPENCV");
  }
  return camera;
}

/// What follows so many words: a name may hold blanks.
std::string after_words(const std::string& text, int count) {
  constexpr const char* kBlanks = " \t";
  std::size_t at = 0;
  for (int i = 0; i < count && at != std::string::npos; ++i) {
    at = text.find_first_not_of(kBlanks, text.find_first_of(kBlanks, at));
  }
  return at == std::string::npos ? std::string{} : text.substr(at);
}

}  // namespace

ImportedPoses read_colmap_model(const std::filesystem::path& folder) {
  std::map<std::string, CameraModel> cameras;
  for (const TextRow& row : read_text_table(folder / "cameras.txt")) {
    if (!row.text.starts_with('#')) cameras.emplace(row.words.front(), camera_of(row));
  }
  ImportedPoses result;
  for (const TextRow& row : read_text_table(folder / "images.txt")) {
    const std::vector<std::string>& f = row.words;
    // Lines of image points are threes of numbers; a pose has nine and the name of a file.
    if (row.text.starts_with('#') || f.size() < 10 || !cameras.contains(f[8])) continue;
    const std::string name = after_words(row.text, 9);
    if (name.find_first_not_of("0123456789.-+e \t") == std::string::npos) continue;
    const auto value = [&](std::size_t i) { return number_in_file(f[i], "number", row.where); };
    Transform3<frames::Camera, frames::Map> camera_from_map;
    camera_from_map.rotation =
        Eigen::Quaterniond(value(1), value(2), value(3), value(4)).normalized();
    camera_from_map.translation = {value(5), value(6), value(7)};
    result.poses.push_back({name, cameras.at(f[8]), camera_from_map.inverse()});
  }
  if (result.poses.empty()) throw input_error(folder / "images.txt", "holds no poses");
  return result;
}

}  // namespace nadir
