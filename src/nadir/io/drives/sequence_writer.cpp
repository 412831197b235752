// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/drives/sequence_format.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/trajectories/tum.hpp"

namespace nadir {
namespace {

void emit_local_maps(YAML::Emitter& out, const Sequence& sequence) {
  out << YAML::Key << "local_maps" << YAML::Value << YAML::BeginSeq;
  for (const Sequence::LocalMap& local_map : sequence.local_maps) {
    const auto name_of = [&sequence](const std::filesystem::path& file) {
      return file.lexically_relative(sequence.folder).generic_string();
    };
    out << YAML::Flow << YAML::BeginMap;
    out << YAML::Key << "number" << YAML::Value << local_map.number;
    out << YAML::Key << "stamp" << YAML::Value << to_string(local_map.stamp);
    out << YAML::Key << "image" << YAML::Value << name_of(local_map.image);
    if (local_map.elevation) {
      out << YAML::Key << "elevation" << YAML::Value << name_of(*local_map.elevation);
    }
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

std::string index_of(const Sequence& sequence) {
  using namespace sequence_format;
  YAML::Emitter out;
  const auto file = [&out](bool present, const char* key, const char* name) {
    if (present) out << YAML::Key << key << YAML::Value << name;
  };
  out << YAML::Comment("a site of nadir; the format is explained in docs/formats.md");
  out << YAML::BeginMap;
  out << YAML::Key << "version" << YAML::Value << kVersion;
  out << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted << sequence.name;
  file(sequence.map.has_value(), "map", kMapFile);
  file(sequence.surface.has_value(), "surface", kSurfaceFile);
  file(sequence.odometry.has_value(), "odometry", kOdometryFile);
  file(sequence.truth.has_value(), "truth", kTruthFile);
  file(sequence.calibration.has_value(), "calibration", kCalibrationFile);
  emit_local_maps(out, sequence);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace

SequenceWriter::SequenceWriter(std::filesystem::path folder, std::string name) {
  if (name.empty()) throw Error(ErrorKind::kUsage, "a site needs a name", folder.string());
  create_folder(folder / sequence_format::kLocalMapFolder);
  remove_file(folder / sequence_format::kIndexFile);
  sequence_.folder = std::move(folder);
  sequence_.name = std::move(name);
}

void SequenceWriter::write_map(const Orthomosaic& map) {
  const std::filesystem::path file = sequence_.folder / sequence_format::kMapFile;
  write_orthomosaic(file, map);
  sequence_.map = file;
}

void SequenceWriter::write_surface(const ElevationMap& surface) {
  const std::filesystem::path file = sequence_.folder / sequence_format::kSurfaceFile;
  write_elevation_map(file, surface);
  sequence_.surface = file;
}

void SequenceWriter::write_local_map(int number, Stamp stamp, const Orthomosaic& local,
                                     const std::optional<ElevationMap>& elevation) {
  auto& written = sequence_.local_maps;
  if (!written.empty() && (number <= written.back().number || stamp <= written.back().stamp)) {
    throw Error(
        ErrorKind::kProcessing,
        fmt::format("local map {} at {} s does not follow {} at {} s", number, to_string(stamp),
                    written.back().number, to_string(written.back().stamp)),
        sequence_.folder.string());
  }
  const std::filesystem::path folder = sequence_.folder / sequence_format::kLocalMapFolder;
  Sequence::LocalMap entry{number, stamp, folder / fmt::format("{:06}.png", number)};
  write_orthomosaic(entry.image, local);
  if (elevation) {
    entry.elevation = folder / fmt::format("{:06}_elevation.tif", number);
    write_elevation_map(*entry.elevation, *elevation);
  }
  written.push_back(std::move(entry));
}

void SequenceWriter::write_odometry(const Odometry& odometry) {
  write_tum(sequence_.folder / sequence_format::kOdometryFile, odometry);
  sequence_.odometry = odometry;
}

void SequenceWriter::write_truth(const Trajectory& truth) {
  write_tum(sequence_.folder / sequence_format::kTruthFile, truth);
  sequence_.truth = truth;
}

void SequenceWriter::write_calibration(const std::filesystem::path& source) {
  const std::filesystem::path file = sequence_.folder / sequence_format::kCalibrationFile;
  write_file(file, read_file(source));
  sequence_.calibration = file;
}

void SequenceWriter::finish() {
  if (sequence_.local_maps.empty()) {
    throw Error(ErrorKind::kProcessing, "a site needs a local map", sequence_.folder.string());
  }
  write_file(sequence_.folder / sequence_format::kIndexFile, index_of(sequence_));
}

}  // namespace nadir
