// SPDX-License-Identifier: Apache-2.0
// What clients that are slow, silent or greedy may take of the viewer's server.
#include "nadir/viewer/http_server.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <latch>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "loopback_client.hpp"

namespace nadir::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using test::LoopbackClient;

constexpr std::string_view kAsk = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
constexpr std::string_view kAskForMuch = "GET /much HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
constexpr std::string_view kHalfHead = "GET / HTTP/1.1\r\nHost: 127.0";
constexpr std::string_view kHalfBody =
    "POST /post HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 100\r\n\r\nhalf";
constexpr std::size_t kMuch = 16U << 20U;         ///< more than the buffers of sockets hold
constexpr milliseconds kBeforeTheDeadline(5000);  ///< of HttpLimits for a silent client
constexpr milliseconds kLong(20'000);             ///< what a test waits before it fails

/// A page, an answer of 16 MB that takes no memory, and one that takes a body.
std::unique_ptr<HttpServer> server_with(const HttpLimits& limits) {
  auto server = std::make_unique<HttpServer>(limits);
  server->Get("/", [](const auto&, auto& response) { response.set_content("page", "text/plain"); });
  server->Get("/much", [](const auto&, auto& response) {
    response.set_content_provider(kMuch, "text/plain",
                                  [](std::size_t, std::size_t left, auto& sink) {
                                    static const std::string piece(65'536, 'x');
                                    return sink.write(piece.data(), std::min(left, piece.size()));
                                  });
  });
  server->Post("/post", [](const auto& request, auto& response) {
    response.set_content(std::to_string(request.body.size()) + " bytes", "text/plain");
  });
  return server;
}

HttpLimits short_limits() {
  HttpLimits limits;
  limits.to_ask = limits.between = limits.to_take = milliseconds(300);
  return limits;
}

/// How long a client waits for the page.
double seconds_for_the_page(int port) {
  const auto started = steady_clock::now();
  const LoopbackClient client(port);
  EXPECT_TRUE(client.send(kAsk));
  EXPECT_TRUE(client.read_until("page", kLong).ends_with("page"));
  return std::chrono::duration<double>(steady_clock::now() - started).count();
}

/// Waits until a condition holds; false where it does not in time.
bool comes_true(const std::function<bool()>& condition, milliseconds patience = kLong) {
  const auto deadline = steady_clock::now() + patience;
  while (!condition()) {
    if (steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(milliseconds(2));
  }
  return true;
}

struct Nuisance {
  const char* name;
  std::string_view says;
};

class HttpServerBeside500 : public ::testing::TestWithParam<Nuisance> {};

TEST_P(HttpServerBeside500, ServesAPageWithinASecond) {
  const auto server = server_with({});
  const int port = server->start("127.0.0.1", 0);
  ASSERT_GT(port, 0);
  std::vector<LoopbackClient> crowd;
  for (int i = 0; i < 500; ++i) {
    crowd.emplace_back(port);
    crowd.back().send(GetParam().says);
  }
  ASSERT_TRUE(comes_true([&] { return server->connections() == HttpLimits{}.connections; }));
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(seconds_for_the_page(port), 1.0);
    EXPECT_LE(server->connections(), HttpLimits{}.connections);
    for (const LoopbackClient& client : crowd) client.send("x");  // one byte now and then
  }
  const auto stopping = steady_clock::now();
  server->stop();
  EXPECT_LT(steady_clock::now() - stopping, milliseconds(3000));
  EXPECT_EQ(server->connections(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Clients, HttpServerBeside500,
                         ::testing::Values(Nuisance{"Silent", ""},  //
                                           Nuisance{"HalfAHead", kHalfHead},
                                           Nuisance{"HalfABody", kHalfBody}, Nuisance{"Idle", kAsk},
                                           Nuisance{"ReadingNothing", kAskForMuch}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(HttpServer, GivesEveryClientADeadline) {
  const auto server = server_with(short_limits());
  const int port = server->start("127.0.0.1", 0);
  const auto answer_to = [&](std::string_view says) {
    const LoopbackClient client(port);
    const auto started = steady_clock::now();
    EXPECT_TRUE(client.send(says));
    const auto answer = client.read_all(kLong);
    const auto waited = steady_clock::now() - started;
    EXPECT_GE(waited, milliseconds(250)) << says;
    EXPECT_LT(waited, milliseconds(3000)) << says;
    return answer.value_or("still open");
  };
  EXPECT_EQ(answer_to(""), "");
  EXPECT_TRUE(answer_to(kHalfHead).starts_with("HTTP/1.1 408 "));
  EXPECT_TRUE(answer_to(kHalfBody).starts_with("HTTP/1.1 4"));
  EXPECT_TRUE(answer_to(kAsk).ends_with("page"));  // and no second request
  // A byte now and then is no progress.
  const LoopbackClient slow(port);
  const auto started = steady_clock::now();
  while (slow.send("G") && steady_clock::now() - started < kLong) {
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_LT(steady_clock::now() - started, milliseconds(3000));
}

TEST(HttpServer, GivesUpWhoTakesNothing) {
  const auto server = server_with(short_limits());
  const int port = server->start("127.0.0.1", 0);
  const LoopbackClient stalled(port);
  ASSERT_TRUE(stalled.send(kAskForMuch));
  ASSERT_TRUE(comes_true([&] { return server->connections() == 1; }));
  EXPECT_TRUE(comes_true([&] { return server->connections() == 0; }, milliseconds(3000)));
}

TEST(HttpServer, WhoReadsALongAnswerGetsAllOfIt) {
  const auto server = server_with(short_limits());
  const LoopbackClient client(server->start("127.0.0.1", 0));
  ASSERT_TRUE(client.send(kAskForMuch));
  const auto answer = client.read_all(kLong);
  ASSERT_TRUE(answer);
  EXPECT_GE(answer->size(), kMuch);
}

TEST(HttpServer, BoundsWhatARequestMayHold) {
  const auto server = server_with(short_limits());
  const int port = server->start("127.0.0.1", 0);
  const std::string start = "POST /post HTTP/1.1\r\nHost: 127.0.0.1\r\n";
  const std::string ten(10'000, 'a');
  std::string headers;
  for (int i = 0; i < 1000; ++i) headers += "X-" + std::to_string(i) + ": and so on\r\n";
  std::string chunks;
  for (int i = 0; i < 5; ++i) chunks += "a00\r\n" + std::string(0xa00, 'a') + "\r\n";
  const std::vector<std::pair<std::string, std::string>> requests = {
      {"GET /" + ten + " HTTP/1.1\r\n\r\n", "414"},
      {ten, "414"},
      {"GET / HTTP/1.1\r\nX: " + ten + ten, "431"},
      {"GET / HTTP/1.1\r\n" + headers + "\r\n", "431"},
      {start + "Content-Length: 1000000000000\r\n\r\n" + ten, "413"},
      {start + "Content-Length: 10000\r\n\r\n" + ten, "413"},
      {start + "Content-Length: 4097\r\n\r\n" + std::string(4097, 'a'), "413"},
      {start + "Transfer-Encoding: chunked\r\n\r\n" + chunks + "0\r\n\r\n", "4"},
      {start + "Content-Length: 4096\r\n\r\n" + std::string(4096, 'a'), "200"},
      {start + "Transfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n", "200"},
  };
  for (const auto& [request, status] : requests) {
    const LoopbackClient client(port);
    client.send(request);
    const std::string answer = client.read_all(kLong).value_or("still open");
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 " + status))
        << request.substr(0, 80) << " ... got " << answer.substr(0, 40);
  }
}

TEST(HttpServer, ABodyWithoutEndIsCutOff) {
  const auto server = server_with(short_limits());
  const LoopbackClient client(server->start("127.0.0.1", 0));
  client.send("POST /post HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "1000\r\n" + std::string(4096, 'a') + "\r\n";
  std::size_t sent = 0;
  while (client.send(chunk) && sent < kMuch) sent += chunk.size();
  EXPECT_LT(sent, kMuch);
  EXPECT_TRUE(comes_true([&] { return server->connections() == 0; }));
}

TEST(HttpServer, ABodyIsNeverTakenForTheNextRequest) {
  const auto server = server_with(short_limits());
  const int port = server->start("127.0.0.1", 0);
  const std::string length = "Content-Length: " + std::to_string(kAsk.size()) + "\r\n";
  for (const std::string& start :
       {"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n" + length,
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nCONTENT-" + length.substr(8),
        "DELETE / HTTP/1.1\r\nHost: 127.0.0.1\r\n" + length}) {
    const LoopbackClient client(port);
    client.send(start + "\r\n" + std::string(kAsk));
    const std::string answer = client.read_all(kLong).value_or("still open");
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 ")) << start;
    EXPECT_EQ(answer.find("HTTP/1.1 ", 1), std::string::npos) << start << answer;
  }
}

TEST(HttpServer, AnswersRequestsThatComeAtOnceOneByOne) {
  HttpLimits limits = short_limits();
  limits.requests = 3;
  const auto server = server_with(limits);
  const LoopbackClient client(server->start("127.0.0.1", 0));
  std::string asked;
  for (int i = 0; i < 5; ++i) asked += kAsk;
  client.send(asked);
  const std::string answer = client.read_all(kLong).value_or("still open");
  int pages = 0;
  for (std::size_t at = answer.find("page"); at != std::string::npos;
       at = answer.find("page", at + 1)) {
    ++pages;
  }
  EXPECT_EQ(pages, 3);  // then the connection is closed
}

TEST(HttpServer, WhoHasWaitedLongestMakesRoom) {
  HttpLimits limits;
  limits.connections = 3;
  const auto server = server_with(limits);
  const int port = server->start("127.0.0.1", 0);
  std::vector<LoopbackClient> silent;
  for (std::size_t i = 0; i < 3; ++i) {
    silent.emplace_back(port);
    ASSERT_TRUE(comes_true([&] { return server->connections() == i + 1; }));
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_LT(seconds_for_the_page(port), 1.0);
  EXPECT_EQ(silent[0].read_all(kBeforeTheDeadline), "");
  EXPECT_FALSE(silent[1].read_all(milliseconds(50)));
  EXPECT_FALSE(silent[2].read_all(milliseconds(50)));
}

TEST(HttpServer, WhoHasWaitedLongestMakesRoomWhereFilesRunOut) {
  const auto server = server_with({});
  const int port = server->start("127.0.0.1", 0);
  std::vector<LoopbackClient> silent;
  for (std::size_t i = 0; i < 3; ++i) {
    silent.emplace_back(port);
    ASSERT_TRUE(comes_true([&] { return server->connections() == i + 1; }));
    std::this_thread::sleep_for(milliseconds(20));
  }
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const int lowest_unused = ::dup(0);
  ::close(lowest_unused);
  // One more file may be opened: the socket of the client that asks.
  const rlimit fewer{static_cast<rlim_t>(lowest_unused) + 1, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &fewer), 0);
  EXPECT_LT(seconds_for_the_page(port), 1.0);
  EXPECT_EQ(silent[0].read_all(kBeforeTheDeadline), "");
  EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST(HttpServer, RefusesTheNewestWhereAllAreBeingAnswered) {
  HttpLimits limits;
  limits.connections = 2;
  std::latch answer(1);
  std::latch asked(2);
  const auto server = server_with(limits);
  server->Get("/slow", [&](const auto&, auto& response) {
    asked.count_down();
    answer.wait();
    response.set_content("done", "text/plain");
  });
  const int port = server->start("127.0.0.1", 0);
  const LoopbackClient first(port);
  const LoopbackClient second(port);
  for (const LoopbackClient* client : {&first, &second}) {
    client->send("GET /slow HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  }
  asked.wait();
  const LoopbackClient third(port);
  EXPECT_TRUE(third.read_all(kLong).value_or("").starts_with("HTTP/1.1 503 "));
  answer.count_down();
  EXPECT_TRUE(first.read_until("done", kLong).ends_with("done"));
  EXPECT_TRUE(second.read_until("done", kLong).ends_with("done"));
}

TEST(HttpServer, ManyShortConnectionsLeaveNothingBehind) {
  const auto server = server_with({});
  const int port = server->start("127.0.0.1", 0);
  for (int i = 0; i < 2000; ++i) ASSERT_LT(seconds_for_the_page(port), 5.0);
  EXPECT_TRUE(comes_true([&] { return server->connections() == 0; }));
}

TEST(HttpServer, SharesItsPortWithNobody) {
  const auto server = server_with({});
  const int port = server->start("127.0.0.1", 0);
  const auto another = server_with({});
  EXPECT_EQ(another->start("127.0.0.1", port), 0);
  server->stop();
  EXPECT_EQ(another->start("127.0.0.1", port), port);  // at once, while old connections linger
}

}  // namespace
}  // namespace nadir::cli
