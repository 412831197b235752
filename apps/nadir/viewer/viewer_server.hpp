// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "nadir/pipelines/localize/prior.hpp"
#include "nadir/viewer/event_hub.hpp"
#include "nadir/viewer/http_limits.hpp"
#include "viewer/run_view.hpp"

namespace nadir::cli {

struct ServerOptions {
  std::string listen = "127.0.0.1";
  int port = 8642;         ///< 0 = any free one
  int most_watchers = 32;  ///< open event streams
  HttpLimits limits;
};

/// Serves the viewer's page and a run to browsers (docs/viewer.md has the addresses). Nothing on
/// disk can be reached by a path of the request. Requests that name another host (DNS rebinding) or
/// post from another origin are refused.
class ViewerServer {
 public:
  /// `events` of a live run; null for a finished one. `restart` takes an initial pose that a
  /// watcher set; empty where none can be set. All must outlive the server.
  ViewerServer(const RunView& run, const EventHub* events,
               std::function<void(const Prior&)> restart, const ServerOptions& options);
  ~ViewerServer();
  ViewerServer(const ViewerServer&) = delete;
  ViewerServer& operator=(const ViewerServer&) = delete;
  ViewerServer(ViewerServer&&) = delete;
  ViewerServer& operator=(ViewerServer&&) = delete;

  /// Binds and answers on threads of its own. Throws Error (usage) where the address cannot be
  /// bound.
  void start();
  /// Ends every connection, event streams too, and waits for the answers that are being computed.
  void stop();
  int port() const;
  std::string url() const;
  /// Open event streams.
  int watchers() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nadir::cli
