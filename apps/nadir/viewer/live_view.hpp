// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>

#include "nadir/viewer/event_hub.hpp"
#include "viewer/run_view.hpp"
#include "viewer/viewer_server.hpp"

namespace nadir::cli {

/// Lets browsers watch a run while it goes on, and set its pose. The run never waits for them.
class LiveView : public RunObserver {
 public:
  /// `rate_hz` slows the run down to that many frames a second; 0 = as fast as it can.
  LiveView(const RunSources& sources, const LocalizerOptions& options,
           const std::filesystem::path& particle_file, const ServerOptions& server, double rate_hz);

  void frame_done(const FrameRecord& record, const ParticleSet& particles) override;
  std::optional<Prior> new_start() override;

  std::string url() const { return server_.url(); }
  /// The run has ended: says so to the watchers and serves on until an interrupt.
  void serve_until_interrupted();

 private:
  void wait_for_the_next() const;

  Sequence sequence_;
  RunView run_;
  EventHub events_;
  std::mutex mutex_;
  std::optional<Prior> asked_;
  ViewerServer server_;
  double rate_hz_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Waits until SIGINT or SIGTERM.
void wait_for_interrupt();

}  // namespace nadir::cli
