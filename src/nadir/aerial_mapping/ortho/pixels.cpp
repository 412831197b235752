// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/pixels.hpp"

#include <cstring>

#include "nadir/core/error.hpp"

namespace nadir::aerial {

Raster<std::uint8_t> load_checked(const PhotoSet& set, std::size_t photo) {
  const MappingPhoto& from = set.photos[photo];
  const CameraPrior& camera = set.cameras[from.camera];
  Raster<std::uint8_t> pixels = from.load();
  if (pixels.width() == camera.width && pixels.height() == camera.height) return pixels;
  throw Error(ErrorKind::kInput,
              "the photo is " + std::to_string(pixels.width()) + " x " +
                  std::to_string(pixels.height()) + " px, its camera has " +
                  std::to_string(camera.width) + " x " + std::to_string(camera.height),
              from.name, "give each size of photos a camera of its own");
}

cv::Mat rgb_of(const PhotoSet& set, std::size_t photo) {
  const Raster<std::uint8_t> pixels = load_checked(set, photo);
  cv::Mat rgb(pixels.height(), pixels.width(), CV_8UC3);
  for (int row = 0; row < pixels.height(); ++row) {
    const auto source = pixels.row(row);
    auto* to = rgb.ptr<std::uint8_t>(row);
    if (pixels.channels() == 3) {
      std::memcpy(to, source.data(), source.size());
      continue;
    }
    for (int column = 0; column < pixels.width(); ++column)
      for (int channel = 0; channel < 3; ++channel)
        to[3 * column + channel] = pixels.at(column, row, 0);
  }
  return rgb;
}

}  // namespace nadir::aerial
