// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "fuzz/fuzz_run.hpp"
#include "fuzz/fuzz_target.hpp"
#include "run_record.hpp"
#include "run_settings.hpp"
#include "viewer/run_view.hpp"

// manifest.json of a run whose other files are sound, as the report and the viewer read it.
NADIR_FUZZ_TARGET(manifest) {
  using nadir::fuzz::attempt;
  const std::filesystem::path run = nadir::fuzz::small_run();
  nadir::fuzz::as_file("run/manifest.json", input);
  const nadir::Json manifest = nadir::cli::read_manifest(run);
  attempt([&] { nadir::cli::read_run(run, manifest); });
  attempt([&] { nadir::cli::settings_of(manifest); });
  attempt([&] { nadir::cli::provenance_of(manifest); });
  const std::filesystem::path site = nadir::fuzz::scratch_folder() / "site_of_run";
  attempt([&] { nadir::cli::RunView::open(run, {site, site / "map.tif"})->document(); });
  attempt([&] { nadir::cli::RunView::open(run, {})->document(); });
}
