// SPDX-License-Identifier: Apache-2.0
#include "cli/context.hpp"

#include <memory>
#include <optional>
#include <utility>

#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "cli/streams.hpp"
#include "nadir/pipelines/threads.hpp"

namespace nadir::cli {
namespace {

/// One bar at a time: that of the stage that was heard of last.
class StageProgress {
 public:
  explicit StageProgress(CommonOptions common) : common_(std::move(common)) {}

  void update(const std::string& stage, int done, int total) {
    if (stage != stage_ || total != total_ || !bar_) {
      bar_.reset();
      bar_.emplace(stage, total, common_);
      stage_ = stage;
      total_ = total;
    }
    bar_->update(done);
  }
  /// Notes must not be written into the bar.
  void end() { bar_.reset(); }

 private:
  CommonOptions common_;
  std::string stage_;
  int total_ = 0;
  std::optional<Progress> bar_;
};

}  // namespace

PipelineContext context_of(const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  const auto bars = std::make_shared<StageProgress>(common);
  return {.overwrite = common.overwrite,
          .seed = common.seed,
          .threads = common.threads,
          .device = common.device,
          .stop = interrupt_token(),
          .progress = [bars](const std::string& stage, int done,
                             int total) { bars->update(stage, done, total); },
          .note =
              [bars, quiet = common.quiet](const std::string& text) {
                bars->end();
                print_note(text, quiet);
              },
          .arguments = invocation.arguments};
}

void note_device(const CommonOptions& common) {
  if (const auto note = device_note(common.device)) print_note(*note, common.quiet);
}

}  // namespace nadir::cli
