// SPDX-License-Identifier: Apache-2.0
#include "viewer/viewer_server.hpp"

#include <gtest/gtest.h>
#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "loopback_client.hpp"
#include "nadir/core/random.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "run_files.hpp"
#include "support/temporary_folder.hpp"

namespace nadir::cli {
namespace {

constexpr int kFrames = 3;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::string_view kAskForEvents = "GET /api/events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";

Orthomosaic blocks(int width, int height) {
  Orthomosaic map{{width, height}, {width, height, 255}, {0.0, 0.1 * height, 0.1, {}}};
  const RandomStream random(3, 0);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const auto cell = static_cast<std::uint64_t>((row / 4) * 1000 + column / 4);
      map.image.at(column, row) = static_cast<std::uint8_t>(random.uniform(cell, 20.0, 230.0));
    }
  }
  return map;
}

/// Ten metres of the map around the robot, which stands at (25 + frame, 15) and looks east.
Orthomosaic cut_from(const Orthomosaic& map, int frame) {
  Orthomosaic local{{100, 100}, {100, 100, 255}, {-5.0, 5.0, 0.1, {}}};
  for (int row = 0; row < 100; ++row) {
    for (int column = 0; column < 100; ++column) {
      local.image.at(column, row) = map.image.at(200 + 10 * frame + column, 100 + row);
    }
  }
  return local;
}

void write_site(const std::filesystem::path& folder) {
  const Orthomosaic map = blocks(600, 300);
  SequenceWriter writer(folder, "test \"site\"");
  writer.write_map(map);
  for (int i = 0; i < kFrames; ++i)
    writer.write_local_map(i + 1, Stamp{i * kSecond}, cut_from(map, i));
  writer.finish();
}

TEST(RunView, TellsWhereOnTheEarthTheCornersAre) {
  const test::TemporaryFolder folder;
  write_site(folder.path());
  Orthomosaic map = blocks(600, 300);
  // On the central meridian of UTM zone 32, x = 500 km, longitude is 9 degrees.
  map.geo = {500000.0, 5316000.0, 0.1, MetricFrame::around({{48.0, 9.0}}).crs()};
  write_orthomosaic(folder / "utm.tif", map);
  const RunView run({folder.path(), folder / "utm.tif"}, LocalizerOptions{},
                    folder / "particles.bin", true);
  const Json corners = run.document()["map"]["corners"];
  ASSERT_EQ(corners.size(), 4U);
  EXPECT_NEAR(corners[0][0].get<double>(), 9.0, 1e-9);
  EXPECT_NEAR(corners[2][0].get<double>(), 9.0, 1e-9);
  // 60 m of the map to the east, 30 m to the south; the scale of UTM is 0.9996.
  const double radius = 6378137.0 * 0.9996 * std::cos(48.0 / 57.29578);
  EXPECT_NEAR(corners[1][0].get<double>(), 9.0 + 60.0 / radius * 57.29578, 2e-5);
  EXPECT_NEAR(corners[0][1].get<double>() - corners[2][1].get<double>(), 30.0 / 111170.0, 1e-6);

  const RunView local({folder.path(), folder / "map.tif"}, LocalizerOptions{},
                      folder / "particles.bin", true);
  EXPECT_TRUE(local.document()["map"]["corners"].is_null());
}

TEST(RunView, DoesNotKeepTheRunWaitingWhileItTellsALongOne) {
  const test::TemporaryFolder folder;
  write_site(folder.path());
  RunView run({folder.path(), folder / "map.tif"}, LocalizerOptions{}, folder / "particles.bin",
              true);
  for (int i = 0; i < 20'000; ++i) run.add(ViewFrame{});
  using Seconds = std::chrono::duration<double>;
  const auto now = [] { return std::chrono::steady_clock::now(); };
  std::atomic<bool> told{false};
  Seconds telling{0.0};
  std::thread watcher([&] {
    const auto started = now();
    const Json document = run.document();
    telling = now() - started;
    told = true;
  });
  Seconds longest{0.0};
  while (!told) {
    const auto started = now();
    run.add(ViewFrame{});
    longest = std::max<Seconds>(longest, now() - started);
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  watcher.join();
  EXPECT_LT(longest.count(), 0.3 * telling.count());
}

/// A site of three frames, the view of its live run, and a server.
class ViewerServerTest : public ::testing::Test {
 protected:
  ViewerServerTest() {
    write_site(folder_ / "site");
    log_ = std::make_unique<ParticleLogWriter>(folder_ / "particles.bin");
    run_ = std::make_unique<RunView>(RunSources{folder_ / "site", folder_ / "site/map.tif"},
                                     LocalizerOptions{}, folder_ / "particles.bin", true);
    for (int i = 0; i < kFrames; ++i) add_frame(i);
    ServerOptions options;
    options.port = 0;
    options.most_watchers = 12;
    server_ = std::make_unique<ViewerServer>(
        *run_, &events_, [this](const Prior& prior) { asked_ = prior; }, options);
    server_->start();
  }

  ~ViewerServerTest() override {
    events_.close();
    server_->stop();
  }

  void add_frame(int i) {
    log_->append({{{25.0 + i, 15.0, 0.0}, {26.0, 15.0, 0.1}}, {1.0, 1.0}, {0.75, 0.25}});
    ViewFrame frame;
    frame.number = i + 1;
    frame.stamp = Stamp{i * kSecond};
    frame.status = "ok";
    frame.map_from_robot = {25.0 + i, 15.0, 0.0};
    frame.best_score = std::numeric_limits<double>::quiet_NaN();
    run_->add(frame);
  }

  std::shared_ptr<httplib::Client> client() const {
    auto client = std::make_shared<httplib::Client>("127.0.0.1", server_->port());
    client->set_read_timeout(60, 0);
    return client;
  }

  httplib::Headers own_origin() const {
    return {{"Origin", "http://127.0.0.1:" + std::to_string(server_->port())}};
  }

  test::TemporaryFolder folder_;
  EventHub events_;
  std::unique_ptr<ParticleLogWriter> log_;
  std::unique_ptr<RunView> run_;
  std::optional<Prior> asked_;
  std::unique_ptr<ViewerServer> server_;
};

TEST_F(ViewerServerTest, TellsTheRun) {
  const auto answer = client()->Get("/api/run");
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 200);
  const Json run = Json::parse(answer->body);
  EXPECT_EQ(run["name"], "test \"site\"");
  EXPECT_EQ(run["map"]["width"], 600);
  EXPECT_EQ(run["live"], true);
  ASSERT_EQ(run["frames"].size(), std::size_t{kFrames});
  EXPECT_NEAR(run["frames"][1]["pose"][0].get<double>(), 26.0, 1e-12);
  EXPECT_EQ(run["frames"][1]["best_score"], nullptr);  // NaN is no JSON
}

TEST_F(ViewerServerTest, GivesParticlesTilesLocalAndHeatMaps) {
  const auto particles = client()->Get("/api/particles/1");
  ASSERT_TRUE(particles);
  ASSERT_EQ(particles->body.size(), 2 * sizeof(LoggedParticle));
  LoggedParticle first;
  std::memcpy(&first, particles->body.data(), sizeof(first));
  EXPECT_NEAR(first.x, 26.0, 1e-4);   // from the map's west edge
  EXPECT_NEAR(first.y, -15.0, 1e-4);  // from its north edge
  EXPECT_FLOAT_EQ(first.weight, 0.75F);

  EXPECT_EQ(client()->Get("/api/tiles/0/0/0")->get_header_value("Content-Type"), "image/png");
  EXPECT_EQ(Json::parse(client()->Get("/api/local/0")->body)["width"], 100);
  const Json heat = Json::parse(client()->Get("/api/heat/1")->body);
  // The local map is a copy, but its high-pass knows nothing of what lies beyond its edge.
  EXPECT_GT(heat["highest"].get<double>(), 0.8);
  EXPECT_LT(heat["lowest"].get<double>(), 0.5);
}

/// `nadir run` maps a drive on the way: where it kept no local maps, there are none to show.
TEST_F(ViewerServerTest, ARunWithoutASiteIsShownWithoutLocalMaps) {
  RunResult result;
  for (int i = 0; i < kFrames; ++i) {
    const Estimate estimate{Stamp{i * kSecond}, {25.0 + i, 15.0, 0.0}, PoseCovariance::Identity()};
    result.records.push_back({i, estimate, 0.0, 0.0});
  }
  write_run(folder_ / "run", result, {});
  const Json sources{{"drive", (folder_ / "campus_3/").string()},
                     {"map", (folder_ / "site/map.tif").string()}};
  test::write_text(folder_ / "run/manifest.json", Json{{"sources", sources}}.dump());
  const auto view = RunView::open(folder_ / "run", {});
  const Json document = view->document();
  EXPECT_EQ(document["name"], "campus_3");
  EXPECT_EQ(document["frames"].size(), std::size_t{kFrames});
  EXPECT_TRUE(document["odometry"].empty());
  EXPECT_FALSE(view->local_map(0));
  EXPECT_FALSE(view->heat_map(0));
  // Where a site is given, it is shown.
  EXPECT_TRUE(RunView::open(folder_ / "run", {folder_ / "site", {}})->local_map(1));
}

TEST_F(ViewerServerTest, ServesThePageWithAStrictPolicy) {
  const auto page = client()->Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'none'"),
            std::string::npos);
  const auto again = client()->Get("/", {{"If-None-Match", page->get_header_value("ETag")}});
  EXPECT_EQ(again->status, 304);
}

TEST_F(ViewerServerTest, NothingElseCanBeReached) {
  for (const char* path :
       {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/assets/../../manifest.json",
        "/manifest.json", "/api/tiles/0/0/9", "/api/tiles/99/0/0", "/api/particles/99",
        "/api/particles/-1", "/api/local/999999999", "/api/heat/77", "/api/tiles/0/0/0/../../x",
        "//etc/passwd", "/api"}) {
    const auto answer = client()->Get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 404) << path;
  }
}

TEST_F(ViewerServerTest, RefusesOtherNamesAndOrigins) {
  const auto rebound = client()->Get("/api/run", {{"Host", "evil.example"}});
  ASSERT_TRUE(rebound);
  EXPECT_EQ(rebound->status, 403);
  const std::string pose = R"({"x":1,"y":2,"yaw":0.5,"position_m":2,"yaw_spread":0.2})";
  const auto foreign = client()->Post("/api/initial_pose", {{"Origin", "http://evil.example"}},
                                      pose, "application/json");
  ASSERT_TRUE(foreign);
  EXPECT_EQ(foreign->status, 403);
  EXPECT_EQ(client()->Post("/api/initial_pose", own_origin(), pose, "text/plain")->status, 415);
  EXPECT_FALSE(asked_);
}

TEST_F(ViewerServerTest, TakesAnInitialPoseOfALiveRun) {
  const std::string pose = R"({"x":1.5,"y":-2,"yaw":0.5,"position_m":2,"yaw_spread":0.2})";
  const auto post = [&](const std::string& body) {
    return client()->Post("/api/initial_pose", own_origin(), body, "application/json")->status;
  };
  EXPECT_EQ(post(pose), 200);
  ASSERT_TRUE(asked_);
  EXPECT_DOUBLE_EQ(asked_->pose.x, 1.5);
  EXPECT_DOUBLE_EQ(asked_->spread.yaw_rad, 0.2);
  for (const char* wrong :
       {"{", "[]", R"({"x":1})", R"({"x":"1","y":2,"yaw":0,"position_m":1,"yaw_spread":0})",
        R"({"x":1e99,"y":2,"yaw":0,"position_m":1,"yaw_spread":0})",
        R"({"x":1,"y":2,"yaw":0,"position_m":-1,"yaw_spread":0})"}) {
    EXPECT_EQ(post(wrong), 400) << wrong;
  }
  run_->finish();
  EXPECT_EQ(post(pose), 409);
}

TEST_F(ViewerServerTest, ManyWatchersHearOfEveryFrame) {
  constexpr int kWatchers = 10;
  std::atomic<int> served{0};
  std::vector<std::thread> watchers;
  for (int k = 0; k < kWatchers; ++k) {
    watchers.emplace_back([&] {
      std::string heard;
      client()->Get("/api/events?after=0", [&](const char* data, std::size_t length) {
        heard.append(data, length);
        return heard.find("event: finished") == std::string::npos;
      });
      if (heard.find("id: 1\nevent: frame\ndata: {\"index\":3}") != std::string::npos) ++served;
    });
  }
  while (server_->watchers() < kWatchers) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  events_.publish("frame", R"({"index":3})");
  events_.publish("finished", "{}");
  for (std::thread& watcher : watchers) watcher.join();
  EXPECT_EQ(served.load(), kWatchers);
}

TEST_F(ViewerServerTest, AStalledClientHoldsNobodyUp) {
  // It asks for the events and never reads them.
  const test::LoopbackClient stalled(server_->port());
  ASSERT_TRUE(stalled.send(kAskForEvents));
  while (server_->watchers() < 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));

  const std::string frame(200'000, 'x');  // far more than the sockets' buffers hold
  const auto started = std::chrono::steady_clock::now();
  for (int i = 0; i < 200; ++i) events_.publish("frame", frame);
  const std::chrono::duration<double> publishing = std::chrono::steady_clock::now() - started;
  EXPECT_LT(publishing.count(), 4.0);  // less than the time after which the client is given up
  EXPECT_EQ(client()->Get("/api/run")->status, 200);
}

TEST_F(ViewerServerTest, APageIsServedBeside500SilentConnections) {
  std::vector<test::LoopbackClient> silent;
  for (int i = 0; i < 500; ++i) silent.emplace_back(server_->port());
  const auto started = std::chrono::steady_clock::now();
  const auto page = client()->Get("/");
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - started;
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_LT(waited.count(), 1.0);
}

TEST_F(ViewerServerTest, AWatcherStaysForAsLongAsItReads) {
  ServerOptions options;
  options.port = 0;
  options.limits.to_ask = options.limits.between = options.limits.to_take =
      std::chrono::milliseconds(200);
  ViewerServer server(*run_, &events_, {}, options);
  server.start();
  const test::LoopbackClient watcher(server.port());
  watcher.send(kAskForEvents);
  const auto hears = [&](const std::string& text) {
    events_.publish("frame", text);
    return watcher.read_until(text, std::chrono::seconds(20)).ends_with(text);
  };
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(hears("frame " + std::to_string(i)));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(600));  // nothing happens
  ASSERT_TRUE(hears("after a pause"));
  // It is not in the way of those who come later, however many they are.
  std::vector<test::LoopbackClient> silent;
  for (int i = 0; i < 500; ++i) silent.emplace_back(server.port());
  ASSERT_TRUE(hears("in a crowd"));
}

/// An interrupt comes while browsers watch and others hold their connections open.
TEST_F(ViewerServerTest, StopsBeside500OpenConnections) {
  std::vector<test::LoopbackClient> crowd;
  for (int i = 0; i < 500; ++i) {
    crowd.emplace_back(server_->port());
    if (i % 3 == 0) crowd.back().send("GET / HTTP/1.1\r\nHost: 127");
  }
  for (int i = 0; i < 12; ++i) {
    crowd.emplace_back(server_->port());
    crowd.back().send(kAskForEvents);
  }
  while (server_->watchers() < 12) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const auto started = std::chrono::steady_clock::now();
  server_->stop();
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - started;
  EXPECT_LT(waited.count(), 3.0);
  EXPECT_EQ(server_->watchers(), 0);
}

TEST_F(ViewerServerTest, RefusesTheNewestOfTooManyWatchers) {
  std::vector<test::LoopbackClient> watchers;
  for (int i = 0; i < 40; ++i) watchers.emplace_back(server_->port());
  for (const test::LoopbackClient& watcher : watchers) watcher.send(kAskForEvents);
  int watching = 0;
  int refused = 0;
  for (const test::LoopbackClient& watcher : watchers) {
    const std::string answer = watcher.read_until("\r\n", std::chrono::seconds(20));
    watching += answer.starts_with("HTTP/1.1 200 ") ? 1 : 0;
    refused += answer.starts_with("HTTP/1.1 503 ") ? 1 : 0;
  }
  EXPECT_EQ(watching, 12);
  EXPECT_EQ(refused, 28);
}

}  // namespace
}  // namespace nadir::cli
