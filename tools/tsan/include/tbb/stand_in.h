// SPDX-License-Identifier: Apache-2.0
// Takes the place of oneTBB in the tsan build. The library of the distribution is not built for
// ThreadSanitizer, which then reports a race at everything that a task reads; and a suppression of
// libtbb covers every frame below its scheduler, so all of our loop bodies, and finds nothing. Here
// the same interface, as far as nadir uses it, runs on std::thread, which the sanitizer
// understands. A header of oneTBB that has no counterpart here ends in a link error.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {

/// As in oneTBB, the smallest limit alive holds.
class global_control {
 public:
  enum parameter { max_allowed_parallelism, thread_stack_size };

  global_control(parameter which, std::size_t value) : which_(which), value_(value) {
    const std::scoped_lock lock(mutex());
    controls().push_back(this);
  }
  ~global_control() {
    const std::scoped_lock lock(mutex());
    std::erase(controls(), this);
  }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

  static std::size_t active_value(parameter which) {
    const std::scoped_lock lock(mutex());
    // More threads than most machines that test have cores: it is their interleaving that counts.
    std::size_t value = 4;
    for (const global_control* control : controls()) {
      if (control->which_ == which) value = std::min(value, control->value_);
    }
    return value;
  }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  static std::vector<const global_control*>& controls() {
    static std::vector<const global_control*> instance;
    return instance;
  }

  parameter which_;
  std::size_t value_;
};

namespace detail {

/// Threads that a loop started here may use: 1 inside a loop, the arena's number inside an arena.
inline std::size_t& arena_limit() {
  thread_local std::size_t limit = 64;
  return limit;
}

/// Sets the limit of this thread for a scope.
class ArenaScope {
 public:
  explicit ArenaScope(std::size_t limit) : before_(std::exchange(arena_limit(), limit)) {}
  ~ArenaScope() { arena_limit() = before_; }
  ArenaScope(const ArenaScope&) = delete;
  ArenaScope& operator=(const ArenaScope&) = delete;

 private:
  std::size_t before_;
};

template <class Body>
void run(std::size_t count, const Body& body) {
  const std::size_t threads =
      std::min({count, arena_limit(),
                global_control::active_value(global_control::max_allowed_parallelism)});
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    const ArenaScope nested(1);
    try {
      for (std::size_t i = next++; i < count; i = next++) body(i);
    } catch (...) {
      const std::scoped_lock lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace detail

template <class Value>
class blocked_range {
 public:
  using const_iterator = Value;
  using size_type = std::size_t;

  blocked_range(Value begin, Value end, std::size_t grain = 1)
      : begin_(begin), end_(end), grain_(grain) {}
  Value begin() const { return begin_; }
  Value end() const { return end_; }
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  std::size_t grainsize() const { return grain_; }
  bool empty() const { return !(begin_ < end_); }

 private:
  Value begin_;
  Value end_;
  std::size_t grain_;
};

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  if (!(first < last)) return;
  detail::run(static_cast<std::size_t>(last - first),
              [&](std::size_t i) { body(static_cast<Index>(first + static_cast<Index>(i))); });
}

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  if (range.empty()) return;
  const std::size_t blocks = (range.size() + range.grainsize() - 1) / range.grainsize();
  detail::run(blocks, [&](std::size_t block) {
    const auto begin = static_cast<Value>(range.begin() + block * range.grainsize());
    const auto length = std::min(range.grainsize(), static_cast<std::size_t>(range.end() - begin));
    body(blocked_range<Value>(begin, static_cast<Value>(begin + length), range.grainsize()));
  });
}

class task_arena {
 public:
  static constexpr int automatic = -1;
  explicit task_arena(int threads = automatic) : threads_(threads) {}
  int max_concurrency() const {
    return threads_ > 0 ? threads_
                        : static_cast<int>(global_control::active_value(
                              global_control::max_allowed_parallelism));
  }
  template <class Body>
  decltype(auto) execute(Body&& body) {
    const detail::ArenaScope scope(static_cast<std::size_t>(max_concurrency()));
    return std::forward<Body>(body)();
  }

 private:
  int threads_;
};

namespace this_task_arena {
inline int max_concurrency() { return task_arena().max_concurrency(); }
}  // namespace this_task_arena

}  // namespace tbb

inline const char* TBB_runtime_version() { return "stand-in for ThreadSanitizer"; }
