// SPDX-License-Identifier: Apache-2.0
// Bags that rosbag wrote are read as the drives they were made of; what is missing or odd in one is
// named with the cure.

#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/bag_drive.hpp"
#include "io/small_drive.hpp"
#include "nadir/io/bags/bag_topics.hpp"
#include "nadir/io/bags/detail/message_layout.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/drives/mounting_file.hpp"
#include "nadir/io/trajectories/pose_file.hpp"
#include "support/expect_error.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using test::BagWriter;
using test::expect_error;
using test::image_message;
using test::info_message;
using test::small_stamp;
using test::transform_message;

constexpr int kFrames = 4;
constexpr const char* kLeft = "/stereo/left/image_rect";
constexpr const char* kRight = "/stereo/right/image_rect";

template <class To, class From>
void expect_near(const Transform3<To, From>& a, const Transform3<To, From>& b, double allowed) {
  EXPECT_LT((a.translation - b.translation).norm(), allowed);
  EXPECT_LT(a.rotation.angularDistance(b.rotation), allowed);
}

/// The small drive in parts, so that each test can leave out or spoil one.
void write_stereo_images(BagWriter& bag, const std::string& left = kLeft,
                         const std::string& right = kRight, int channels = 1) {
  for (int i = 0; i < kFrames; ++i) {
    const StereoFrame frame = test::small_stereo_frame(i, channels);
    bag.write(left, image_message(frame.left, frame.stamp, "left_optical"));
    bag.write(right, image_message(frame.right, frame.stamp, "right_optical"));
  }
}

void write_infos(BagWriter& bag) {
  const StereoRig rig = test::small_stereo_rig();
  bag.write("/stereo/left/camera_info",
            info_message(rig.left, 0.0, small_stamp(0), "left_optical"));
  bag.write("/stereo/right/camera_info",
            info_message(rig.right, rig.baseline_m(), small_stamp(0), "right_optical"));
}

void write_odometry(BagWriter& bag, const std::string& topic = "/odom") {
  for (int i = 0; i < kFrames; ++i) {
    bag.write_odometry(
        topic, transform_message(test::small_pose(i), small_stamp(i), "odom", "base_footprint"));
  }
}

/// base_footprint -> base_link -> mast -> left_optical, which together are the small mounting.
void write_static_tf(BagWriter& bag) {
  const Transform3<frames::Robot, frames::Robot> up{Eigen::Quaterniond::Identity(), {0, 0, 0.2}};
  const Transform3<frames::Robot, frames::Robot> mast{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())), {0.1, 0.0, 0.9}};
  const auto rest = mast.inverse() * (up.inverse() * test::small_mounting());
  bag.write_transform("/tf_static",
                      transform_message(up, small_stamp(0), "base_footprint", "base_link"));
  bag.write_transform("/tf_static", transform_message(mast, small_stamp(0), "/base_link", "/mast"));
  bag.write_transform("/tf_static",
                      transform_message(rest, small_stamp(0), "mast", "left_optical"));
}

class Rosbag : public ::testing::Test {
 protected:
  fs::path file() const { return folder_ / "drive.bag"; }

  template <class... Parts>
  void write(const Parts&... parts) const {
    BagWriter bag(file());
    (parts(bag), ...);
    bag.close();
  }

  void write_whole() const {
    write([](BagWriter& bag) {
      write_infos(bag);
      write_stereo_images(bag);
      write_odometry(bag);
      write_static_tf(bag);
    });
  }

  void expect_refused(std::initializer_list<std::string> parts,
                      const DriveReadOptions& options = {}) const {
    expect_error(ErrorKind::kInput, parts, [&] {
      const Drive drive = open_drive(file(), options);
      std::vector<std::string> notes;
      for (const DriveFrame& frame : drive.frames) {
        drive.is_stereo() ? void(drive.read_stereo(frame)) : void(drive.read_lidar(frame, notes));
      }
    });
  }

  test::TemporaryFolder folder_;
};

TEST_F(Rosbag, StereoIsReadAsItWasDriven) {
  for (const int channels : {1, 3}) {
    write([&](BagWriter& bag) {
      write_infos(bag);
      write_stereo_images(bag, kLeft, kRight, channels);
      write_odometry(bag);
      write_static_tf(bag);
    });
    const Drive drive = open_drive(file());
    EXPECT_EQ(drive.format, DriveFormat::kRosbag);
    ASSERT_TRUE(drive.is_stereo());
    const auto& rig = std::get<StereoRig>(drive.rig);
    const StereoRig written = test::small_stereo_rig();
    EXPECT_EQ(rig.left, written.left);
    EXPECT_EQ(rig.right, written.right);
    EXPECT_TRUE(rig.rectified);
    expect_near(rig.right_from_left, written.right_from_left, 1e-12);
    expect_near(rig.robot_from_left, written.robot_from_left, 1e-12);
    ASSERT_EQ(drive.frames.size(), 4U);
    ASSERT_TRUE(drive.odometry);
    for (int i = 0; i < kFrames; ++i) {
      const DriveFrame& frame = drive.frames[static_cast<std::size_t>(i)];
      EXPECT_EQ(frame.stamp, small_stamp(i));
      const StereoFrame stereo = drive.read_stereo(frame);
      EXPECT_EQ(stereo.left, test::small_stereo_frame(i, channels).left);
      EXPECT_EQ(stereo.right, test::small_stereo_frame(i, channels).right);
      expect_near(*pose_at(*drive.odometry, frame.stamp), test::small_pose(i), 1e-12);
    }
    EXPECT_TRUE(drive.notes.empty()) << drive.notes.front();
  }
}

/// 2 and 3 of a drive are read as such when the first two are left out.
TEST_F(Rosbag, FramesKeepTheirNumbers) {
  write_whole();
  DriveReadOptions options;
  options.first = 2;
  const Drive drive = open_drive(file(), options);
  ASSERT_EQ(drive.frames.size(), 2U);
  EXPECT_EQ(drive.read_stereo(drive.frames[0]).left, test::small_stereo_frame(2, 1).left);
}

TEST_F(Rosbag, ChunksMayBeCompressed) {
  for (const auto compression : {test::BagCompression::kLz4, test::BagCompression::kBz2}) {
    {
      BagWriter bag(file(), compression);
      write_infos(bag);
      write_stereo_images(bag);
      write_odometry(bag);
      bag.close();
    }
    const Drive drive = open_drive(file());
    EXPECT_EQ(drive.read_stereo(drive.frames[3]).right, test::small_stereo_frame(3, 1).right);
  }
}

TEST_F(Rosbag, LidarWithOneCamera) {
  const LidarRig rig = test::small_lidar_rig();
  write([&](BagWriter& bag) {
    bag.write("/cam/camera_info",
              info_message(rig.cameras[0].model, 0.0, small_stamp(0), "cam_optical"));
    for (int i = 0; i < kFrames; ++i) {
      const LidarFrame frame = test::small_lidar_frame(i);
      const auto points = static_cast<std::uint32_t>(frame.points.size());
      // As drivers write it: padding between xyz and the intensity, a ring that nobody asks for.
      ros1::PointCloud cloud{{frame.stamp.nanoseconds, "velodyne"},
                             points,
                             1,
                             22,
                             points * 22,
                             false,
                             {{"x", 0, 7, 1},
                              {"y", 4, 7, 1},
                              {"z", 8, 7, 1},
                              {"intensity", 16, 7, 1},
                              {"ring", 20, 4, 1}},
                             std::string(points * 22UL, '\0')};
      for (std::size_t k = 0; k < frame.points.size(); ++k) {
        char* at = cloud.bytes.data() + 22 * k;
        std::memcpy(at, &frame.points[k].x, 4);
        std::memcpy(at + 4, &frame.points[k].y, 4);
        std::memcpy(at + 8, &frame.points[k].z, 4);
        std::memcpy(at + 16, &frame.points[k].intensity, 4);
      }
      bag.write("/velodyne_points", cloud);
      // A camera is triggered when the lidar looks its way.
      const Stamp later{frame.stamp.nanoseconds + 20'000'000};
      bag.write("/cam/image_raw", image_message(frame.images[0], later, "cam_optical"));
    }
    write_odometry(bag);
    bag.write_transform("/tf_static", transform_message(rig.robot_from_lidar, small_stamp(0),
                                                        "base_footprint", "velodyne"));
    bag.write_transform("/tf_static",
                        transform_message(rig.cameras[0].robot_from_camera, small_stamp(0),
                                          "base_footprint", "cam_optical"));
  });
  const Drive drive = open_drive(file());
  ASSERT_FALSE(drive.is_stereo());
  const auto& read = std::get<LidarRig>(drive.rig);
  expect_near(read.robot_from_lidar, rig.robot_from_lidar, 1e-12);
  EXPECT_EQ(read.cameras.at(0).model, rig.cameras[0].model);
  expect_near(read.cameras[0].robot_from_camera, rig.cameras[0].robot_from_camera, 1e-12);
  ASSERT_EQ(drive.frames.size(), 4U);
  std::vector<std::string> notes;
  const LidarFrame frame = drive.read_lidar(drive.frames[2], notes);
  const LidarFrame expected = test::small_lidar_frame(2);
  ASSERT_EQ(frame.points.size(), expected.points.size());
  EXPECT_EQ(frame.points[7].y, expected.points[7].y);
  EXPECT_EQ(frame.points[7].intensity, expected.points[7].intensity);
  EXPECT_EQ(frame.images.at(0), expected.images.at(0));
}

TEST_F(Rosbag, PosesOfTfWhereThereIsNoOdometry) {
  write([](BagWriter& bag) {
    write_infos(bag);
    write_stereo_images(bag);
    for (int i = 0; i < kFrames; ++i) {
      const OdomPose3 wheel{Eigen::Quaterniond(Eigen::AngleAxisd(i, Eigen::Vector3d::UnitY())),
                            {0.2, 0.3, 0.1}};
      bag.write_transform(
          "/tf", transform_message(test::small_pose(i), small_stamp(i), "odom", "base_footprint"));
      bag.write_transform("/tf",
                          transform_message(wheel, small_stamp(i), "base_footprint", "wheel"));
      // static_transform_publisher of ROS 1 repeats itself in tf.
      bag.write_transform("/tf", transform_message(test::small_mounting(), small_stamp(i),
                                                   "base_footprint", "left_optical"));
    }
  });
  const Drive drive = open_drive(file());
  ASSERT_TRUE(drive.odometry);
  expect_near(*pose_at(*drive.odometry, small_stamp(3)), test::small_pose(3), 1e-12);
  expect_near(std::get<StereoRig>(drive.rig).robot_from_left, test::small_mounting(), 1e-12);
}

TEST_F(Rosbag, PosesOfAFileGoBeforeThoseOfTheBag) {
  write_whole();
  std::vector<StampedOdomPose3> other;
  for (int i = 0; i < kFrames; ++i) {
    other.push_back({small_stamp(i), test::small_pose(i + 5)});
  }
  write_tum(folder_ / "other.tum", other);
  DriveReadOptions options;
  options.poses = folder_ / "other.tum";
  const Drive drive = open_drive(file(), options);
  expect_near(*pose_at(*drive.odometry, small_stamp(1)), test::small_pose(6), 1e-8);
}

TEST_F(Rosbag, AMountingFileGoesBeforeTf) {
  write_whole();
  Mounting mounting;
  mounting.robot_from_camera = test::small_mounting();
  mounting.robot_from_camera->translation.z() = 3.0;
  write_mounting(folder_ / "mine.yaml", mounting);
  DriveReadOptions options;
  options.mounting = folder_ / "mine.yaml";
  const auto rig = std::get<StereoRig>(open_drive(file(), options).rig);
  EXPECT_NEAR(rig.robot_from_left.translation.z(), 3.0, 1e-9);
}

/// The images of two cameras that look a little past each other, and what ROS says of them.
TEST_F(Rosbag, RawImagesKeepLensAndRotation) {
  const Eigen::Quaterniond left_turn(Eigen::AngleAxisd(0.010, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond right_turn(Eigen::AngleAxisd(-0.015, Eigen::Vector3d::UnitY()));
  write([&](BagWriter& bag) {
    for (const auto& [side, turn, x] :
         {std::tuple{"left", left_turn, 0.0}, std::tuple{"right", right_turn, 0.4}}) {
      ros1::CameraInfo info = info_message(test::small_camera(), x, small_stamp(0), side);
      info.d = {-0.2, 0.05, 0.001, -0.002, 0.01};
      info.k[0] = 21.0;
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> r = turn.toRotationMatrix();
      std::copy_n(r.data(), 9, info.r.begin());
      bag.write(std::string("/") + side + "/camera_info", info);
    }
    write_stereo_images(bag, "/left/image_raw", "/right/image_raw");
    write_odometry(bag);
  });
  const Drive drive = open_drive(file());
  const auto& rig = std::get<StereoRig>(drive.rig);
  EXPECT_FALSE(rig.rectified);
  EXPECT_EQ(rig.left.fx, 21.0);
  EXPECT_EQ(rig.left.k1, -0.2);
  EXPECT_EQ(rig.right.p2, -0.002);
  EXPECT_NEAR(rig.baseline_m(), 0.4, 1e-12);
  // A point, through the rectified frame by hand.
  const Eigen::Vector3d p_left(1.0, -0.5, 6.0);
  const Eigen::Vector3d p_right =
      right_turn.inverse() * (left_turn * p_left - Eigen::Vector3d(0.4, 0.0, 0.0));
  const auto p = rig.right_from_left * Point3<frames::Camera>::from(p_left);
  EXPECT_LT((p.vector() - p_right).norm(), 1e-9);
  ASSERT_EQ(drive.notes.size(), 1U) << "without tf the mounting is assumed, and said";
  EXPECT_NE(drive.notes[0].find("looking ahead"), std::string::npos) << drive.notes[0];
}

/// Each encoding of one picture gives the same RGB.
TEST_F(Rosbag, Encodings) {
  constexpr int kSide = 16;
  const cv::Mat rgb(kSide, kSide, CV_8UC3, cv::Scalar(200, 120, 40));
  const auto message = [&](const char* encoding, int conversion) {
    cv::Mat pixels;
    cv::cvtColor(rgb, pixels, conversion);
    const auto row = static_cast<std::uint32_t>(pixels.cols * pixels.channels());
    // Rows may be padded.
    ros1::Image image{
        {small_stamp(0).nanoseconds, "cam"}, kSide, kSide, row + 5, encoding, false, {}};
    for (int y = 0; y < kSide; ++y) {
      image.bytes.append(pixels.ptr<char>(y), row).append(5, '\x7f');
    }
    return image;
  };
  const auto bayer = [&](const char* encoding, const char* pattern) {
    ros1::Image image{
        {small_stamp(0).nanoseconds, "cam"}, kSide, kSide, kSide, encoding, false, {}};
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const char colour = pattern[2 * (y % 2) + x % 2];
        const int value = colour == 'r' ? 200 : (colour == 'g' ? 120 : 40);
        image.bytes.push_back(static_cast<char>(value));
      }
    }
    return image;
  };
  std::vector<std::uint8_t> png;
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  cv::imencode(".png", bgr, png);
  const ros1::Image compressed{
      {small_stamp(0).nanoseconds, "cam"}, 0, 0, 0, "png", true, {png.begin(), png.end()}};
  CameraModel camera = test::small_camera();
  camera.width = camera.height = kSide;
  for (const ros1::Image& image :
       {message("bgr8", cv::COLOR_RGB2BGR), message("rgba8", cv::COLOR_RGB2RGBA),
        message("bgra8", cv::COLOR_RGB2BGRA), bayer("bayer_rggb8", "rggb"),
        bayer("bayer_bggr8", "bggr"), bayer("bayer_gbrg8", "gbrg"), bayer("bayer_grbg8", "grbg"),
        compressed}) {
    const std::string tail = image.compressed ? "image_rect/compressed" : "image_rect";
    write([&](BagWriter& bag) {
      bag.write("/left/camera_info", info_message(camera, 0.0, small_stamp(0), "cam"));
      bag.write("/right/camera_info", info_message(camera, 0.4, small_stamp(0), "cam"));
      bag.write("/left/" + tail, image);
      bag.write("/right/" + tail, image);
    });
    const Drive drive = open_drive(file());
    EXPECT_FALSE(drive.odometry);
    const StereoFrame frame = drive.read_stereo(drive.frames.front());
    ASSERT_EQ(frame.left.channels(), 3) << image.encoding;
    EXPECT_EQ(frame.left.at(8, 7, 0), 200) << image.encoding;
    EXPECT_EQ(frame.left.at(8, 7, 1), 120) << image.encoding;
    EXPECT_EQ(frame.left.at(8, 7, 2), 40) << image.encoding;
  }
}

TEST_F(Rosbag, ImagesWithoutPartnerAreSaid) {
  write([](BagWriter& bag) {
    write_infos(bag);
    write_stereo_images(bag);
    write_odometry(bag);
    write_static_tf(bag);
    bag.write(kLeft, image_message(test::noise_image(9, 1),
                                   {small_stamp(2).nanoseconds + 40'000'000}, "left_optical"));
  });
  const Drive drive = open_drive(file());
  EXPECT_EQ(drive.frames.size(), 4U);
  ASSERT_EQ(drive.notes.size(), 1U);
  EXPECT_NE(drive.notes[0].find("1 of 5"), std::string::npos) << drive.notes[0];
}

TEST_F(Rosbag, TopicsAreListed) {
  write_whole();
  const std::vector<BagTopic> topics = list_bag(file());
  ASSERT_EQ(topics.size(), 6U);
  EXPECT_EQ(topics[0].name, "/odom");
  EXPECT_EQ(topics[0].type, "nav_msgs/Odometry");
  EXPECT_EQ(topics[0].messages, 4U);
  EXPECT_EQ(topics[0].first, small_stamp(0));
  EXPECT_EQ(topics[0].last, small_stamp(3));
}

TEST_F(Rosbag, NoCalibration) {
  write([](BagWriter& bag) {
    write_stereo_images(bag);
    write_odometry(bag);
    bag.write("/rear/camera_info", info_message(test::small_camera(), 0, small_stamp(0), "rear"));
  });
  expect_refused({"drive.bag", kLeft, "/stereo/left/camera_info", "/rear/camera_info"});
}

TEST_F(Rosbag, NoBaselineAndSwappedCameras) {
  const auto with_x = [&](double x) {
    write([&](BagWriter& bag) {
      bag.write("/stereo/left/camera_info",
                info_message(test::small_camera(), 0, small_stamp(0), "l"));
      bag.write("/stereo/right/camera_info",
                info_message(test::small_camera(), x, small_stamp(0), "r"));
      write_stereo_images(bag);
    });
  };
  with_x(0.0);
  expect_refused({"drive.bag:/stereo/right/camera_info", "no baseline"});
  with_x(-0.4);
  expect_refused({"drive.bag:/stereo/right/camera_info", "swap left and right"});
}

TEST_F(Rosbag, LensesThatAreNoPinhole) {
  write([](BagWriter& bag) {
    ros1::CameraInfo info = info_message(test::small_camera(), 0, small_stamp(0), "l");
    info.distortion_model = "equidistant";
    info.d = {0.1, 0.2, 0.3, 0.4};
    bag.write("/left/camera_info", info);
    bag.write("/right/camera_info", info);
    write_stereo_images(bag, "/left/image_raw", "/right/image_raw");
  });
  expect_refused({"/left/camera_info", "equidistant", "image_rect"});
}

TEST_F(Rosbag, EncodingsThatAreNone) {
  const auto with = [&](const std::string& encoding, std::uint32_t step, std::size_t bytes) {
    write([&](BagWriter& bag) {
      write_infos(bag);
      ros1::Image image = image_message(test::noise_image(1, 1), small_stamp(0), "l");
      image.encoding = encoding;
      image.step = step;
      image.bytes.resize(bytes);
      bag.write(kLeft, image);
      bag.write(kRight, image);
    });
  };
  with("mono16", 48, 480);
  expect_refused({"drive.bag: /stereo/left/image_rect[0]", "mono16", "8 bits"});
  with("yuv422", 48, 480);
  expect_refused({"yuv422", "unknown encoding", "mono8"});
  with("mono8", 24, 200);
  expect_refused({"200 bytes instead of 240"});
  with("rgb8", 24, 240);
  expect_refused({"24 bytes long", "72"});
}

TEST_F(Rosbag, TopicsThatAreNotThereOrSeveral) {
  write([](BagWriter& bag) {
    write_infos(bag);
    write_stereo_images(bag);
    write_stereo_images(bag, "/stereo/left/image_raw", "/stereo/right/image_raw");
    write_odometry(bag);
    write_odometry(bag, "/wheel/odom");
  });
  expect_refused({"2 topics may be the odometry", "--odometry-topic", "/odom", "/wheel/odom"});
  DriveReadOptions options;
  options.topics.odometry = "/odom";
  expect_refused({"2 topics", "left camera", "--left-topic", "/stereo/left/image_raw"}, options);
  options.topics.left = "/stereo/left/image_color";
  expect_refused({"/stereo/left/image_color", "--left-topic may be", kLeft}, options);
  options.topics.left = kLeft;
  options.topics.right = kRight;
  EXPECT_EQ(open_drive(file(), options).frames.size(), 4U);
  options.topics = {};
  options.topics.odometry = "/gps";
  expect_refused({"no odometry /gps", "/wheel/odom"}, options);
}

TEST_F(Rosbag, NothingThatMaps) {
  write([](BagWriter& bag) { bag.write_header("/clock", {1'000'000'000, ""}); });
  expect_refused({"left camera", "--left-topic", "none"});
}

TEST_F(Rosbag, LidarThatStandsNowhere) {
  write([](BagWriter& bag) {
    bag.write("/cam/camera_info", info_message(test::small_camera(), 0, small_stamp(0), "cam"));
    bag.write("/cam/image_raw", image_message(test::noise_image(1, 3), small_stamp(0), "cam"));
    bag.write("/points", ros1::PointCloud{{small_stamp(0).nanoseconds, "velodyne"},
                                          1,
                                          1,
                                          12,
                                          12,
                                          false,
                                          {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}},
                                          std::string(12, '\1')});
  });
  expect_refused({"'velodyne'", "base_link", "--mounting FILE", "tf_static"});
}

TEST_F(Rosbag, ClocksThatDiffer) {
  write([](BagWriter& bag) {
    write_infos(bag);
    bag.write(kLeft, image_message(test::noise_image(1, 1), small_stamp(0), "l"));
    bag.write(kRight, image_message(test::noise_image(2, 1), small_stamp(50), "r"));
  });
  expect_refused({kLeft, kRight, "0.002", to_string(small_stamp(50)), "one clock"});
}

TEST_F(Rosbag, PosesOfAnotherFrame) {
  write([](BagWriter& bag) {
    write_infos(bag);
    write_stereo_images(bag);
    for (int i = 0; i < kFrames; ++i) {
      const OdomPose3 optical{Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.0 * i}};
      bag.write_odometry("/vo", transform_message(optical, small_stamp(i), "vo", "left_optical"));
    }
  });
  expect_refused({"drive.bag", "z-forward", "--pose-frame camera"});
}

TEST_F(Rosbag, FilesThatAreNoBag) {
  expect_error(ErrorKind::kInput, {"drive.bag", "no such file"}, [&] { list_bag(file()); });
  test::write_text(file(), "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n");
  expect_error(ErrorKind::kInput, {"drive.bag", "git lfs pull"}, [&] { list_bag(file()); });
  test::write_text(file(), "SQLite format 3");
  expect_error(ErrorKind::kInput, {"drive.bag", "no ROS 1 bag"}, [&] { list_bag(file()); });
  write_whole();
  const auto whole = fs::file_size(file());
  for (const double share : {0.02, 0.3, 0.7, 0.95, 0.999}) {
    write_whole();
    fs::resize_file(file(), static_cast<std::uintmax_t>(share * static_cast<double>(whole)));
    expect_error(ErrorKind::kInput, {"drive.bag", "rosbag reindex"}, [&] { list_bag(file()); });
  }
}

/// rosbag itself would make room for what these declare, and read where they point to.
TEST_F(Rosbag, LengthsAndOffsetsThatLie) {
  write_whole();
  const std::string whole = test::read_text(file());
  const auto expect_damaged = [&](std::size_t position, const std::string& bytes,
                                  const std::string& problem) {
    ASSERT_NE(position, std::string::npos);
    std::string spoiled = whole;
    spoiled.replace(position, bytes.size(), bytes);
    test::write_text(file(), spoiled);
    expect_error(ErrorKind::kInput, {"drive.bag", problem}, [&] { list_bag(file()); });
  };
  const std::string large(4, '\xff');
  const std::size_t first_chunk = whole.find("op=\x05");
  expect_damaged(9, "1.2", "no bag of version 2.0");
  expect_damaged(13, large, "damaged at byte 13: the header of a record has 4294967295 bytes");
  expect_damaged(whole.find("index_pos=") + 10, large, "there is no index");
  expect_damaged(whole.find("size=", whole.find("compression=")) + 5, large, "a chunk declares");
  // An index record: its header, the length of its data, and 12 bytes an entry with the offset
  // last.
  const std::size_t index = whole.find("op=\x04", first_chunk);
  const std::size_t entry = whole.find("ver=", index) + 8 + 4;
  expect_damaged(entry + 8, large, "points beyond its chunk");
  expect_damaged(whole.find("count=", index) + 6, large, "of another length than it says");
  expect_damaged(whole.find("chunk_pos=") + 10, large, "there is no chunk");
}

/// The topics that the index lists are lists of fields too.
TEST_F(Rosbag, TopicsThatLie) {
  write_whole();
  const std::string whole = test::read_text(file());
  const std::size_t index = whole.find("index_pos=") + 10;
  std::uint64_t listed = 0;
  std::memcpy(&listed, whole.data() + index, sizeof(listed));
  const auto expect_damaged = [&](std::size_t position, const std::string& bytes,
                                  std::initializer_list<std::string> problem) {
    ASSERT_NE(position, std::string::npos);
    std::string spoiled = whole;
    spoiled.replace(position, bytes.size(), bytes);
    test::write_text(file(), spoiled);
    expect_error(ErrorKind::kInput, problem, [&] { list_bag(file()); });
  };
  const std::size_t md5 = whole.find("md5sum=", listed);
  expect_damaged(md5 - 4, std::string("\0\0\x0a\0", 4), {"drive.bag", "no list of fields"});
  expect_damaged(md5, "md6sum=", {"drive.bag", "no 'md5sum'"});
  // The same field twice: readers differ in which they take.
  expect_damaged(whole.find("conn=", listed), "op==", {"drive.bag", "damaged at byte"});
  expect_damaged(whole.find("conn=", whole.find("op=\x04")) + 5, std::string(4, '\x55'),
                 {"drive.bag", "topic that is not listed"});
}

/// 20,000 entries of an index that each point to the first of 10,000 topics: to go through them all
/// would take minutes.
TEST_F(Rosbag, AnIndexDoesNotPointToTopicsWithoutEnd) {
  const auto u32 = [](std::uint32_t value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  const auto record = [&](const std::vector<std::string>& fields, const std::string& data) {
    std::string header;
    for (const std::string& field : fields) {
      header += u32(static_cast<std::uint32_t>(field.size())) + field;
    }
    return u32(static_cast<std::uint32_t>(header.size())) + header +
           u32(static_cast<std::uint32_t>(data.size())) + data;
  };
  const auto op = [](char number) { return std::string("op=") + number; };
  const std::string topic = record({op(7), "conn=" + u32(0), "topic=/a"}, "");
  std::string chunk;
  for (int i = 0; i < 10'000; ++i) chunk += topic;
  chunk += record({op(2), "conn=" + u32(0), "time=" + u32(1) + u32(0)}, "x");
  std::string entries;
  constexpr std::uint32_t kEntries = 20'000;
  for (std::uint32_t i = 0; i < kEntries; ++i) entries += u32(1) + u32(0) + u32(0);
  const std::uint64_t nowhere = 1;
  test::write_text(
      file(),
      "#ROSBAG V2.0\n" +
          record({op(3), "index_pos=" + std::string(reinterpret_cast<const char*>(&nowhere), 8),
                  "conn_count=" + u32(1), "chunk_count=" + u32(1)},
                 "") +
          record(
              {op(5), "compression=none", "size=" + u32(static_cast<std::uint32_t>(chunk.size()))},
              chunk) +
          record({op(4), "ver=" + u32(1), "conn=" + u32(0), "count=" + u32(kEntries)}, entries));
  expect_error(ErrorKind::kInput, {"drive.bag", "points to no message"}, [&] { list_bag(file()); });
}

/// What a compressed chunk holds is known only once it is unpacked.
TEST_F(Rosbag, CompressedChunksThatLie) {
  write_whole();
  const std::string whole = test::read_text(file());
  const std::string chunk = test::chunk_of(whole);
  const auto size = static_cast<std::uint32_t>(chunk.size());
  std::string spoiled = chunk;
  // The lengths of every message's header.
  for (std::size_t at = spoiled.find("op=\x02"); at != std::string::npos;
       at = spoiled.find("op=\x02", at + 1)) {
    const std::size_t begin = spoiled.rfind("conn=", at) - 8;
    spoiled.replace(begin, 4, std::string("\xff\xff\xff\x0f", 4));
  }
  ASSERT_NE(spoiled, chunk);
  test::write_text(file(), test::with_chunk(whole, "bz2", test::packed_bz2(chunk), size));
  EXPECT_EQ(open_drive(file()).frames.size(), 4U);
  test::write_text(file(), test::with_chunk(whole, "bz2", test::packed_bz2(spoiled), size));
  expect_refused({"drive.bag", "damaged at byte", "in the chunk there"});
  test::write_text(file(), test::with_chunk(whole, "bz2", test::packed_bz2(chunk), size + 7));
  expect_refused({"drive.bag", "damaged at byte", "cannot be unpacked"});
  test::write_text(file(), test::with_chunk(whole, "bz2", "BZh9 is not so", size));
  expect_refused({"drive.bag", "damaged at byte", "cannot be unpacked"});
  test::write_text(file(),
                   test::with_chunk(whole, "lz4", std::string("\x04\x22\x4d\x18", 4), size));
  expect_refused({"drive.bag", "damaged at byte", "cannot be unpacked"});
  test::write_text(file(), test::with_chunk(whole, "rar", chunk, size));
  expect_refused({"drive.bag", "'rar'"});
}

TEST(RosbagLayout, AListIsNoLongerThanItsMessage) {
  using ros1::has_layout;
  using namespace std::string_view_literals;
  EXPECT_TRUE(has_layout("", ""));
  EXPECT_TRUE(has_layout("12345678abcd", "84"));
  EXPECT_FALSE(has_layout("12345678abc", "84"));
  EXPECT_TRUE(has_layout("\2\0\0\0ab"sv, "v1"));
  EXPECT_FALSE(has_layout("\3\0\0\0ab"sv, "v1"));
  EXPECT_FALSE(has_layout("\xff\xff\xff\xff"sv, "v8"));
  EXPECT_TRUE(has_layout("\2\0\0\0\1\0\0\0ax\0\0\0\0y"sv, "(v11)"));
  EXPECT_FALSE(has_layout("\3\0\0\0\1\0\0\0ax\0\0\0\0y"sv, "(v11)"));
}

}  // namespace
}  // namespace nadir
