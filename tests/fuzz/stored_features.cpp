// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/aerial_mapping/sfm/stored.hpp"

// What a MappingStore kept of a photo and of a pair.
NADIR_FUZZ_TARGET(stored_features) {
  if (const auto features = nadir::aerial::features_from(input)) {
    nadir::fuzz::require(nadir::aerial::to_bytes(*features).size() == input.size(), "bytes lost");
  }
  if (const auto pair = nadir::aerial::pair_from(input)) {
    nadir::fuzz::require(nadir::aerial::to_bytes(*pair) == input, "another pair");
  }
}
