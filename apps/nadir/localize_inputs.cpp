// SPDX-License-Identifier: Apache-2.0
#include "localize_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/streams.hpp"
#include "nadir/core/error.hpp"
#include "nadir/pipelines/frame_range.hpp"
#include "nadir/pipelines/site.hpp"

namespace nadir::cli {

bool uses_odometry_file(const std::string& odometry, const Sequence& sequence) {
  if (odometry == "file" && !sequence.odometry) {
    throw Error(ErrorKind::kUsage, "the site has no odometry", "--odometry file",
                "use --odometry maps");
  }
  return odometry != "maps" && sequence.odometry;
}

std::vector<Sequence::LocalMap> frames_of(const LocalizeOptions& options, const Sequence& sequence,
                                          bool quiet) {
  std::vector<Sequence::LocalMap> frames =
      select_frames(sequence, parse_frame_range(options.frames));
  if (options.start.prior != "truth" || !sequence.truth) return frames;
  const auto first = std::ranges::find_if(frames, [&](const Sequence::LocalMap& map) {
    return truth_at(sequence, map.stamp).has_value();
  });
  if (first == frames.begin() || first == frames.end()) return frames;
  if (!options.frames.empty()) {
    print_note(
        fmt::format("the first true pose is that of frame {}: taken as the prior of frame {}",
                    first->number, frames.front().number),
        quiet);
    return frames;
  }
  print_note(
      fmt::format("starting at frame {}, the first with a true pose; --frames A:B takes others",
                  first->number),
      quiet);
  frames.erase(frames.begin(), first);
  return frames;
}

void note_coverage(const Odometry& odometry, const std::vector<Sequence::LocalMap>& frames,
                   bool quiet) {
  const auto covered = std::ranges::count_if(frames, [&](const Sequence::LocalMap& map) {
    return !odometry.empty() && odometry.front().stamp <= map.stamp &&
           map.stamp <= odometry.back().stamp;
  });
  if (covered == std::ssize(frames)) return;
  print_note(
      fmt::format("the odometry covers {} of {} frames; between the others the local maps are "
                  "registered",
                  covered, frames.size()),
      quiet);
}

}  // namespace nadir::cli
