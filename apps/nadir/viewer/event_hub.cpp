// SPDX-License-Identifier: Apache-2.0
#include "event_hub.hpp"

#include <algorithm>
#include <iterator>

namespace nadir::cli {

void EventHub::publish(std::string name, std::string data) {
  {
    const std::scoped_lock lock(mutex_);
    if (closed_) return;
    events_.push_back({++newest_, std::move(name), std::move(data)});
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

std::vector<ViewerEvent> EventHub::after(std::uint64_t id,
                                         std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return closed_ || newest_ > id; });
  const auto first =
      std::ranges::find_if(events_, [id](const ViewerEvent& event) { return event.id > id; });
  return {first, events_.end()};
}

std::uint64_t EventHub::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

bool EventHub::closed() const {
  const std::scoped_lock lock(mutex_);
  return closed_;
}

}  // namespace nadir::cli
