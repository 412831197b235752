// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_run.hpp"

#include "nadir/io/drives/sequence.hpp"
#include "nadir/runs/particle_log.hpp"
#include "run_files.hpp"

namespace nadir::fuzz {

std::filesystem::path small_run() {
  const std::filesystem::path run = scratch_folder() / "run";
  if (std::filesystem::exists(run / "trajectory.tum")) return run;
  SequenceWriter site(scratch_folder() / "site_of_run", "a small site");
  site.write_map(small_map(60, 60, {0.0, 30.0}));
  cli::RunResult result;
  for (int i = 0; i < 2; ++i) {
    const Stamp stamp{1'000'000'000LL * (i + 1)};
    site.write_local_map(i + 1, stamp, small_map(12, 12, {-3.0, 3.0}));
    const Estimate estimate{stamp, {10.0 + i, 15.0, 0.1}, PoseCovariance::Identity()};
    result.records.push_back({i + 1, estimate, 0.0, 0.0});
  }
  site.finish();
  cli::write_run(run, result, {});
  ParticleLogWriter log(run / "particles.bin");
  for (int i = 0; i < 2; ++i) log.append({{{10.0 + i, 15.0, 0.0}}, {1.0}, {1.0}});
  return run;
}

}  // namespace nadir::fuzz
