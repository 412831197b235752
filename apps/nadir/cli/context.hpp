// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/invocation.hpp"
#include "nadir/pipelines/context.hpp"

namespace nadir::cli {

/// What a pipeline is told by this start of the program: it stops at an interrupt, and shows its
/// progress and its notes on standard error as the flags say.
PipelineContext context_of(const Invocation& invocation);

/// Says why, where `--device auto` falls back from the GPU that this build could use. To be called
/// when the computing begins: what is refused before says its error alone.
void note_device(const CommonOptions& common);

}  // namespace nadir::cli
