// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

namespace nadir {

struct ViewerEvent {
  std::uint64_t id = 0;  ///< counts from 1
  std::string name;      ///< "frame", "finished", "restart"
  std::string data;      ///< JSON, one line
};

/// Hands events of a live run to any number of watchers. Publishing never waits for a watcher: the
/// newest `capacity` events are kept, and who is slower loses the older ones and can see so by the
/// ids.
class EventHub {
 public:
  explicit EventHub(std::size_t capacity = 64) : capacity_(capacity) {}

  void publish(std::string name, std::string data);
  /// No more events come: every waiting watcher wakes.
  void close();

  /// The kept events after `id`, waiting up to `patience`, or until a stop is asked for, for the
  /// first one; empty where none came.
  std::vector<ViewerEvent> after(std::uint64_t id, std::chrono::milliseconds patience,
                                 std::stop_token stop = {}) const;
  std::uint64_t newest() const;
  bool closed() const;

 private:
  std::size_t capacity_;
  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  std::deque<std::shared_ptr<const ViewerEvent>> events_;
  std::uint64_t newest_ = 0;
  bool closed_ = false;
};

}  // namespace nadir
