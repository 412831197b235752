// SPDX-License-Identifier: Apache-2.0
// Ground mapping on the real stereo sequences: time by stage for one and two threads, coverage,
// odd against even frames, colour rules compared. Prints the report as Markdown.
//
//   ground_mapping_bench DATA [--pictures FOLDER] [--quick] [--set NAME=VALUE]...

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
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

struct Arguments {
  fs::path data;
  fs::path pictures;
  bool quick = false;  ///< coverage and the default rule alone
  GroundMappingOptions mapping;
  RenderOptions rendering;
};

Arguments parse(std::span<char*> words) {
  Arguments arguments;
  OptionTable table;
  declare(table, arguments.mapping);
  declare(table, arguments.rendering);
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word = words[i];
    if (word == "--quick") {
      arguments.quick = true;
    } else if (word == "--pictures" && i + 1 < words.size()) {
      arguments.pictures = words[++i];
    } else if (word == "--set" && i + 1 < words.size()) {
      const std::string setting = words[++i];
      const std::size_t equals = setting.find('=');
      table.set(setting.substr(0, equals),
                equals == std::string::npos ? "" : setting.substr(equals + 1), "--set");
    } else {
      arguments.data = word;
    }
  }
  if (arguments.data.empty()) {
    throw Error(ErrorKind::kUsage,
                "usage: ground_mapping_bench DATA [--pictures FOLDER] "
                "[--quick] [--set NAME=VALUE]...");
  }
  return arguments;
}

void print_times(const Drive& drive, const Arguments& arguments, double scale) {
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    GroundMappingOptions options = arguments.mapping;
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

/// A row of the table of coverage; the map at the end.
LocalMap print_growth(const Drive& drive, const Arguments& arguments) {
  GroundMapper mapper(drive.rig, arguments.mapping);
  std::printf("| %s |", drive.name.c_str());
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const FrameStatistics statistics = mapper.integrate(drive.frames[i], drive.poses[i]);
    for (const std::string& warning : statistics.warnings) {
      std::fprintf(stderr, "%s, frame %zu: %s\n", drive.name.c_str(), i, warning.c_str());
    }
    if (i == 0 || i == 4 || i == 9 || i == 19 || i + 1 == drive.frames.size()) {
      const LocalMap map = mapper.render(arguments.rendering);
      std::printf(" %.1f / %.1f |", 100 * map.coverage, 100 * coverage_of(map, 9.0));
    }
  }
  RenderOptions unmasked = arguments.rendering;
  unmasked.ground_only = false;
  const LocalMap map = mapper.render(unmasked);
  std::printf(" %.1f / %.1f |\n", 100 * map.coverage, 100 * coverage_of(map, 9.0));
  std::fflush(stdout);
  return mapper.render(arguments.rendering);
}

void print_consistency(const Drive& drive, const std::string& label,
                       const GroundMappingOptions& options, const RenderOptions& rendering) {
  OddEvenCheck check(drive.rig, options);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    check.integrate(drive.frames[i], drive.poses[i]);
  }
  const MapComparison c = check.compare(rendering);
  std::printf("| %s | %s | %.3f | %d, %d | %.1f / %.1f | %.0f |\n", drive.name.c_str(),
              label.c_str(), c.zncc, c.shift_columns, c.shift_rows, 100 * c.height_median_m,
              100 * c.height_p90_m, 100 * c.overlap);
  std::fflush(stdout);
}

/// Five times enlarged, holes in magenta: to be looked at. `heights`: 1 m is 85 grey values, the
/// robot's ground 85.
void write_picture(const LocalMap& map, const fs::path& file, bool heights) {
  constexpr int kScale = 5;
  Raster<std::uint8_t> picture(map.ortho.width() * kScale, map.ortho.height() * kScale, 0, 3);
  for (int row = 0; row < picture.height(); ++row) {
    for (int column = 0; column < picture.width(); ++column) {
      const int x = column / kScale, y = row / kScale;
      const float height = map.elevation.height_m.at(x, y);
      const auto shade = static_cast<std::uint8_t>(
          std::isnan(height) ? 0.0F : std::clamp(85.0F * height + 85.0F, 0.0F, 255.0F));
      const bool hole = heights ? std::isnan(height) : map.ortho.valid.at(x, y) == kHole;
      for (int c = 0; c < 3; ++c) {
        const int channel = std::min(c, map.ortho.image.channels() - 1);
        const std::uint8_t magenta = c == 1 ? 0 : 255;
        const std::uint8_t value = heights ? shade : map.ortho.image.at(x, y, channel);
        picture.at(column, row, c) = hole ? magenta : value;
      }
    }
  }
  write_png(file, picture);
}

void report(const Arguments& arguments) {
  std::vector<Drive> drives;
  for (const char* name : {"straight_street", "odometry_01"}) {
    drives.push_back(read_drive(arguments.data / "kitti_stereo" / name));
  }
  if (!arguments.quick) {
    std::printf("## Time, ms a frame (median), without decoding\n\n");
    std::printf(
        "| drive | pixels | threads | rectify | depth | points | aggregate | fuse | clean | "
        "total | CPU | frames/s |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Drive& drive : drives) {
      for (const double scale : {1.0, 0.5}) print_times(drive, arguments, scale);
    }
  }
  std::printf(
      "\n## Coverage of the robot-centred square of 18 m / 9 m, %%, after so many frames\n\n");
  std::printf(
      "| drive | 1 | 5 | 10 | 20 | 51 | 51, heights not masked |\n|---|---|---|---|---|---|---|\n");
  for (const Drive& drive : drives) {
    const LocalMap map = print_growth(drive, arguments);
    if (!arguments.pictures.empty()) {
      write_picture(map, arguments.pictures / (drive.name + ".png"), false);
      write_picture(map, arguments.pictures / (drive.name + "_height.png"), true);
    }
  }
  std::printf("\n## Even frames against odd frames, 18 m square at the last pose\n\n");
  std::printf(
      "| drive | rule | ZNCC | shift, px | height difference median / p90, cm | overlap, %% "
      "|\n|---|---|---|---|---|---|\n");
  for (const Drive& drive : drives) {
    for (const auto& [rule, name] : kColourRuleNames) {
      if (rule == ColourRule::kAuto || (arguments.quick && rule != ColourRule::kMean)) continue;
      GroundMappingOptions options = arguments.mapping;
      options.colour_rule = rule;
      print_consistency(drive, name, options, arguments.rendering);
    }
    GroundMappingOptions options = arguments.mapping;
    options.image_scale *= 0.5;
    print_consistency(drive, "mean, half-size images", options, arguments.rendering);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("\nLargest resident memory %.0f MB, with all images of both drives in it.\n",
              static_cast<double>(usage.ru_maxrss) / 1024.0);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    report(parse({argv, static_cast<std::size_t>(argc)}));
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
