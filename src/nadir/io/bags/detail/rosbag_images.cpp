// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/bags/detail/rosbag_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>

#include "nadir/io/detail/image_bytes.hpp"
#include "nadir/io/drives/detail/cloud_columns.hpp"
#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/drives/detail/kitti_calibration.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

/// An encoding of sensor_msgs/image_encodings.h, and how OpenCV makes grey or RGB of it.
struct Encoding {
  const char* name;
  int channels;
  int conversion;  ///< of cv::cvtColor
};
constexpr int kAsItIs = -1;
// OpenCV names a Bayer pattern by the second row's second and third pixel, ROS by the first two
// rows.
constexpr std::array<Encoding, 12> kEncodings{{{"mono8", 1, kAsItIs},
                                               {"8UC1", 1, kAsItIs},
                                               {"rgb8", 3, kAsItIs},
                                               {"bgr8", 3, cv::COLOR_BGR2RGB},
                                               {"8UC3", 3, cv::COLOR_BGR2RGB},
                                               {"rgba8", 4, cv::COLOR_RGBA2RGB},
                                               {"bgra8", 4, cv::COLOR_BGRA2RGB},
                                               {"8UC4", 4, cv::COLOR_BGRA2RGB},
                                               {"bayer_rggb8", 1, cv::COLOR_BayerBG2RGB},
                                               {"bayer_bggr8", 1, cv::COLOR_BayerRG2RGB},
                                               {"bayer_gbrg8", 1, cv::COLOR_BayerGR2RGB},
                                               {"bayer_grbg8", 1, cv::COLOR_BayerGB2RGB}}};

const Encoding& encoding_of(const ros1::Image& image, const std::string& where) {
  const auto* found = std::ranges::find(kEncodings, image.encoding, &Encoding::name);
  if (found != kEncodings.end()) return *found;
  const bool deep = image.encoding.find("16") != std::string::npos ||
                    image.encoding.find("32") != std::string::npos;
  throw Error(
      ErrorKind::kInput,
      deep ? fmt::format("'{}' has more than 8 bits a channel", image.encoding)
           : fmt::format("'{}' is an unknown encoding", image.encoding),
      where,
      "record mono8, rgb8, bgr8, rgba8, bgra8, an 8-bit Bayer pattern, or compressed images");
}

constexpr const char* kCutOff = "the message is cut off: leave it out with --first and --count";

void require_whole(std::size_t bytes, std::size_t needed, const std::string& where) {
  if (bytes >= needed) return;
  throw Error(ErrorKind::kInput, fmt::format("holds {} bytes instead of {}", bytes, needed), where,
              kCutOff);
}

/// Throws where a calibration holds what no camera has. R may be all zeros: not rectified.
void check_info(const ros1::CameraInfo& info, const std::string& where) {
  for (const std::span<const double> values :
       {std::span<const double>(info.d), std::span<const double>(info.k),
        std::span<const double>(info.r), std::span<const double>(info.p)}) {
    for (const double value : values) checked_number(value, "a number of the calibration", where);
  }
  checked_side(info.width, "the width", where);
  checked_side(info.height, "the height", where);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(info.r.data());
  if (!r.isZero()) check_rotation(r, where);
}

CameraModel model_of(const ImageTopic& topic, double fx, double fy, double cx, double cy) {
  return {static_cast<int>(topic.info.width),
          static_cast<int>(topic.info.height),
          fx,
          fy,
          cx,
          cy,
          0.0,
          0.0,
          0.0,
          0.0,
          0.0};
}

CameraModel projected_camera_of(const ImageTopic& topic) {
  const auto& p = topic.info.p;
  return model_of(topic, p[0], p[5], p[2], p[6]);
}

void take_distortion(const ros1::CameraInfo& info, CameraModel& model, const std::string& where) {
  const bool rational = std::any_of(
      info.d.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(5, info.d.size())),
      info.d.end(), [](double k) { return k != 0.0; });
  const bool radial = info.distortion_model.empty() || info.distortion_model == "plumb_bob" ||
                      info.distortion_model == "radtan" ||
                      info.distortion_model == "rational_polynomial";
  if (!radial || rational) {
    throw Error(ErrorKind::kInput,
                fmt::format("its lens is '{}', which is not pinhole with radial-tangential "
                            "distortion",
                            info.distortion_model),
                where, "give the rectified images (image_rect)");
  }
  std::array<double, 5> d{};
  std::copy_n(info.d.begin(), std::min<std::size_t>(d.size(), info.d.size()), d.begin());
  model.k1 = d[0];
  model.k2 = d[1];
  model.p1 = d[2];
  model.p2 = d[3];
  model.k3 = d[4];
}

Eigen::Quaterniond rectification_of(const ros1::CameraInfo& info) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(info.r.data());
  const Eigen::Matrix3d rotation = r;
  return rotation.isZero() ? Eigen::Quaterniond::Identity()
                           : Eigen::Quaterniond(rotation).normalized();
}

bool needs_rectification(const ros1::CameraInfo& info) {
  constexpr double kNoTurnRad = 1e-6;
  const bool distorted = std::ranges::any_of(info.d, [](double k) { return k != 0.0; });
  return distorted ||
         rectification_of(info).angularDistance(Eigen::Quaterniond::Identity()) > kNoTurnRad;
}

bool same_projection(const CameraModel& a, const CameraModel& b) {
  return a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy;
}

/// x of the camera in the rectified frame that both share: P holds -fx * x as its fourth number.
double shift_of(const ros1::CameraInfo& info) {
  return info.p[0] == 0.0 ? 0.0 : -info.p[3] / info.p[0];
}

CloudField field_of(const ros1::PointField& field, const std::string& where) {
  // sensor_msgs/PointField: 1 int8, 2 uint8, 3 int16, 4 uint16, 5 int32, 6 uint32, 7 and 8 floats.
  static constexpr std::array<std::pair<char, std::size_t>, 8> kTypes{
      {{'I', 1}, {'U', 1}, {'I', 2}, {'U', 2}, {'I', 4}, {'U', 4}, {'F', 4}, {'F', 8}}};
  if (field.datatype < 1 || field.datatype > kTypes.size()) {
    throw Error(ErrorKind::kInput,
                fmt::format("field '{}' is of the unknown type {}", field.name, field.datatype),
                where, "record a PointCloud2 of x, y, z");
  }
  const auto& [kind, size] = kTypes.at(field.datatype - 1U);
  return {field.name, kind, size, field.count};
}

}  // namespace

CameraModel camera_of(const ImageTopic& topic, const std::string& where) {
  check_info(topic.info, where + ":" + topic.info_name);
  if (topic.says_rectified()) return projected_camera_of(topic);
  const auto& k = topic.info.k;
  CameraModel model = model_of(topic, k[0], k[4], k[2], k[5]);
  take_distortion(topic.info, model, where + ":" + topic.info_name);
  return model;
}

StereoRig stereo_rig_of(const StereoTopics& topics, const std::string& where) {
  const ros1::CameraInfo& left = topics.left.info;
  const ros1::CameraInfo& right = topics.right.info;
  check_info(left, where + ":" + topics.left.info_name);
  check_info(right, where + ":" + topics.right.info_name);
  StereoRig rig;
  rig.right_from_left.translation = {shift_of(left) - shift_of(right), 0.0, 0.0};
  const bool projected = (topics.left.says_rectified() && topics.right.says_rectified()) ||
                         (!needs_rectification(left) && !needs_rectification(right));
  if (projected) {
    rig.left = projected_camera_of(topics.left);
    rig.right = projected_camera_of(topics.right);
    rig.rectified = same_projection(rig.left, rig.right);
  } else {
    rig.left = camera_of(topics.left, where);
    rig.right = camera_of(topics.right, where);
    // From the left camera into the rectified frame, across, and out again.
    const Eigen::Quaterniond out = rectification_of(right).conjugate();
    rig.right_from_left.rotation = (out * rectification_of(left)).normalized();
    rig.right_from_left.translation = out * rig.right_from_left.translation;
  }
  check_rig(rig, where + ":" + topics.right.info_name);
  return rig;
}

Raster<std::uint8_t> pixels_of(ros1::Image image, const std::string& where) {
  if (image.compressed) return decode_image(where, std::move(image.bytes));
  const Encoding& encoding = encoding_of(image, where);
  const int width = checked_integer(image.width, "its width", where, 1, kLargestSide);
  const int height = checked_integer(image.height, "its height", where, 1, kLargestSide);
  const std::size_t row = std::size_t{image.width} * static_cast<std::size_t>(encoding.channels);
  if (image.step < row) {
    throw Error(ErrorKind::kInput,
                fmt::format("its rows are {} bytes long, '{}' of {} pixels needs {}", image.step,
                            image.encoding, width, row),
                where, "record it again");
  }
  require_whole(image.bytes.size(), std::size_t{image.step} * image.height, where);
  const cv::Mat stored(height, width, CV_8UC(encoding.channels), image.bytes.data(), image.step);
  const bool grey = encoding.channels == 1 && encoding.conversion == kAsItIs;
  Raster<std::uint8_t> pixels(width, height, 0, grey ? 1 : 3);
  cv::Mat view(height, width, CV_8UC(pixels.channels()), pixels.values().data());
  if (encoding.conversion == kAsItIs) {
    stored.copyTo(view);
  } else {
    cv::cvtColor(stored, view, encoding.conversion);
  }
  return pixels;
}

PointCloud points_of(const ros1::PointCloud& message, const std::string& where) {
  const std::size_t row = std::size_t{message.width} * message.point_step;
  if (message.height > 1 && message.row_step != row) {
    throw Error(ErrorKind::kInput,
                fmt::format("its rows are {} bytes long instead of {}", message.row_step, row),
                where, "record a PointCloud2 without padding");
  }
  // The product of all three could overflow: rows are compared instead.
  if (row > 0 && message.bytes.size() / row < message.height) {
    throw Error(ErrorKind::kInput,
                fmt::format("holds {} bytes instead of {} rows of {}", message.bytes.size(),
                            message.height, row),
                where, kCutOff);
  }
  std::vector<CloudColumn> columns;
  for (const ros1::PointField& field : message.fields) {
    columns.push_back({field_of(field, where), field.offset, message.point_step});
    if (field.offset + columns.back().field.size > message.point_step) {
      throw Error(ErrorKind::kInput,
                  fmt::format("field '{}' ends after its point of {} bytes", field.name,
                              message.point_step),
                  where, "record it again");
    }
  }
  PointCloud cloud;
  if (message.fields.size() > kMostFields || row == 0) {
    throw Error(ErrorKind::kInput,
                fmt::format("has {} fields and rows of {} bytes", message.fields.size(), row),
                where, "record a PointCloud2 of x, y, z");
  }
  cloud.points =
      points_of_columns(where, message.bytes, columns, std::size_t{message.width} * message.height,
                        message.big_endian ? ByteOrder::kBig : ByteOrder::kLittle);
  drop_invalid(where, cloud);
  return cloud;
}

}  // namespace nadir
