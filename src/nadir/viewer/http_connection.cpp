// SPDX-License-Identifier: Apache-2.0
#include "nadir/viewer/http_connection.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace nadir {
namespace {

constexpr std::string_view kEndOfHead = "\r\n\r\n";
/// What a client may still send, and for how long, once it has been answered for the last time.
constexpr std::size_t kLeftover = 65'536;
constexpr auto kFarewell = std::chrono::milliseconds(500);

/// Whether a header of that name, in small letters, is there.
bool has_header(std::string_view head, std::string_view name) {
  const auto same = [](char a, char b) { return a == b || (a >= 'A' && a <= 'Z' && a + 32 == b); };
  for (std::size_t at = head.find('\n'); at != std::string_view::npos; at = head.find('\n', at)) {
    ++at;
    const std::string_view start = head.substr(at, name.size());
    if (std::ranges::equal(start, name, same)) return true;
  }
  return false;
}

}  // namespace

HttpConnection::HttpConnection(int socket, const HttpLimits& limits)
    : socket_(socket), limits_(limits) {}

HttpConnection::~HttpConnection() { ::close(socket_); }

bool HttpConnection::wait(short event, Clock::time_point deadline) const {
  const Clock::time_point start = Clock::now();
  waiting_since_ = start.time_since_epoch().count();
  int ready = 0;
  for (Clock::time_point now = start; now < deadline; now = Clock::now()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - now);
    pollfd asked{socket_, event, 0};
    ready = ::poll(&asked, 1, static_cast<int>(left.count()));
    if (ready > 0 || (ready < 0 && errno != EINTR)) break;
  }
  waiting_since_ = 0;
  return ready > 0;
}

/// Appends up to `most` bytes to the buffer; false where none come: by the deadline, or ever.
bool HttpConnection::receive(std::size_t most) {
  std::array<char, 4096> bytes;  // NOLINT(*-member-init): recv() fills it
  for (;;) {
    const ssize_t count = ::recv(socket_, bytes.data(), std::min(most, bytes.size()), 0);
    if (count > 0) {
      buffer_.append(bytes.data(), static_cast<std::size_t>(count));
      return true;
    }
    if (count == 0) return false;
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return false;
    if (!wait(POLLIN, deadline_)) return false;
  }
}

HttpConnection::Head HttpConnection::await_head(std::chrono::milliseconds patience) {
  buffer_.erase(0, read_);
  read_ = 0;
  head_size_ = 0;
  if (buffer_.empty()) {
    deadline_ = Clock::now() + patience;
    if (!receive(limits_.head)) return Head::kGone;
  }
  deadline_ = Clock::now() + limits_.to_ask;
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = buffer_.find(kEndOfHead, searched);
    const std::size_t size = end == std::string::npos ? buffer_.size() : end + kEndOfHead.size();
    if (std::min(buffer_.find('\n'), size) > limits_.request_line) return Head::kLineTooLong;
    if (size > limits_.head) return Head::kTooLong;
    if (end != std::string::npos) {
      head_size_ = size;
      return Head::kComplete;
    }
    searched = size - std::min(size, kEndOfHead.size() - 1);
    if (!receive(limits_.head + 1 - size)) {
      return Clock::now() < deadline_ ? Head::kGone : Head::kLate;
    }
  }
}

bool HttpConnection::may_be_followed() const {
  return (head().starts_with("GET ") || head().starts_with("HEAD ")) &&
         !has_header(head(), "content-length:") && !has_header(head(), "transfer-encoding:");
}

void HttpConnection::refuse(std::string_view status) const {
  std::string answer("HTTP/1.1 ");
  answer.append(status).append("\r\nConnection: close\r\nContent-Length: 0\r\n\r\n");
  ::send(socket_, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void HttpConnection::finish() {
  ::shutdown(socket_, SHUT_WR);
  deadline_ = Clock::now() + kFarewell;
  for (std::size_t left = kLeftover; left > 0; left -= std::min(left, buffer_.size())) {
    buffer_.clear();
    if (!receive(left)) return;
  }
}

void HttpConnection::shut() const { ::shutdown(socket_, SHUT_RDWR); }

std::optional<HttpConnection::Clock::time_point> HttpConnection::waiting_since() const {
  const Clock::rep since = waiting_since_;
  if (since == 0) return std::nullopt;
  return Clock::time_point(Clock::duration(since));
}

bool HttpConnection::is_readable() const {
  return read_ < buffer_.size() || wait(POLLIN, deadline_);
}

bool HttpConnection::is_writable() const { return wait(POLLOUT, Clock::now() + limits_.to_take); }

ssize_t HttpConnection::read(char* data, std::size_t size) {
  const std::size_t most = head_size_ + limits_.body;
  if (read_ >= most) return -1;
  if (read_ == buffer_.size() && !receive(most - read_)) return -1;
  const std::size_t count = std::min({size, buffer_.size() - read_, most - read_});
  std::memcpy(data, buffer_.data() + read_, count);
  read_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t HttpConnection::write(const char* data, std::size_t size) {
  for (;;) {
    const ssize_t count = ::send(socket_, data, size, MSG_NOSIGNAL);
    if (count >= 0) return count;
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
    if (!wait(POLLOUT, Clock::now() + limits_.to_take)) return -1;
  }
}

void HttpConnection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

void HttpConnection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace nadir
