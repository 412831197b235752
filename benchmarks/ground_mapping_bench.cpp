// SPDX-License-Identifier: Apache-2.0
// Ground mapping on the real stereo sequences: time by stage for one and two threads, coverage,
// odd against even frames, colour rules compared. Prints the report as Markdown.
//
//   ground_mapping_bench DATA [--pictures FOLDER]

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "nadir/core/error.hpp"
#include "nadir/ground_mapping/mapper.hpp"
#include "nadir/ground_mapping/self_check.hpp"
#include "nadir/io/image.hpp"

namespace {

using namespace nadir;
namespace fs = std::filesystem;

struct Drive {
  std::string name;
  StereoRig rig;
  std::vector<StereoFrame> frames;
  std::vector<OdomPose3> poses;
};

std::vector<double> numbers_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<double> numbers;
  for (double value = 0.0; in >> value;) numbers.push_back(value);
  return numbers;
}

/// The robot frame sits at the left camera: these data do not say how high that stands.
Drive read_drive(const fs::path& folder) {
  Drive drive;
  drive.name = folder.filename().string();
  const std::vector<double> calibration = numbers_of(folder / "calib.txt");
  const std::vector<double> poses = numbers_of(folder / "poses.txt");
  const Eigen::Quaterniond axes = forward_camera_rotation();
  for (std::size_t i = 0; i + 12 <= poses.size(); i += 12) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> m(poses.data() + i);
    const Transform3<frames::Odom, frames::Odom> first{
        Eigen::Quaterniond(Eigen::Matrix3d(m.leftCols<3>())).normalized(), m.col(3)};
    drive.poses.push_back(
        {(axes * first.rotation * axes.conjugate()).normalized(), axes * first.translation});
    char name[32];
    std::snprintf(name, sizeof name, "%06zu.png", i / 12);
    drive.frames.push_back({Stamp{static_cast<std::int64_t>(i / 12) * 100000000},
                            read_image(folder / "image_l" / name),
                            read_image(folder / "image_r" / name)});
  }
  CameraModel camera;
  camera.width = drive.frames.at(0).left.width();
  camera.height = drive.frames.at(0).left.height();
  camera.fx = calibration.at(0);
  camera.fy = calibration.at(5);
  camera.cx = calibration.at(2);
  camera.cy = calibration.at(6);
  drive.rig.left = drive.rig.right = camera;
  drive.rig.right_from_left.translation.x() = calibration.at(15) / calibration.at(12);
  drive.rig.robot_from_left.rotation = axes;
  drive.rig.rectified = true;
  return drive;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

void print_times(const Drive& drive, double scale) {
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    GroundMappingOptions options;
    options.image_scale = scale;
    GroundMapper mapper(drive.rig, options);
    std::map<std::string, std::vector<double>> ms;
    const double before = cpu_seconds();
    for (std::size_t i = 0; i < drive.frames.size(); ++i) {
      const StageTimes t = mapper.integrate(drive.frames[i], drive.poses[i]).ms;
      for (const auto& [name, value] :
           std::initializer_list<std::pair<const char*, double>>{{"rectify", t.rectify},
                                                                 {"depth", t.depth},
                                                                 {"points", t.points},
                                                                 {"aggregate", t.aggregate},
                                                                 {"fuse", t.fuse},
                                                                 {"clean", t.clean},
                                                                 {"total", t.total()}}) {
        ms[name].push_back(value);
      }
    }
    const double cpu_ms = 1e3 * (cpu_seconds() - before) / static_cast<double>(drive.frames.size());
    std::printf("| %s | %d x %d | %d |", drive.name.c_str(),
                static_cast<int>(drive.rig.left.width * scale),
                static_cast<int>(drive.rig.left.height * scale), threads);
    for (const char* name : {"rectify", "depth", "points", "aggregate", "fuse", "clean", "total"}) {
      std::printf(" %.1f |", median(ms[name]));
    }
    std::printf(" %.1f | %.0f |\n", cpu_ms, 1e3 / median(ms["total"]));
    std::fflush(stdout);
  }
}

LocalMap map_of(const Drive& drive, const GroundMappingOptions& options, bool print_growth) {
  GroundMapper mapper(drive.rig, options);
  if (print_growth) std::printf("| %s |", drive.name.c_str());
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const FrameStatistics s = mapper.integrate(drive.frames[i], drive.poses[i]);
    if (std::getenv("NADIR_VERBOSE")) {
      std::fprintf(stderr,
                   "%zu in %ld drop nd %ld rg %ld h %ld out %ld tx %ld sp %ld gate %ld | new %d "
                   "upd %d rej %d repl %d clr %d innov %.3f %.3f gain %.3f\n",
                   i, s.points_in, s.dropped.no_disparity, s.dropped.range, s.dropped.height,
                   s.dropped.outside, s.dropped.texture, s.dropped.sparse, s.dropped.gate,
                   s.cells_new, s.cells_updated, s.cells_rejected, s.cells_replaced,
                   s.cells_cleared, s.innovation_median_m, s.innovation_p90_m, s.exposure_gain);
      for (const auto& w : s.warnings) std::fprintf(stderr, "   %s\n", w.c_str());
    }
    if (print_growth && (i == 0 || i == 4 || i == 9 || i == 19 || i + 1 == drive.frames.size())) {
      const LocalMap map = mapper.render({});
      std::printf(" %.1f / %.1f |", 100 * map.coverage, 100 * coverage_of(map, 9.0));
    }
  }
  if (print_growth) std::printf("\n");
  std::fflush(stdout);
  return mapper.render({});
}

void print_consistency(const Drive& drive, const std::string& label,
                       const std::function<void(GroundMappingOptions&)>& change) {
  GroundMappingOptions options;
  change(options);
  OddEvenCheck check(drive.rig, options);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    check.integrate(drive.frames[i], drive.poses[i]);
  }
  const MapComparison c = check.compare({});
  std::printf("| %s | %s | %.3f | %d, %d | %.1f / %.1f | %.0f |\n", drive.name.c_str(),
              label.c_str(), c.zncc, c.shift_columns, c.shift_rows, 100 * c.height_median_m,
              100 * c.height_p90_m, 100 * c.overlap);
  std::fflush(stdout);
}

void write_picture(const LocalMap& map, const fs::path& file) {
  Raster<std::uint8_t> picture(map.ortho.width(), map.ortho.height(), 0, 4);
  for (int row = 0; row < picture.height(); ++row) {
    for (int column = 0; column < picture.width(); ++column) {
      for (int c = 0; c < 3; ++c) {
        picture.at(column, row, c) =
            map.ortho.image.at(column, row, std::min(c, map.ortho.image.channels() - 1));
      }
      picture.at(column, row, 3) = map.ortho.valid.at(column, row) == kHole ? 0 : 255;
    }
  }
  write_png(file, picture);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: ground_mapping_bench DATA [--pictures FOLDER]\n");
    return 2;
  }
  try {
    std::vector<Drive> drives;
    for (const char* name : {"straight_street", "odometry_01"}) {
      drives.push_back(read_drive(fs::path(argv[1]) / "kitti_stereo" / name));
    }
    std::printf("## Time, ms a frame (median), without decoding\n\n");
    std::printf(
        "| drive | pixels | threads | rectify | depth | points | aggregate | fuse | clean | total "
        "| CPU | frames/s |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Drive& drive : drives) {
      print_times(drive, 1.0);
      print_times(drive, 0.5);
    }
    std::printf(
        "\n## Coverage of the robot-centred square of 18 m / 9 m, %%, after so many frames\n\n");
    std::printf("| drive | 1 | 5 | 10 | 20 | 51 |\n|---|---|---|---|---|---|\n");
    for (const Drive& drive : drives) {
      const LocalMap map = map_of(drive, {}, true);
      if (argc > 3) write_picture(map, fs::path(argv[3]) / (drive.name + ".png"));
    }
    std::printf("\n## Even frames against odd frames, 18 m square at the last pose\n\n");
    std::printf(
        "| drive | rule | ZNCC | shift, px | height difference median / p90, cm | overlap, %% "
        "|\n|---|---|---|---|---|---|\n");
    for (const Drive& drive : drives) {
      for (const auto& [rule, name] : kColourRuleNames) {
        if (rule == ColourRule::kAuto) continue;
        const ColourRule r = rule;
        print_consistency(drive, name, [r](GroundMappingOptions& o) { o.colour_rule = r; });
      }
      print_consistency(drive, "mean, half-size images",
                        [](GroundMappingOptions& o) { o.image_scale = 0.5; });
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::printf("\nLargest resident memory %.0f MB, with all images of both drives in it.\n",
                static_cast<double>(usage.ru_maxrss) / 1024.0);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
