// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "cli/drive_options.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/core/options.hpp"
#include "nadir/pipelines/frame_range.hpp"
#include "nadir/pipelines/localize/prior.hpp"
#include "nadir/pipelines/site.hpp"

// What is typed as one word: --frames, --every, --prior, --spread, --points; stamps and numbers.
NADIR_FUZZ_TARGET(command_line_texts) {
  using nadir::fuzz::attempt;
  using nadir::fuzz::require;
  const std::string text(input);
  attempt([&] { nadir::parse_frame_range(text); });
  attempt([&] { require(nadir::cli::parse_spacing(text).amount > 0.0, "no spacing"); });
  attempt([&] { require(nadir::parse_spread(text).position_m >= 0.0, "a spread below 0"); });
  attempt([&] {
    require(nadir::start_of({text, "5,5"}, {}, 1).pose.is_finite(), "a start is not finite");
  });
  attempt([&] { nadir::parse_numbers(text, 4, "--points", "X,Y,X,Y"); });
  attempt([&] { require(std::isfinite(nadir::parse_number(text, "it")), "not finite"); });
  if (const auto stamp = nadir::parse_stamp(text)) {
    const auto again = nadir::parse_stamp(nadir::to_string(*stamp));
    require(again && *again == *stamp, "a stamp that is written is another when it is read");
  }
}
