// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of tests/fuzz/corpus: fuzz_make_corpus FOLDER. Files of nadir's own writers, and
// a few texts. What the fuzzers found (crash-*) is kept by hand.
#include <array>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>

#include "fuzz/fuzz_site.hpp"
#include "fuzz/fuzz_target.hpp"
#include "io/gdal_files.hpp"
#include "nadir/io/drives/drive_writer.hpp"
#include "nadir/io/drives/mounting_file.hpp"
#include "nadir/io/drives/point_cloud.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/options/yaml_options.hpp"
#include "nadir/io/photos/photo_file.hpp"
#include "nadir/io/photos/photo_poses.hpp"
#include "nadir/io/trajectories/pose_file.hpp"
#include "nadir/io/trajectories/tum.hpp"
#include "support/temporary_folder.hpp"
#ifdef NADIR_CORPUS_BAGS
#include "fuzz/shrunk_bag.hpp"
#include "io/bag_drive.hpp"
#endif
#ifdef NADIR_CORPUS_APPS
#include "fuzz/fuzz_run.hpp"
#include "nadir/io/provenance/manifest.hpp"
#include "nadir/pipelines/effective_options.hpp"
#endif
#ifdef NADIR_CORPUS_SFM
#include "nadir/aerial_mapping/sfm/stored.hpp"
#endif

namespace nadir::fuzz {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::write_text;

/// Files as one input: the other way round than parts_of().
std::string joined(std::initializer_list<std::string> parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "%%\n") + part;
  return text;
}

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

const std::string kTum =
    "# timestamp tx ty tz qx qy qz qw\n1.000000000 0.5 -1 0 0 0 0.1 0.995\n"
    "1.5 1 -1.25 0 0 0 0 1\n";
const std::string kEuroc =
    "#timestamp,p_x,p_y,p_z,q_w,q_x,q_y,q_z\n1403636579763555584,4.6,-1.7,0.8,0.53,-0.15,-0.82,"
    "-0.08,0.1\n1403636579863555584,4.7,-1.7,0.8,0.53,-0.15,-0.82,-0.08,0.1\n";
const std::string kKitti =
    "1 0 0 0.1 0 1 0 0.2 0 0 1 1\n1 0 0 0.2 0 1 0 0.4 0 0 1 2\n1 0 0 0.2 0 1 0 0.4 0 0 1 3\n"
    "1 0 0 0.2 0 1 0 0.4 0 0 1 4\n";

void clouds(const fs::path& corpus) {
  std::vector<LidarPoint> points;
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<float>(i);
    points.push_back({1.5F + k, -0.25F * k, 0.5F, 0.1F * k, 0.0F});
  }
  fs::create_directories(corpus / "cloud_velodyne");
  fs::create_directories(corpus / "cloud_ply");
  write_velodyne(corpus / "cloud_velodyne/six.bin", points);
  write_ply(corpus / "cloud_ply/little.ply", points);
  write_text(corpus / "cloud_ply/ascii.ply",
             "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 2\nproperty double x\n"
             "property float y\nproperty float z\nproperty uchar red\nproperty float intensity\n"
             "element face 0\nproperty list uchar int vertex_indices\nend_header\n"
             "1.5 -2.25 3 255 0.5\n1000 0 -1 0 0\n");
  write_text(corpus / "cloud_ply/big.ply",
             "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty "
             "short y\nproperty int8 z\nend_header\n" +
                 std::string("\x3f\x80\0\0\0\x02\x03", 7));
  const std::string fields =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb intensity\nSIZE 4 4 4 4 4\nTYPE F F F U F\n"
      "COUNT 1 1 1 2 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
  write_text(corpus / "cloud_pcd/ascii.pcd", fields + "ascii\n1 2 3 0 0 0.5\nnan nan nan 0 0 0\n");
  write_text(corpus / "cloud_pcd/binary.pcd",
             fields + "binary\n" + std::string(47, '\x3f') + "\x40");
  // Two points of three fields, packed as they are: one run of 24 bytes.
  write_text(
      corpus / "cloud_pcd/compressed.pcd",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 2\nDATA binary_compressed\n" +
          raw(std::uint32_t{25}) + raw(std::uint32_t{24}) + "\x17" + std::string(24, '\x3f'));
  write_text(
      corpus / "cloud_pcd/references.pcd",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 2\nDATA binary_compressed\n" +
          raw(std::uint32_t{6}) + raw(std::uint32_t{24}) +
          std::string("\x01\x3f\x3f\xe0\x0d\x01", 6));
}

CameraModel small_camera() { return {8, 6, 9.0, 9.0, 3.5, 2.5, 0.1, -0.01, 0.001, 0.0, 0.0}; }

void poses(const fs::path& corpus) {
  write_text(corpus / "pose_tum/two.tum", kTum);
  write_text(corpus / "pose_file/two.tum", kTum);
  write_text(corpus / "pose_file/euroc.csv", kEuroc);
  write_text(corpus / "pose_file/kitti.txt", kKitti);
  write_text(
      corpus / "poses_colmap/two",
      joined({"# Camera list\n1 OPENCV 4000 3000 2900 2901 2000 1500 0.01 -0.02 0.001 0.002\n"
              "2 SIMPLE_RADIAL 400 300 290 200 150 0.01\n",
              "1 0.9 0.1 0.2 0.3 1 2 3 1 a.jpg\n10 20 -1 30 40 7\n2 1 0 0 0 1 2 4 2 b.jpg\n\n"}));
  write_text(
      corpus / "poses_opensfm/one.json",
      R"([{"cameras":{"c":{"projection_type":"brown","width":400,"height":300,"focal_x":0.8,)"
      R"("focal_y":0.8,"c_x":0,"c_y":0,"k1":0.1,"k2":0,"k3":0,"p1":0,"p2":0}},)"
      R"("reference_lla":{"latitude":48,"longitude":9,"altitude":300},"shots":{"a.jpg":)"
      R"({"rotation":[0.1,3,0.2],"translation":[1,2,3],"camera":"c"}}}])");
  write_text(
      corpus / "poses_metashape/one.xml",
      "<document><chunk><sensors><sensor id=\"0\"><calibration type=\"frame\" class=\""
      "adjusted\"><resolution width=\"400\" height=\"300\"/><f>320</f><cx>1</cx><k1>0.1</k1>"
      "</calibration></sensor></sensors><cameras><camera id=\"0\" sensor_id=\"0\" label=\"a\">"
      "<transform>1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1</transform></camera></cameras><transform>"
      "<rotation>1 0 0 0 1 0 0 0 1</rotation><translation>4200000 660000 4700000"
      "</translation><scale>1.5</scale></transform></chunk></document>\n");
  fs::create_directories(corpus / "poses_nadir");
  const PhotoPose pose{"a.jpg", small_camera(), {{1.0, 0.0, 0.0, 0.0}, {500000.0, 5.3e6, 400.0}}};
  write_photo_poses(corpus / "poses_nadir/one.json", std::vector{pose, pose}, "");
}

void photos(const fs::path& corpus) {
  Photo photo;
  photo.image = small_map(8, 6, {0.0, 0.0}).image;
  photo.metadata.make = "Maker";
  photo.metadata.model = "Model";
  photo.metadata.taken_at = Stamp{1'466'699'519'250'000'000};
  photo.metadata.position = GeodeticPosition{48.1, -9.2, 300.5};
  photo.metadata.position->horizontal_sigma_m = 0.02;
  photo.metadata.gimbal = GimbalAttitude{12.5, -90.0, 0.0};
  photo.metadata.relative_altitude_m = 80.0;
  photo.metadata.focal_length_mm = 8.8;
  for (const char* target : {"photo_metadata", "photo"}) {
    fs::create_directories(corpus / target);
    write_photo(corpus / target / "tagged.jpg", photo, 50);
  }
  const std::string tagged = read_text(corpus / "photo/tagged.jpg");
  write_text(corpus / "exif/head", tagged.substr(0, tagged.find("Maker") + 500));
  write_text(corpus / "exif/time", "2016:06:23 16:31:59%%\n25");
  write_text(corpus / "image/grey.jpg", tagged);
  write_png(corpus / "image/grey.png", photo.image);
  Raster<std::uint8_t> rgba(5, 4, 77, 4);
  write_png(corpus / "image/rgba.png", rgba);
  write_text(corpus / "image/grey.pgm", "P5\n3 2\n255\nabcdef");
  write_text(corpus / "photo_metadata/grey.png", read_text(corpus / "image/grey.png"));
}

void lists(const fs::path& corpus) {
  write_text(
      corpus / "control_points/three.txt",
      "EPSG:32632\n500000 5300000 400 10.5 20 a.jpg one\n500000 5300000 400 11 21 b.jpg one\n"
      "500010 5300010 401 1 2 a.jpg\n");
  write_text(corpus / "control_points/odm.txt", "WGS84 UTM 32N\n500000 5300000 400 10 20 a.jpg\n");
  write_text(corpus / "positions/positions.csv",
             "name,lat,lon,alt,yaw,pitch,roll,sigma\na.jpg,48.1,9.2,300,10,-90,0,0.02\nb.jpg,48.1,"
             "9.3,,,,,\n");
  write_text(corpus / "positions/geo.txt",
             "EPSG:32632\na.jpg 500000 5300000 400 1 2 3 0.1 0.2\nb.jpg 500000 5300001\n");
  const std::string place = raw(5e5F) + raw(5.3e6F);
  write_text(corpus / "reference_system/epsg", place + "EPSG:32632");
  write_text(corpus / "reference_system/odm", place + "WGS84 UTM 32S");
  write_text(corpus / "reference_system/proj", place + "+proj=utm +zone=32 +datum=WGS84");
  write_text(corpus / "reference_system/wkt",
             raw(9.0F) + raw(48.0F) +
                 "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
                 "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]");
}

const std::string kSensorYaml =
    "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, "
    "0, 0, 0, 0, 1]\nresolution: [8, 6]\ncamera_model: pinhole\nintrinsics: [9, 9, 3.5, 2.5]\n"
    "distortion_model: radial-tangential\ndistortion_coefficients: [0.1, -0.01, 0, 0]\n";
const std::string kCalib = "P0: 9 0 3.5 0 0 9 2.5 0 0 0 1 0\nP1: 9 0 3.5 -4.5 0 9 2.5 0 0 0 1 0\n";

void cameras(const fs::path& corpus) {
  const auto matrix = [](const std::string& name, int rows, int columns, const std::string& data) {
    return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
           "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: [ " + data + " ]\n";
  };
  const std::string k = "9., 0., 3.5, 0., 9., 2.5, 0., 0., 1.";
  write_text(corpus / "camera_opencv/stereo.yml",
             "%YAML:1.0\n---\n" + matrix("M1", 3, 3, k) +
                 matrix("D1", 1, 5, "0.1, 0., 0., 0., 0.") + matrix("M2", 3, 3, k) +
                 matrix("D2", 1, 5, "0.1, 0., 0., 0., 0.") +
                 matrix("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
                 matrix("T", 3, 1, "-0.5, 0., 0."));
  write_text(corpus / "camera_opencv/rectified.yml",
             "%YAML:1.0\n---\n" +
                 matrix("P1", 3, 4, "9., 0., 3.5, 0., 0., 9., 2.5, 0., 0., 0., 1., 0.") +
                 matrix("P2", 3, 4, "9., 0., 3.5, -4.5, 0., 9., 2.5, 0., 0., 0., 1., 0."));
  const std::string camera =
      "  camera_model: pinhole\n  intrinsics: [9, 9, 3.5, 2.5]\n  distortion_model: radtan\n"
      "  distortion_coeffs: [0.1, 0, 0, 0]\n  resolution: [8, 6]\n";
  write_text(corpus / "camera_kalibr/chain.yaml",
             "cam0:\n" + camera + "cam1:\n" + camera +
                 "  T_cn_cnm1:\n  - [1, 0, 0, -0.5]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n"
                 "  - [0, 0, 0, 1]\n");
  write_text(corpus / "camera_euroc/sensor.yaml", kSensorYaml);
  write_text(corpus / "camera_kitti/odometry.txt", kCalib);
  write_text(
      corpus / "camera_kitti/raw.txt",
      "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.95e-02\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
      "P_rect_02: 9 0 3.5 0.4 0 9 2.5 0 0 0 1 0\nP_rect_03: 9 0 3.5 -4 0 9 2.5 0 0 0 1 0\n");
  Mounting mounted;
  mounted.robot_from_camera = {forward_camera_rotation(), {0.1, 0.2, 1.5}};
  mounted.robot_from_lidar = {Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.8}};
  fs::create_directories(corpus / "mounting");
  write_mounting(corpus / "mounting/full.yaml", mounted);
  write_text(corpus / "mounting/short.yaml", "camera_height_m: 1.5\ncamera_pitch_deg: 10\n");
}

void drives(const fs::path& corpus) {
  write_text(corpus / "drive_kitti/four", joined({kCalib, "0\n1.0e-01\n0.2\n0.3\n", kKitti}));
  write_text(corpus / "drive_raw/two",
             joined({"R_rect_00: 1 0 0 0 1 0 0 0 1\nP_rect_02: 9 0 3.5 0 0 9 2.5 0 0 0 1 0\n",
                     "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0.1 0.2\n",
                     "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.0\n"}));
  std::string sensor = kSensorYaml;
  write_text(corpus / "drive_euroc/three",
             joined({sensor,
                     "#timestamp [ns],filename\n1403636579763555584,1.png\n"
                     "1403636579863555584,2.png\n1403636579963555584,3.png\n",
                     kEuroc}));
  write_text(corpus / "sequence/two",
             joined({"version: 1\nname: a site\nmap: map.tif\nodometry: odometry.tum\nlocal_maps:\n"
                     "- {number: 1, stamp: 1.000000000, image: local/1.tif}\n"
                     "- {number: 2, stamp: 1.25, image: local/2.tif}\n",
                     kTum}));
  write_text(corpus / "aeroground_truth/two.txt",
             "# frame x y rotation scale\n1 5 6 10 1\n2 5.5 6 12 1\n");
}

#ifdef NADIR_CORPUS_BAGS
void write_fixed(test::BagWriter& bag, const std::string& topic, const std::string& frame,
                 const std::array<double, 3>& place) {
  ros1::Transform transform;
  transform.header = {1'000'000'000, "base_link"};
  transform.child = frame;
  transform.translation = place;
  bag.write_transform(topic, transform);
}

void small_bag(const fs::path& file, bool stereo) {
  test::BagWriter bag(file);
  const Stamp stamp{1'000'000'000};
  const CameraModel camera = small_camera();
  const Raster<std::uint8_t> image = small_map(8, 6, {0.0, 0.0}).image;
  for (const auto& [side, x] :
       {std::pair{std::string("left"), 0.0}, std::pair{std::string("right"), 0.4}}) {
    if (!stereo && x > 0.0) continue;
    bag.write("/" + side + "/image_rect", test::image_message(image, stamp, side));
    bag.write("/" + side + "/camera_info", test::info_message(camera, x, stamp, side));
  }
  if (!stereo) {
    ros1::PointCloud cloud;
    cloud.header = {stamp.nanoseconds, "velodyne"};
    cloud.width = 2;
    cloud.height = 1;
    cloud.point_step = 12;
    cloud.row_step = 24;
    cloud.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}};
    cloud.bytes = std::string(24, '\x3f');
    bag.write("/points", cloud);
    write_fixed(bag, "/tf_static", "left", {0.1, 0.0, 1.0});
    write_fixed(bag, "/tf_static", "velodyne", {0.0, 0.0, 2.0});
  }
  ros1::Transform pose;
  pose.header = {stamp.nanoseconds, "odom"};
  pose.child = "base_link";
  pose.translation = {1.0, 2.0, 0.0};
  bag.write_odometry("/odom", pose);
  bag.close();
  write_text(file, shrunk_bag(read_text(file)));
}

void bags(const fs::path& corpus) {
  fs::create_directories(corpus / "rosbag");
  small_bag(corpus / "rosbag/stereo.bag", true);
  small_bag(corpus / "rosbag/lidar.bag", false);
  const std::string lidar = read_text(corpus / "rosbag/lidar.bag");
  const std::string chunk = test::chunk_of(lidar);
  write_text(corpus / "rosbag/lidar_bz2.bag",
             test::with_chunk(lidar, "bz2", test::packed_bz2(chunk), chunk.size()));
  write_text(corpus / "rosbag/lidar_lz4.bag",
             test::with_chunk(lidar, "lz4", test::packed_lz4(chunk), chunk.size()));
  std::string cloud = raw(2U) + raw(1U) + raw(16U) + raw(32U) + '\0' + '\x04';
  for (const std::uint32_t field : {0U, 1U, 2U, 3U}) {
    cloud += static_cast<char>(field) + std::string("\x07") + raw(4 * field) + raw(1U);
  }
  write_text(corpus / "ros_cloud/two", cloud + std::string(32, '\x3f'));
  write_text(corpus / "ros_image/grey", '\0' + raw(3U) + raw(2U) + raw(4U) + "abcdefgh");
  write_text(corpus / "ros_image/bayer", '\x07' + raw(2U) + raw(2U) + raw(2U) + "abcd");
  const auto camera = [](float shift) {
    std::string info = std::string("\0\0", 2) + raw(8U) + raw(6U) + '\x05';
    for (const float v : {0.1F, 0.F, 0.F, 0.F, 0.F}) info += raw(v);
    for (const float v : {9.F, 0.F, 3.5F, 0.F, 9.F, 2.5F, 0.F, 0.F, 1.F}) info += raw(v);
    for (const float v : {1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F}) info += raw(v);
    for (const float v : {9.F, 0.F, 3.5F, shift, 0.F, 9.F, 2.5F, 0.F, 0.F, 0.F, 1.F, 0.F})
      info += raw(v);
    return info;
  };
  write_text(corpus / "ros_camera/stereo", camera(0.0F) + camera(-4.5F));
}
#endif

void maps(const fs::path& corpus) {
  for (const char* target : {"orthomosaic", "orthomosaic_import", "elevation"}) {
    fs::create_directories(corpus / target);
  }
  write_orthomosaic(corpus / "orthomosaic/grey.tif", small_map(20, 16, {5e5, 5.3e6}));
  Orthomosaic colour{{4, 3, 90, 3}, {4, 3, 255}, {0.0, 3.0, 1.0, {}}};
  colour.valid.at(1, 1) = 0;
  write_orthomosaic(corpus / "orthomosaic/hole.tif", colour);
  write_text(corpus / "orthomosaic/virtual.vrt",
             "<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\"><GeoTransform>0,1,0,3,0,-1"
             "</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\"/></VRTDataset>");
  test::TiffRecipe turned;
  turned.transform = {1000.0, 0.5, 0.1, 2000.0, 0.1, -0.5};
  turned.epsg = 32632;
  test::write_tiff(corpus / "turned.tif", turned);
  test::TiffRecipe deep;
  deep.type = GDT_UInt16;
  deep.values = {700};
  test::write_tiff(corpus / "deep.tif", deep);
  test::TiffRecipe heights;
  heights.type = GDT_Float32;
  heights.values = {12};
  heights.nodata = "-9999";
  test::write_tiff(corpus / "elevation/float.tif", heights);
  write_text(corpus / "elevation/grid.asc",
             "ncols 3\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 0.5\n"
             "NODATA_value -9999\n1.5 2.5 -9999\n4 5 6\n");
  for (const char* name : {"turned.tif", "deep.tif"}) {
    write_text(corpus / "orthomosaic_import" / name, '\x01' + read_text(corpus / name));
    fs::remove(corpus / name);
  }
  write_text(corpus / "orthomosaic_import/grey.tif",
             '\x06' + read_text(corpus / "orthomosaic/grey.tif"));
  write_text(corpus / "world_file/local", "0.5\n0\n0\n-0.5\n100.25\n199.75\n");
  write_text(
      corpus / "world_file/utm",
      joined({"0.5\n0.0\n0.0\n-0.5\n500000.25\n5300000.75\n",
              "PROJCS[\"WGS 84 / UTM zone 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID["
              "\"WGS 84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\","
              "0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_"
              "of_origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER[\"scale_factor\","
              "0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],"
              "UNIT[\"metre\",1]]"}));
}

#ifdef NADIR_CORPUS_SFM
void stored(const fs::path& corpus) {
  aerial::PhotoFeatures features;
  features.points.resize(2);
  features.descriptors = cv::Mat::ones(2, 128, CV_32F);
  write_text(corpus / "stored_features/two", aerial::to_bytes(features));
  aerial::VerifiedPair pair;
  pair.inliers = {{0, 1}, {2, 3}};
  write_text(corpus / "stored_features/pair", aerial::to_bytes(pair));
}
#endif

#ifdef NADIR_CORPUS_APPS
void runs(const fs::path& corpus) {
  const fs::path run = small_run();
  write_text(corpus / "run_files/two",
             joined({read_text(run / "trajectory.tum"), read_text(run / "covariance.csv"),
                     read_text(run / "frames.csv"), read_text(run / "timing.csv"),
                     read_text(run / "trajectory.tum")}));
  write_text(corpus / "particle_log/two.bin", read_text(run / "particles.bin"));
  write_text(corpus / "map_update/one.json", R"({"version": 2, "final": false})");
  write_text(
      corpus / "manifest/short.json",
      R"({"program":"nadir","version":"0.1.0","arguments":["localize","site","--set","x=1"],)"
      R"("started":"2026-11-30T09:00:00Z","seed":1,"threads":2,"device":"cpu","options":)"
      R"({"map_matching.score":{"value":"zncc","from":"default"},"localization.temper":)"
      R"({"value":0.5,"from":"--set"},"map_matching.backend":{"value":"cpu","from":"--set"}},)"
      R"("inputs":[{"path":"a","bytes":12,"sha256":"00"}],"sources":{"site":"site","map":"map.tif"},)"
      R"("stages":[{"name":"localize","seconds":1.5}],"host":{"name":"h","system":"Linux",)"
      R"("processor":"p","logical_processors":2,"memory_bytes":1000}})");
  write_text(corpus / "options_yaml/nested.yaml",
             "# a comment\nmap_matching:\n  score: zncc\nlocalization.temper: 0.5\n");
  write_text(corpus / "options_set/three",
             "map_matching.score=zncc\nlocalization.temper=0.5\nlocalization.particles=200\n");
  for (const char* text : {"3:9", ":7", "1m", "0.5s", "3f", "5,5", "1,2,90", "1,2,3,4", "truth",
                           "1466699519.25", "-1.5e9", "0.1"}) {
    std::string name = text;
    std::ranges::replace(name, ':', '_');
    write_text(corpus / "command_line_texts" / name, text);
  }
  const auto get = [](const std::string& path) {
    return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
  };
  write_text(corpus / "http_request/page", get("/"));
  write_text(corpus / "http_request/run", get("/api/run"));
  write_text(corpus / "http_request/particles", get("/api/particles/1") + get("/api/particles/99"));
  write_text(corpus / "http_request/tile", get("/api/tiles/0/0/0"));
  write_text(corpus / "http_request/local", get("/api/local/0"));
  write_text(corpus / "http_request/heat", get("/api/heat/1"));
  write_text(corpus / "http_request/events", get("/api/events?after=0"));
  write_text(corpus / "http_request/path", get("/%2e%2e/etc/passwd"));
  const std::string pose = R"({"x":1,"y":2,"yaw":0.5,"position_m":2,"yaw_spread":0.2})";
  write_text(corpus / "http_request/pose",
             "POST /api/initial_pose HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n"
             "Content-Type: application/json\r\nContent-Length: " +
                 std::to_string(pose.size()) + "\r\n\r\n" + pose);
}
#endif

void write_all(const fs::path& corpus) {
  clouds(corpus);
  poses(corpus);
  photos(corpus);
  lists(corpus);
  cameras(corpus);
  drives(corpus);
  maps(corpus);
#ifdef NADIR_CORPUS_BAGS
  bags(corpus);
#endif
#ifdef NADIR_CORPUS_SFM
  stored(corpus);
#endif
#ifdef NADIR_CORPUS_APPS
  runs(corpus);
#endif
}

}  // namespace
}  // namespace nadir::fuzz

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: fuzz_make_corpus FOLDER\n";
    return 2;
  }
  nadir::fuzz::write_all(arguments[1]);
  return 0;
}
