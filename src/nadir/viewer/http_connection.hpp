// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>
// It includes <resolv.h>, whose macro would rename parameters of Eigen.
#undef _res

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "nadir/viewer/http_limits.hpp"

namespace nadir {

/// One client's socket, as the HTTP library reads and writes it: no call waits longer than the
/// limits say, and no more is read than they allow. One thread serves it; shut() and
/// waiting_since() may be called from others.
class HttpConnection final : public httplib::Stream {
 public:
  using Clock = std::chrono::steady_clock;

  /// Takes over the socket, which does not block, and closes it at last. `limits` must outlive it.
  HttpConnection(int socket, const HttpLimits& limits);
  ~HttpConnection() override;
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;
  HttpConnection(HttpConnection&&) = delete;
  HttpConnection& operator=(HttpConnection&&) = delete;

  enum class Head {
    kComplete,     ///< read() gives it, and then the body
    kGone,         ///< closed by the client, or not one byte came in time
    kLate,         ///< begun and not finished in time
    kLineTooLong,  ///< more than HttpLimits::request_line
    kTooLong,      ///< more than HttpLimits::head
  };
  /// Waits for request line and headers of the next request, up to `patience` for the first byte.
  /// What is left of the request before is skipped only as far as read() has given it.
  Head await_head(std::chrono::milliseconds patience);
  /// Whether the request that await_head() found may be followed by another. One with a body may
  /// not: what an answer leaves unread of it would be taken for the next request.
  bool may_be_followed() const;

  /// Sends a bare status ("408 Request Timeout"), without waiting for a client that takes nothing.
  void refuse(std::string_view status) const;
  /// Ends the answers and waits a moment for the client to close: closing on unread input would
  /// reset the connection, and the client might lose an answer that is on its way.
  void finish();
  /// Ends both directions: whoever waits for this client waits no more.
  void shut() const;
  /// Since when this connection has been waiting for its client; nothing while it is not.
  std::optional<Clock::time_point> waiting_since() const;

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* data, std::size_t size) override;
  ssize_t write(const char* data, std::size_t size) override;
  /// Nothing here asks who the client is.
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  bool wait(short event, Clock::time_point deadline) const;
  bool receive(std::size_t most);
  std::string_view head() const { return std::string_view(buffer_).substr(0, head_size_); }

  int socket_;
  const HttpLimits& limits_;
  std::string buffer_;         ///< what has come, from the first byte of this request
  std::size_t read_ = 0;       ///< of the buffer, by read()
  std::size_t head_size_ = 0;  ///< of the request
  Clock::time_point deadline_{};
  mutable std::atomic<Clock::rep> waiting_since_{0};  ///< 0 = not waiting
};

}  // namespace nadir
