// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "nadir/io/provenance/manifest.hpp"
#include "nadir/pipelines/context.hpp"

namespace nadir {

/// The manifest of a pipeline that runs in this context on `threads` threads, without stages.
Manifest manifest_of(const PipelineContext& context, int threads,
                     std::vector<std::filesystem::path> inputs);

}  // namespace nadir
