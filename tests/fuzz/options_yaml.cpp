// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/options/yaml_options.hpp"
#include "nadir/pipelines/effective_options.hpp"

NADIR_FUZZ_TARGET(options_yaml) {
  nadir::StageOptions options;
  nadir::OptionTable table = nadir::option_table(options);
  nadir::read_yaml_options(nadir::fuzz::as_file("run.yaml", input), table);
  nadir::dump_yaml_options(table, {});
}
