// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "nadir/core/photo.hpp"

namespace nadir {

/// The photos of a folder, sorted: its JPEG files; where it has none, its PNG and TIFF files; where
/// it has neither, those of its subfolders in the same order. (A map that was written beside the
/// photos is none of them.) Throws Error (input) where the folder cannot be listed or holds none.
std::vector<std::filesystem::path> photo_files(const std::filesystem::path& folder);

/// What EXIF and XMP (namespace drone-dji, as elements or as attributes) say of a photo. Only the
/// head of the file is read: a photo that is cut off behind it is found out by `read_photo`.
/// A position of 0, 0, an altitude of exactly 0, and values that are not finite are taken as
/// absent. Throws Error (input) for a missing, empty, non-image or Git LFS pointer file.
PhotoMetadata read_photo_metadata(const std::filesystem::path& path);

/// The size that `read_photo` reduces an image to.
struct ImageSize {
  int width = 0;
  int height = 0;
};
ImageSize reduced_size(int width, int height, int max_image_px);

/// The photo with its pixels as stored (the orientation tag is not applied), reduced by area so
/// that neither side exceeds `max_image_px`; 0 = as it is. The metadata keeps the size of the
/// file: the ratio of both widths is the reduction. Throws Error (input), also where the image is
/// cut off.
Photo read_photo(const std::filesystem::path& path, int max_image_px = 0);

/// Writes a JPEG (.jpg, .jpeg) with the metadata as EXIF and, where there is a gimbal, a relative
/// altitude or an accuracy of the position, as XMP in the way DJI writes it. Angles keep 0.01
/// degrees, positions 0.1 mm, heights 1 mm. Atomic. Throws Error (usage) for another extension,
/// (processing) where it cannot be written.
void write_photo(const std::filesystem::path& path, const Photo& photo, int jpeg_quality = 92);

}  // namespace nadir
