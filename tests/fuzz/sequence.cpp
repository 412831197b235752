// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/sequence.hpp"
#include "fuzz/fuzz_site.hpp"
#include "fuzz/fuzz_target.hpp"

// sequence.yaml and odometry.tum of a site whose images are there.
NADIR_FUZZ_TARGET(sequence) {
  nadir::fuzz::small_site("site");
  const auto parts = nadir::fuzz::parts_of(input, 2);
  nadir::fuzz::as_file("site/sequence.yaml", parts[0]);
  nadir::fuzz::as_file("site/odometry.tum", parts[1]);
  const nadir::Sequence sequence = nadir::read_sequence(nadir::fuzz::scratch_folder() / "site");
  nadir::fuzz::require(!sequence.local_maps.empty(), "a site without local maps");
  const nadir::Frame frame = nadir::read_frame(sequence, sequence.local_maps.front());
  nadir::fuzz::require(!frame.odom_from_robot || frame.odom_from_robot->is_finite(),
                       "an odometry that is not finite");
}
