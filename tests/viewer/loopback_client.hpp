// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace nadir::test {

/// A client that may do what no library does: stop in the middle, and never read.
class LoopbackClient {
 public:
  explicit LoopbackClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (socket_ < 0) throw std::runtime_error("no socket is left");
    const int small = 4096;  // so that an answer that is not read soon stops the server
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &small, sizeof(small));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("the server does not take the connection");
    }
  }
  ~LoopbackClient() {
    if (socket_ >= 0) ::close(socket_);
  }
  LoopbackClient(LoopbackClient&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  LoopbackClient& operator=(LoopbackClient&&) = delete;

  /// False where the server has closed the connection or takes no more.
  bool send(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  /// What the server says until it closes the connection; nothing where it has not by then.
  std::optional<std::string> read_all(std::chrono::milliseconds patience) const {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    std::string text;
    while (is_readable(deadline)) {
      char bytes[4096];
      const ssize_t count = ::recv(socket_, bytes, sizeof(bytes), 0);
      if (count <= 0) return text;
      text.append(bytes, static_cast<std::size_t>(count));
    }
    return std::nullopt;
  }

  /// What the server says until `end` is a part of it; less where it closes the connection before
  /// or the time is up.
  std::string read_until(std::string_view end, std::chrono::milliseconds patience) const {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    std::string text;
    while (text.find(end) == std::string::npos && is_readable(deadline)) {
      char byte = 0;
      if (::recv(socket_, &byte, 1, 0) != 1) break;
      text.push_back(byte);
    }
    return text;
  }

 private:
  bool is_readable(std::chrono::steady_clock::time_point deadline) const {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd asked{socket_, POLLIN, 0};
    return left.count() > 0 && ::poll(&asked, 1, static_cast<int>(left.count())) > 0;
  }

  int socket_;
};

}  // namespace nadir::test
