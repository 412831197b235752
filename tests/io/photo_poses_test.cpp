// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/photo_poses.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "nadir/core/angle.hpp"
#include "nadir/io/photos/colmap_process.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

/// Looks straight down; the upper edge of the photo points north: right = east, down = south.
Eigen::Matrix3d down_and_north() {
  Eigen::Matrix3d axes;
  axes << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return axes;
}

const GeodeticPosition kPlace{60.0, 5.9, 120.0};

void expect_near(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double within) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), within) << a << "\n\n" << b;
}

TEST(PhotoPoses, OwnFormatRoundTrips) {
  const TemporaryFolder folder;
  PhotoPose a{"a.jpg", {1600, 900, 936.5, 937.0, 799.5, 449.5, -0.01, 0.002, 1e-4, 2e-4, 3e-5}, {}};
  a.map_from_camera.translation = {576663.125, 5188164.5, 198.309};
  a.map_from_camera.rotation = Eigen::Quaterniond(0.1, 0.7, -0.7, 0.05).normalized();
  PhotoPose b = a;
  b.name = "b.jpg";
  b.camera.fx = 900.0;
  b.flown_in_readout = {0.125, -0.5, 0.0};
  write_photo_poses(folder / "map.poses.json", std::vector{a, b}, "EPSG:32615");
  const ImportedPoses read = read_photo_poses(folder / "map.poses.json");
  EXPECT_EQ(read.frame, PhotoPoseFrame::kMap);
  EXPECT_EQ(read.crs, "EPSG:32615");
  ASSERT_EQ(read.poses.size(), 2U);
  EXPECT_EQ(read.poses[0].camera, a.camera);
  EXPECT_EQ(read.poses[1].camera, b.camera);
  EXPECT_EQ(read.poses[1].map_from_camera.translation, a.map_from_camera.translation);
  EXPECT_TRUE(read.poses[0].flown_in_readout.isZero());
  EXPECT_EQ(read.poses[1].flown_in_readout, b.flown_in_readout);
  expect_near(read.poses[0].map_from_camera.rotation.coeffs(), a.map_from_camera.rotation.coeffs(),
              1e-12);
}

TEST(PhotoPoses, NamesThatAreNotUtf8StayTwo) {
  const TemporaryFolder folder;
  const PhotoPose one{"caf\xe9.jpg", {1600, 900, 936.5, 937.0, 799.5, 449.5}, {}};
  PhotoPose other = one;
  other.name = "caf\xe8.jpg";
  write_photo_poses(folder / "map.poses.json", std::vector{one, other}, "");
  const ImportedPoses read = read_photo_poses(folder / "map.poses.json");
  ASSERT_EQ(read.poses.size(), 2U);
  EXPECT_EQ(read.poses[0].name, one.name);
  EXPECT_EQ(read.poses[1].name, other.name);
}

TEST(PhotoPoses, ResizedCamerasSeeTheSame) {
  const CameraModel camera{1600, 900, 936.0, 936.0, 810.0, 440.0};
  const CameraModel half = resized(camera, 800, 450);
  const Eigen::Vector3d point(0.3, -0.2, 1.0);
  const Eigen::Vector2d whole = *camera.project(point);
  expect_near(*half.project(point), (whole.array() + 0.5) / 2.0 - 0.5, 1e-12);
}

TEST(PhotoPoses, ReadsAColmapTextModel) {
  const TemporaryFolder folder;
  test::write_text(folder / "cameras.txt",
                   "# Camera list\n1 OPENCV 1600 900 936 937 800 450 -0.01 0.002 0.0001 0.0002\n"
                   "2 SIMPLE_RADIAL 800 600 500 400 300 0.05\n");
  // camera_from_map: a half turn about x, then a shift.
  test::write_text(
      folder / "images.txt",
      "# Image list\n1 0 1 0 0 -10 20 30 1 a.jpg\n100.5 200.5 7 101.5 201.5 8\n"
      "2 1 0 0 0 0 0 5 2 b.jpg\n\n3  1 0 0 0  0 0 5 2  b 2.jpg\n1 2 3 4 5 6 7 8 2 10 11 12\n");
  const ImportedPoses read = read_photo_poses(folder.path());
  EXPECT_EQ(read.frame, PhotoPoseFrame::kModel);
  ASSERT_EQ(read.poses.size(), 3U);
  EXPECT_EQ(read.poses[2].name, "b 2.jpg");
  EXPECT_EQ(read.poses[0].camera,
            (CameraModel{1600, 900, 936, 937, 799.5, 449.5, -0.01, 0.002, 0.0001, 0.0002, 0}))
      << "COLMAP counts from the outer corner";
  EXPECT_EQ(read.poses[1].camera,
            (CameraModel{800, 600, 500, 500, 399.5, 299.5, 0.05, 0, 0, 0, 0}));
  expect_near(read.poses[0].map_from_camera.translation, Eigen::Vector3d(10, 20, 30), 1e-12);
  expect_near(read.poses[0].map_from_camera.rotation.toRotationMatrix(), down_and_north(), 1e-12);
  expect_near(read.poses[1].map_from_camera.translation, Eigen::Vector3d(0, 0, -5), 1e-12);

  test::write_text(folder / "cameras.txt", "1 FISHEYE 8 8 1 2 3\n");
  expect_error(ErrorKind::kInput, {"cameras.txt:1", "FISHEYE", "cannot be expressed"},
               [&] { read_photo_poses(folder.path()); });
}

/// A camera 10 m east, 20 m north and 30 m above OpenSfM's reference.
TEST(PhotoPoses, ReadsOpenSfmAndPlacesIt) {
  const TemporaryFolder folder;
  const std::string shot = fmt::format(
      R"("a.jpg": {{"camera": "c", "rotation": [{}, 0, 0], "translation": [-10, 20, 30]}})", kPi);
  const std::string camera =
      R"("c": {"projection_type": "brown", "width": 1600, "height": 900, "focal_x": 0.5,
      "focal_y": 0.5, "c_x": 0.01, "c_y": 0, "k1": -0.01, "k2": 0, "p1": 0, "p2": 0, "k3": 0})";
  test::write_text(
      folder / "reconstruction.json",
      fmt::format(R"([{{"cameras": {{{}}}, "shots": {{{}}}, "reference_lla": {{"latitude": 60.0,
                  "longitude": 5.9, "altitude": 120.0}}}}])",
                  camera, shot));
  const ImportedPoses read = read_photo_poses(folder.path());
  ASSERT_EQ(read.frame, PhotoPoseFrame::kTopocentric);
  ASSERT_EQ(read.poses.size(), 1U);
  EXPECT_NEAR(read.poses[0].camera.fx, 800.0, 1e-12);
  EXPECT_NEAR(read.poses[0].camera.cx, 799.5 + 16.0, 1e-12);
  const MetricFrame frame = MetricFrame::around({kPlace});
  const PhotoPose pose = in_map_frame(read, frame).front();
  // In the plane of the grid: turned by the convergence, shrunk by UTM's scale.
  const double yaw = frame.yaw_of_true_heading(0.0, kPlace);
  const Eigen::Vector2d north(std::cos(yaw), std::sin(yaw));
  const Eigen::Vector2d east(north.y(), -north.x());
  const Eigen::Vector2d expected =
      frame.to_map(kPlace).vector().head<2>() + 10.0 * east + 20.0 * north;
  expect_near(pose.map_from_camera.translation.head<2>(), expected, 0.02);
  EXPECT_NEAR(pose.map_from_camera.translation.z(), 150.0, 1e-3);
  const Eigen::Matrix3d axes = pose.map_from_camera.rotation.toRotationMatrix();
  EXPECT_NEAR(axes(2, 2), -1.0, 1e-6) << "looks down";
  expect_near(axes.col(0).head<2>(), east, 1e-4);
}

TEST(PhotoPoses, ReadsMetashapeAndPlacesIt) {
  const TemporaryFolder folder;
  // A chunk of scale 2, turned against the Earth; the camera above kPlace, looking down.
  const Eigen::Matrix3d chunk =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3d centre = geocentric(kPlace);
  const Eigen::Vector3d inside(3.0, -4.0, 5.0);
  const Eigen::Vector3d shift = centre - 2.0 * chunk * inside;
  const Eigen::Matrix3d rotation =
      chunk.transpose() * geocentric_from_enu(kPlace) * down_and_north();
  const auto row = [&](const Eigen::Matrix3d& r, int i) {
    return fmt::format("{:.17g} {:.17g} {:.17g}", r(i, 0), r(i, 1), r(i, 2));
  };
  test::write_text(
      folder / "cameras.xml",
      fmt::format(
          R"(<document><chunk><sensors><sensor id="0"><calibration type="frame" class="adjusted">
          <resolution width="4000" height="3000"/><f>2400</f><cx>10</cx><cy>-5</cy><k1>-0.02</k1>
          <p1>0.001</p1><p2>0.002</p2></calibration></sensor></sensors>
          <cameras><camera id="0" sensor_id="0" label="a"><transform>{} {} {} {} {} {} 0 0 0 1
          </transform></camera><camera id="1" sensor_id="0" label="b"/></cameras>
          <transform><rotation>{} {} {}</rotation><translation>{:.9f} {:.9f} {:.9f}</translation>
          <scale>2</scale></transform></chunk></document>)",
          row(rotation, 0), inside.x(), row(rotation, 1), inside.y(), row(rotation, 2), inside.z(),
          row(chunk, 0), row(chunk, 1), row(chunk, 2), shift.x(), shift.y(), shift.z()));
  const ImportedPoses read = read_photo_poses(folder / "cameras.xml");
  ASSERT_EQ(read.frame, PhotoPoseFrame::kGeocentric);
  ASSERT_EQ(read.poses.size(), 1U) << "b was not aligned";
  EXPECT_EQ(read.poses[0].camera,
            (CameraModel{4000, 3000, 2400, 2400, 2009.5, 1494.5, -0.02, 0, 0.002, 0.001, 0}));
  const MetricFrame frame = MetricFrame::around({kPlace});
  const PhotoPose pose = in_map_frame(read, frame).front();
  expect_near(pose.map_from_camera.translation, frame.to_map(kPlace).vector(), 1e-3);
  const Eigen::Matrix3d axes = pose.map_from_camera.rotation.toRotationMatrix();
  EXPECT_NEAR(axes(2, 2), -1.0, 1e-9);
  const double yaw = frame.yaw_of_true_heading(0.0, kPlace);
  EXPECT_NEAR(std::atan2(-axes(1, 1), -axes(0, 1)), yaw, 1e-6) << "the upper edge points north";
}

/// COLMAP itself is not needed: a stand-in writes down how it was called, and a model.
TEST(ColmapProcess, RunsItsProgramsAndReadsTheLargestModel) {
  const TemporaryFolder folder;
  const auto program = folder / "bin/colmap";
  test::write_text(
      program, "#!/bin/sh\necho \"$@\" >> " + (folder / "calls").string() +
                   "\n[ $QT_QPA_PLATFORM = offscreen ] || exit 3\n"
                   "case $1 in\nmapper)\n"
                   "  for out in \"$@\"; do :; done\n  mkdir -p $out/0 $out/1;;\n"
                   "model_converter)\n  echo '1 PINHOLE 8 6 5 5 4 3' > $3/cameras.txt\n"
                   "  echo '1 1 0 0 0 0 0 0 1 a.jpg' > $3/images.txt\n  echo >> $3/images.txt\n"
                   "  case $3 in */1) echo '2 1 0 0 0 0 0 1 1 b.jpg' >> $3/images.txt;; esac;;\n"
                   "esac\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  std::filesystem::create_directories(folder / "work");
  setenv("PATH", ((folder / "bin").string() + ":" + path).c_str(), 1);
  const ImportedPoses poses = run_colmap(folder / "photos", {"a.jpg", "b.jpg"}, folder / "work");
  EXPECT_EQ(poses.poses.size(), 2U);
  const std::string calls = test::read_text(folder / "calls");
  for (const char* part : {"feature_extractor", "--ImageReader.camera_model OPENCV",
                           "--SiftExtraction.use_gpu 0", "exhaustive_matcher", "mapper"}) {
    EXPECT_NE(calls.find(part), std::string::npos) << part;
  }
  test::write_text(program, "#!/bin/sh\necho no memory\nexit 1\n");
  expect_error(ErrorKind::kProcessing, {"colmap feature_extractor failed", "colmap.log"},
               [&] { run_colmap(folder / "photos", {"a.jpg"}, folder / "work"); });
  EXPECT_NE(test::read_text(folder / "work/colmap.log").find("no memory"), std::string::npos);
  setenv("PATH", (folder / "nowhere").c_str(), 1);
  expect_error(ErrorKind::kUsage, {"colmap cannot be started", "install COLMAP"},
               [&] { run_colmap(folder / "photos", {"a.jpg"}, folder / "work"); });
  setenv("PATH", path.c_str(), 1);
}

TEST(PhotoPoses, RefusesWhatIsNone) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kInput, {"neither a COLMAP text model nor"},
               [&] { read_photo_poses(folder.path()); });
  test::write_text(folder / "a.json", "{");
  expect_error(ErrorKind::kInput, {"a.json", "no JSON"},
               [&] { read_photo_poses(folder / "a.json"); });
  test::write_text(folder / "a.json", "[{\"shots\": {\"a\": {}}}]");
  expect_error(ErrorKind::kInput, {"a.json", "missing"},
               [&] { read_photo_poses(folder / "a.json"); });
  test::write_text(folder / "a.xml", "<document><chunk/></document>");
  expect_error(ErrorKind::kInput, {"a.xml", "no aligned cameras"},
               [&] { read_photo_poses(folder / "a.xml"); });
  test::write_text(folder / "a.txt", "hello");
  expect_error(ErrorKind::kInput, {"a.txt", "no known list"},
               [&] { read_photo_poses(folder / "a.txt"); });
}

}  // namespace
}  // namespace nadir
