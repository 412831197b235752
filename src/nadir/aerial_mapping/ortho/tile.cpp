// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/tile.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <set>
#ifdef NADIR_HAS_SFM
#include <opencv2/stitching/detail/blenders.hpp>
#endif

namespace nadir::aerial {
namespace {

constexpr float kFeatherPx = 24.0F;

int apron_of(const Scene& scene) {
  if (scene.blend == BlendKind::kMultiBand) return 2 << scene.bands;
  return scene.blend == BlendKind::kFeather ? static_cast<int>(kFeatherPx) : 0;
}

std::uint16_t label_at(const Scene& scene, int column, int row) {
  return scene.labels.at<std::uint16_t>(row / scene.grid.pixels, column / scene.grid.pixels);
}

/// Pixels of `part` as the view shows them, gain applied; what lies outside the photo repeats its
/// border.
cv::Mat sample(const Scene& scene, std::size_t index, const cv::Rect& part) {
  const View& view = scene.views[index];
  const auto image = scene.images.get(index);
  const double su = static_cast<double>(image->cols) / view.camera.width;
  const double sv = static_cast<double>(image->rows) / view.camera.height;
  cv::Mat u(part.size(), CV_32F);
  cv::Mat v(part.size(), CV_32F);
  for (int row = 0; row < part.height; ++row)
    for (int column = 0; column < part.width; ++column) {
      const double x = scene.geo.x_at(part.x + column + 0.5);
      const double y = scene.geo.y_at(part.y + row + 0.5);
      const auto pixel = view.project({x, y, scene.ground.height_at(x, y)});
      u.at<float>(row, column) = pixel ? static_cast<float>((pixel->x() + 0.5) * su - 0.5) : -1.0F;
      v.at<float>(row, column) = pixel ? static_cast<float>((pixel->y() + 0.5) * sv - 0.5) : -1.0F;
    }
  cv::Mat colours;
  cv::remap(*image, colours, u, v, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::Mat balanced;
  cv::multiply(colours, cv::Scalar(view.gain[0], view.gain[1], view.gain[2]), balanced);
  return balanced;
}

cv::Mat mask_of(const Scene& scene, std::size_t view, const cv::Rect& part) {
  cv::Mat mask(part.size(), CV_8U, cv::Scalar(0));
  for (int row = 0; row < part.height; ++row)
    for (int column = 0; column < part.width; ++column)
      if (label_at(scene, part.x + column, part.y + row) == view)
        mask.at<std::uint8_t>(row, column) = 255;
  return mask;
}

cv::Mat without_blending(const Scene& scene, const std::set<std::size_t>& labels,
                         const cv::Rect& part) {
  cv::Mat result(part.size(), CV_8UC3, cv::Scalar::all(0));
  for (const std::size_t view : labels)
    sample(scene, view, part).copyTo(result, mask_of(scene, view, part));
  return result;
}

cv::Mat feathered(const Scene& scene, const std::set<std::size_t>& labels, const cv::Rect& part) {
  cv::Mat sum(part.size(), CV_32FC3, cv::Scalar::all(0));
  cv::Mat weights(part.size(), CV_32F, cv::Scalar(0));
  for (const std::size_t view : labels) {
    // Falls from 1 inside the view's own cells to 0 at the end of the feather.
    cv::Mat outside;
    cv::bitwise_not(mask_of(scene, view, part), outside);
    cv::Mat distance;
    cv::distanceTransform(outside, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    cv::Mat weight = 1.0 - distance / kFeatherPx;
    cv::max(weight, 0.0, weight);
    cv::Mat colours;
    sample(scene, view, part).convertTo(colours, CV_32FC3);
    for (int row = 0; row < part.height; ++row)
      for (int column = 0; column < part.width; ++column) {
        const float w = weight.at<float>(row, column);
        sum.at<cv::Vec3f>(row, column) += w * colours.at<cv::Vec3f>(row, column);
        weights.at<float>(row, column) += w;
      }
  }
  cv::Mat result(part.size(), CV_8UC3, cv::Scalar::all(0));
  for (int row = 0; row < part.height; ++row)
    for (int column = 0; column < part.width; ++column) {
      const float w = weights.at<float>(row, column);
      if (w > 0.0F)
        result.at<cv::Vec3b>(row, column) = cv::Vec3b(sum.at<cv::Vec3f>(row, column) * (1.0F / w));
    }
  return result;
}

#ifdef NADIR_HAS_SFM
/// Burt and Adelson 1983: low frequencies mix over a wide band, fine ones over a narrow one.
cv::Mat multi_band(const Scene& scene, const std::set<std::size_t>& labels, const cv::Rect& part) {
  cv::detail::MultiBandBlender blender(0, scene.bands);
  blender.prepare(part);
  for (const std::size_t view : labels) {
    cv::Mat colours;
    sample(scene, view, part).convertTo(colours, CV_16SC3);
    blender.feed(colours, mask_of(scene, view, part), part.tl());
  }
  cv::Mat blended;
  cv::Mat mask;
  blender.blend(blended, mask);
  cv::Mat result;
  blended.convertTo(result, CV_8UC3);
  return result;
}
#endif

}  // namespace

cv::Mat render(const Scene& scene, const cv::Rect& part) {
  const int apron = apron_of(scene);
  const cv::Rect all(0, 0, scene.grid.width * scene.grid.pixels,
                     scene.grid.height * scene.grid.pixels);
  const cv::Rect wide =
      cv::Rect(part.x - apron, part.y - apron, part.width + 2 * apron, part.height + 2 * apron) &
      all;
  std::set<std::size_t> labels;
  for (int row = wide.y; row < wide.y + wide.height; ++row)
    for (int column = wide.x; column < wide.x + wide.width; ++column)
      if (const std::uint16_t label = label_at(scene, column, row); label != kNoView)
        labels.insert(label);
  if (labels.empty()) return {part.size(), CV_8UC3, cv::Scalar::all(0)};
  const cv::Rect inside(part.x - wide.x, part.y - wide.y, part.width, part.height);
  if (labels.size() == 1 || scene.blend == BlendKind::kNone)
    return without_blending(scene, labels, wide)(inside).clone();
#ifdef NADIR_HAS_SFM
  if (scene.blend == BlendKind::kMultiBand) return multi_band(scene, labels, wide)(inside).clone();
#endif
  return feathered(scene, labels, wide)(inside).clone();
}

}  // namespace nadir::aerial
