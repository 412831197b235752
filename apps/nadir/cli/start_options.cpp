// SPDX-License-Identifier: Apache-2.0
#include "cli/start_options.hpp"

#include <CLI/CLI.hpp>

namespace nadir::cli {

void add_start_options(CLI::App& verb, PriorOptions& start) {
  verb.add_option("--prior", start.prior,
                  "Where to start: metres and degrees in the map; or truth, the first true pose "
                  "moved by the seed within the spread")
      ->type_name("X,Y,YAW_DEG|truth");
  verb.add_option("--prior-spread", start.spread,
                  "Particles start uniform in +-METRES and +-DEGREES around the prior")
      ->type_name("METRES,DEGREES")
      ->capture_default_str();
}

}  // namespace nadir::cli
