// SPDX-License-Identifier: Apache-2.0
#include "effective_options.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/yaml_options.hpp"

NADIR_FUZZ_TARGET(options_yaml) {
  nadir::cli::StageOptions options;
  nadir::OptionTable table = nadir::cli::option_table(options);
  nadir::read_yaml_options(nadir::fuzz::as_file("run.yaml", input), table);
  nadir::dump_yaml_options(table, {});
}
