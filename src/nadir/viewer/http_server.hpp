// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <list>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "nadir/viewer/http_connection.hpp"
#include "nadir/viewer/http_limits.hpp"

namespace nadir {

/// cpp-httplib's server behind a door of its own. The library reads requests, routes and answers
/// them; but it spends a thread of a fixed pool on each connection, however silent, and reads lines
/// and chunked bodies of any length. Here every connection has a thread, a deadline and bounds
/// (HttpLimits); where all are taken, the one that has been waiting longest for its client makes
/// room, so that whoever asks at once is answered at once.
class HttpServer : private httplib::Server {
 public:
  explicit HttpServer(const HttpLimits& limits);
  ~HttpServer() override;
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  HttpServer(HttpServer&&) = delete;
  HttpServer& operator=(HttpServer&&) = delete;

  using httplib::Server::Get;
  using httplib::Server::Post;
  using httplib::Server::set_exception_handler;
  using httplib::Server::set_pre_routing_handler;

  /// Listens at an address and a port, 0 = any free one, and serves on threads of its own. Returns
  /// the port; 0 where it cannot listen there.
  int start(const std::string& address, int port);
  /// Ends every connection, whatever its client does. Waits for the handlers that are computing:
  /// one that waits for something must end by stopping().
  void stop();
  std::stop_token stopping() const { return stop_.get_token(); }
  /// Open connections.
  std::size_t connections() const;

 private:
  struct Client {
    std::optional<HttpConnection> connection;  ///< absent once it has ended
    std::thread thread;
  };

  void accept_clients();
  void admit(int socket);
  bool make_room(std::unique_lock<std::mutex>& lock);
  bool shut_longest_waiting();
  void join_ended();
  void serve(HttpConnection& connection);
  void leave(Client& client);

  HttpLimits limits_;
  std::stop_source stop_;
  std::thread acceptor_;
  mutable std::mutex mutex_;
  std::condition_variable left_;
  std::list<Client> clients_;  ///< those that ended too, until their threads are joined
  std::size_t open_ = 0;       ///< of the clients
};

}  // namespace nadir
