// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "nadir/aerial_mapping/sfm/matching.hpp"

namespace nadir::aerial {

/// Features and pairs as bytes of this machine, for a MappingStore. What was cut off or is of
/// another length gives nothing.
std::string to_bytes(const PhotoFeatures& features);
std::optional<PhotoFeatures> features_from(std::string_view bytes);
std::string to_bytes(const VerifiedPair& pair);
std::optional<VerifiedPair> pair_from(std::string_view bytes);

}  // namespace nadir::aerial
