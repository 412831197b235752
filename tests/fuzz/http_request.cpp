// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "fuzz/fuzz_run.hpp"
#include "fuzz/fuzz_target.hpp"
#include "viewer/viewer_server.hpp"

// The bytes of one connection to the viewer of a small live run, until the server closes it.
namespace nadir::fuzz {
namespace {

class Viewer {
 public:
  Viewer()
      : run_folder_(small_run()),
        site_(scratch_folder() / "site_of_run"),
        run_({site_, site_ / "map.tif"}, {}, run_folder_ / "particles.bin", true),
        server_(
            run_, &events_, [](const Prior& prior) { check(prior); }, any_port()) {
    for (int i = 0; i < 2; ++i) {
      cli::ViewFrame frame;
      frame.number = i + 1;
      frame.stamp = Stamp{1'000'000'000LL * (i + 1)};
      frame.map_from_robot = {10.0 + i, 15.0, 0.1};
      run_.add(frame);
    }
    events_.publish("frame", "{}");
    events_.close();  // so that nobody waits for news
    server_.start();
  }

  int port() const { return server_.port(); }

 private:
  static cli::ServerOptions any_port() {
    cli::ServerOptions options;
    options.port = 0;
    options.most_watchers = 1;
    return options;
  }

  static void check(const Prior& prior) {
    if (!prior.pose.is_finite() || !(prior.spread.position_m >= 0.0)) std::abort();
  }

  std::filesystem::path run_folder_;
  std::filesystem::path site_;
  EventHub events_;
  cli::RunView run_;
  cli::ViewerServer server_;
};

/// Sends all, says that no more comes, and reads up to a limit: a stream of events may be endless.
void talk(int port, std::string_view request) {
  const int connection = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
    while (!request.empty()) {
      const ssize_t sent = ::send(connection, request.data(), request.size(), MSG_NOSIGNAL);
      if (sent <= 0) break;
      request.remove_prefix(static_cast<std::size_t>(sent));
    }
    ::shutdown(connection, SHUT_WR);
    std::array<char, 4096> answer{};
    for (int i = 0; i < 256 && ::recv(connection, answer.data(), answer.size(), 0) > 0; ++i) {
    }
  }
  ::close(connection);
}

}  // namespace
}  // namespace nadir::fuzz

NADIR_FUZZ_TARGET(http_request) {
  static const nadir::fuzz::Viewer viewer;
  nadir::fuzz::talk(viewer.port(), input);
}
