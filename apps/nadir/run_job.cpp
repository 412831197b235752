// SPDX-License-Identifier: Apache-2.0
#include "run_job.hpp"

#include "nadir/io/trajectories/tum.hpp"

namespace nadir::cli {
namespace {

/// A place that nothing has been seen of yet, for the frames before the first point.
Frame blind_frame(const Sequence::LocalMap& local_map, OdomPose2 pose) {
  return {local_map.stamp,
          {Raster<std::uint8_t>(1, 1), Raster<std::uint8_t>(1, 1), {-0.5, 0.5, 1.0, {}}},
          pose};
}

}  // namespace

RunJob::RunJob(const DriveOptionsOfVerb& drive, const LocalizeOptions& options,
               const Invocation& invocation, int threads)
    : invocation_(invocation),
      drive_(open_drive(drive.input, drive.reading)),
      mapping_(drive_, mapping_options(drive, EffectiveOptions(options.sources), false)),
      localizing_(input_of(drive.input, options.seeds), options, invocation, threads) {}

LocalizeInput RunJob::input_of(const std::filesystem::path& place, int seeds) {
  LocalizeInput input{place, {}, {}, drive_.inputs};
  input.sequence.folder = place;
  input.sequence.name = drive_.name;
  for (const std::size_t position : mapping_.due()) {
    const DriveFrame& frame = drive_.frames[position];
    input.sequence.local_maps.push_back({frame.number, frame.stamp, {}});
  }
  Odometry odometry;
  for (const StampedOdomPose3& pose : *drive_.odometry) {
    odometry.push_back({pose.stamp, planar(pose.odom_from_robot)});
  }
  input.sequence.odometry = std::move(odometry);
  if (drive_.truth) input.sequence.truth = read_tum(*drive_.truth);
  input.read = [this, seeds](const Sequence::LocalMap& local_map) {
    return seeds == 1 ? map(local_map) : map_once(local_map);
  };
  input.doubts = [this] { return mapping_.doubts(); };
  return input;
}

Frame RunJob::map_once(const Sequence::LocalMap& local_map) {
  const auto known = mapped_.find(local_map.number);
  if (known != mapped_.end()) return known->second;
  return mapped_.emplace(local_map.number, map(local_map)).first->second;
}

Frame RunJob::map(const Sequence::LocalMap& local_map) {
  // The first frames may have been left out: a start at the truth begins where there is one.
  while (drive_.frames[mapping_.due()[next_]].number != local_map.number) ++next_;
  const auto rendered = mapping_.map_at(mapping_.due()[next_]);
  if (rendered) return to_frame(rendered->map);
  return blind_frame(local_map, planar(*mapping_.frames().back().odom_from_robot));
}

int RunJob::run() {
  const int exit_code = localizing_.run();
  for (const std::string& warning : mapping_.warnings()) {
    print_note("warning: " + warning, invocation_.common.quiet);
  }
  return exit_code;
}

}  // namespace nadir::cli
