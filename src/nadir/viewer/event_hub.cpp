// SPDX-License-Identifier: Apache-2.0
#include "nadir/viewer/event_hub.hpp"

#include <algorithm>
#include <utility>

namespace nadir {

void EventHub::publish(std::string name, std::string data) {
  {
    const std::scoped_lock lock(mutex_);
    if (closed_) return;
    events_.push_back(std::make_shared<const ViewerEvent>(
        ViewerEvent{++newest_, std::move(name), std::move(data)}));
    if (events_.size() > capacity_) events_.pop_front();
  }
  changed_.notify_all();
}

void EventHub::close() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

std::vector<ViewerEvent> EventHub::after(std::uint64_t id, std::chrono::milliseconds patience,
                                         std::stop_token stop) const {
  std::vector<std::shared_ptr<const ViewerEvent>> kept;
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::move(stop), patience, [&] { return closed_ || newest_ > id; });
    kept.assign(std::ranges::find_if(events_, [id](const auto& event) { return event->id > id; }),
                events_.end());
  }
  // Copied with nothing locked: many watchers, and megabytes for each.
  std::vector<ViewerEvent> events;
  for (const auto& event : kept) events.push_back(*event);
  return events;
}

std::uint64_t EventHub::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

bool EventHub::closed() const {
  const std::scoped_lock lock(mutex_);
  return closed_;
}

}  // namespace nadir
