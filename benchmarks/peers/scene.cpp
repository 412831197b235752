// SPDX-License-Identifier: Apache-2.0
#include "peers/scene.hpp"

#include <fstream>
#include <map>
#include <string>

#include "map_matching/random_maps.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/aeroground_map.hpp"

namespace nadir::bench {
namespace {

constexpr double kMapResolution = 0.1 / 3.54;
constexpr double kLocalResolution = 0.1;

std::filesystem::path root(const std::filesystem::path& folder) {
  const std::filesystem::path inner = folder / "aeroground";
  return std::filesystem::exists(inner / "truth.txt") ? inner : folder;
}

struct Truth {
  double column = 0.0;
  double row = 0.0;
  double rotation_deg = 0.0;  ///< clockwise
};

std::map<int, Truth> read_truth(const std::filesystem::path& folder) {
  std::ifstream file(root(folder) / "truth.txt");
  if (!file) {
    throw Error(ErrorKind::kInput, "there is no truth.txt", root(folder).string(),
                "give the folder of the Aero-Ground run");
  }
  std::map<int, Truth> lines;
  int frame = 0;
  Truth line;
  double scale = 0.0;
  while (file >> frame >> line.column >> line.row >> line.rotation_deg >> scale) {
    lines[frame] = line;
  }
  return lines;
}

}  // namespace

Scene synthetic_scene() {
  const test::Texture texture(1);
  Scene scene;
  scene.truth = {20.0, 57.0, radians(-94.0)};
  scene.map = test::render(texture, 416, 1158, {0.0, 115.8, 0.1, {}}, Pose2{});
  test::punch_holes(scene.map, 2, 0.02);
  scene.local = test::render(texture, 180, 180, test::centred(180, 180, 0.1), scene.truth);
  test::punch_holes(scene.local, 1, 0.35);
  return scene;
}

std::vector<int> truth_frames(const std::filesystem::path& folder) {
  std::vector<int> frames;
  for (const auto& line : read_truth(folder)) frames.push_back(line.first);
  return frames;
}

Scene aeroground_scene(const std::filesystem::path& folder, int frame) {
  const Truth truth = read_truth(folder).at(frame);
  Scene scene;
  scene.map.image = without_equal_channels(read_image(root(folder) / "global_no_cars.jpg"));
  scene.map.valid = seen_by_drone(scene.map.image);
  scene.map.geo = {0.0, scene.map.height() * kMapResolution, kMapResolution, {}};
  scene.local.image =
      without_equal_channels(read_image(root(folder) / "local" / (std::to_string(frame) + ".jpg")));
  scene.local.valid = seen_by_robot(scene.local.image);
  scene.local.geo = test::centred(scene.local.width(), scene.local.height(), kLocalResolution);
  scene.truth = {scene.map.geo.x_at(truth.column), scene.map.geo.y_at(truth.row),
                 -radians(truth.rotation_deg)};
  return scene;
}

}  // namespace nadir::bench
