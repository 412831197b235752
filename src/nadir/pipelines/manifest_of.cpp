// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/manifest_of.hpp"

#include <utility>

#include "nadir/version.hpp"

namespace nadir {

Manifest manifest_of(const PipelineContext& context, int threads,
                     std::vector<std::filesystem::path> inputs) {
  Manifest manifest;
  manifest.program_version = NADIR_VERSION;
  manifest.arguments = context.arguments;
  manifest.seed = context.seed;
  manifest.threads = threads;
  manifest.inputs = std::move(inputs);
  return manifest;
}

}  // namespace nadir
