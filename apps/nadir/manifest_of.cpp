// SPDX-License-Identifier: Apache-2.0
#include "manifest_of.hpp"

#include "libraries.hpp"

namespace nadir::cli {

Manifest manifest_of(const Invocation& invocation, int threads,
                     std::vector<std::filesystem::path> inputs) {
  Manifest manifest;
  manifest.program_version = program_version();
  manifest.arguments = invocation.arguments;
  manifest.seed = invocation.common.seed;
  manifest.threads = threads;
  manifest.inputs = std::move(inputs);
  return manifest;
}

}  // namespace nadir::cli
