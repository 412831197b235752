// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

namespace nadir {

/// Thrown by work that was asked to stop. Neither an Error nor a std::exception: what handles
/// failures must not take it for one.
struct Stopped {};

/// Whether work is still wanted: the one way in which long work is stopped. Whoever starts the work
/// gives the question, work asks it every few tenths of a second where it can, and ends by throwing
/// Stopped; what is half done is dropped, what is kept elsewhere (MappingStore) stays.
class StopToken {
 public:
  /// Work that is never asked to stop.
  StopToken() = default;
  /// `asked` says whether to stop; it is called often, from several threads at once, and must not
  /// throw. Once it has said so it must go on saying so.
  explicit StopToken(std::function<bool()> asked) : asked_(std::move(asked)) {}

  bool stop_requested() const { return asked_ && asked_(); }
  /// Throws Stopped where that is asked for.
  void check() const {
    if (stop_requested()) throw Stopped{};
  }

 private:
  std::function<bool()> asked_;
};

}  // namespace nadir
