// SPDX-License-Identifier: Apache-2.0
#include "nadir/viewer/http_server.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <exception>
#include <string_view>
#include <system_error>

namespace nadir {
namespace {

/// A client whose connection was shut is gone within microseconds; a busy machine needs longer.
constexpr auto kToMakeRoom = std::chrono::milliseconds(500);
constexpr auto kPauseAfterFailure = std::chrono::milliseconds(20);
constexpr int kSendBuffer = 262'144;  ///< bytes of answers that the system holds for a client

void set_option(socket_t socket, int option, int value) {
  ::setsockopt(socket, SOL_SOCKET, option, &value, sizeof(value));
}

/// The answer to a client whose request did not come whole; empty where none is due.
std::string_view status_for(HttpConnection::Head head) {
  switch (head) {
    case HttpConnection::Head::kLate:
      return "408 Request Timeout";
    case HttpConnection::Head::kLineTooLong:
      return "414 URI Too Long";
    case HttpConnection::Head::kTooLong:
      return "431 Request Header Fields Too Large";
    case HttpConnection::Head::kComplete:
    case HttpConnection::Head::kGone:
      break;
  }
  return {};
}

}  // namespace

HttpServer::HttpServer(const HttpLimits& limits) : limits_(limits) {
  set_tcp_nodelay(true);
  set_socket_options([](socket_t socket) {
    // The library would share a port with any other program of this user that shares it.
    set_option(socket, SO_REUSEADDR, 1);
    // Inherited by the connections: the system would let each of them grow to megabytes.
    set_option(socket, SO_SNDBUF, kSendBuffer);
  });
  set_payload_max_length(limits.body);
  // Told to the clients in "Keep-Alive".
  set_keep_alive_max_count(limits.requests);
  set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(limits.between).count());
}

HttpServer::~HttpServer() { stop(); }

int HttpServer::start(const std::string& address, int port) {
  if (port == 0) {
    port = bind_to_any_port(address);
  } else if (!bind_to_port(address, port)) {
    port = 0;
  }
  if (port <= 0) return 0;
  // The library lets five clients wait to be accepted: of a hundred that come at once, most would
  // try again after a second.
  ::listen(svr_sock_, SOMAXCONN);
  acceptor_ = std::thread([this] { accept_clients(); });
  return port;
}

void HttpServer::stop() {
  if (!acceptor_.joinable()) return;
  stop_.request_stop();
  // The library's endless answers end where this is invalid.
  const int listening = svr_sock_.exchange(INVALID_SOCKET);
  ::shutdown(listening, SHUT_RDWR);
  acceptor_.join();
  ::close(listening);
  {
    const std::scoped_lock lock(mutex_);
    for (const Client& client : clients_) {
      if (client.connection) client.connection->shut();
    }
  }
  for (Client& client : clients_) client.thread.join();
  clients_.clear();
}

std::size_t HttpServer::connections() const {
  const std::scoped_lock lock(mutex_);
  return open_;
}

void HttpServer::accept_clients() {
  const int listening = svr_sock_;
  while (!stop_.stop_requested()) {
    const int socket = ::accept4(listening, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket >= 0) {
      admit(socket);
    } else if (errno != EINTR && !stop_.stop_requested()) {
      if (errno == EMFILE || errno == ENFILE) {  // too many open files
        const std::scoped_lock lock(mutex_);
        shut_longest_waiting();
      }
      std::this_thread::sleep_for(kPauseAfterFailure);
    }
  }
}

void HttpServer::admit(int socket) {
  std::unique_lock lock(mutex_);
  join_ended();
  Client& client = clients_.emplace_back();
  client.connection.emplace(socket, limits_);
  try {
    if (make_room(lock)) {
      client.thread = std::thread([this, &client] {
        serve(*client.connection);
        leave(client);
      });
      ++open_;
      return;
    }
  } catch (const std::system_error&) {  // the system has no thread left
  }
  client.connection->refuse("503 Service Unavailable");
  clients_.pop_back();
}

/// Where all connections are taken, ends one; false where none is waiting for its client.
bool HttpServer::make_room(std::unique_lock<std::mutex>& lock) {
  const auto room = [this] { return open_ < limits_.connections; };
  return room() || (shut_longest_waiting() && left_.wait_for(lock, kToMakeRoom, room));
}

bool HttpServer::shut_longest_waiting() {
  const HttpConnection* longest = nullptr;
  auto earliest = HttpConnection::Clock::time_point::max();
  for (const Client& client : clients_) {
    const auto since = client.connection ? client.connection->waiting_since() : std::nullopt;
    if (!since || *since >= earliest) continue;
    longest = &*client.connection;
    earliest = *since;
  }
  if (longest != nullptr) longest->shut();
  return longest != nullptr;
}

void HttpServer::join_ended() {
  for (auto client = clients_.begin(); client != clients_.end();) {
    if (client->connection) {
      ++client;
      continue;
    }
    client->thread.join();
    client = clients_.erase(client);
  }
}

void HttpServer::serve(HttpConnection& connection) {
  std::chrono::milliseconds patience = limits_.to_ask;
  try {
    for (std::size_t left = limits_.requests; left > 0; --left) {
      const HttpConnection::Head head = connection.await_head(patience);
      if (head != HttpConnection::Head::kComplete) {
        if (head != HttpConnection::Head::kGone) connection.refuse(status_for(head));
        break;
      }
      const bool last = left == 1 || !connection.may_be_followed();
      bool closed = false;
      if (!process_request(connection, last, closed, nullptr) || last || closed) break;
      patience = limits_.between;
    }
    connection.finish();
  } catch (const std::exception&) {
    // No memory for this client, say. It loses its connection; the run goes on.
  }
}

void HttpServer::leave(Client& client) {
  const std::scoped_lock lock(mutex_);
  client.connection.reset();
  --open_;
  left_.notify_all();
}

}  // namespace nadir
