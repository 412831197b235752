// SPDX-License-Identifier: Apache-2.0
#include "nadir/viewer/event_hub.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stop_token>
#include <thread>

namespace nadir::cli {
namespace {

using std::chrono::milliseconds;

TEST(EventHub, GivesWhatCameAfterAnId) {
  EventHub hub;
  hub.publish("frame", "a");
  hub.publish("frame", "b");
  EXPECT_EQ(hub.newest(), 2U);
  const auto news = hub.after(1, milliseconds(0));
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(news[0].id, 2U);
  EXPECT_EQ(news[0].data, "b");
  EXPECT_TRUE(hub.after(2, milliseconds(0)).empty());
}

TEST(EventHub, ASlowWatcherLosesTheOldestAndCostsNoMemory) {
  EventHub hub(3);
  for (int i = 1; i <= 10; ++i) hub.publish("frame", std::to_string(i));
  const auto news = hub.after(0, milliseconds(0));
  ASSERT_EQ(news.size(), 3U);
  EXPECT_EQ(news.front().id, 8U);  // the ids show that 1 to 7 were lost
}

TEST(EventHub, WakesWhoWaits) {
  EventHub hub;
  std::thread publisher([&] { hub.publish("frame", "late"); });
  const auto news = hub.after(0, milliseconds(10'000));
  publisher.join();
  ASSERT_EQ(news.size(), 1U);
}

TEST(EventHub, ClosingWakesAllAndEndsEverything) {
  EventHub hub;
  std::thread closer([&] { hub.close(); });
  EXPECT_TRUE(hub.after(0, milliseconds(10'000)).empty());
  closer.join();
  hub.publish("frame", "too late");
  EXPECT_EQ(hub.newest(), 0U);
  EXPECT_TRUE(hub.closed());
}

TEST(EventHub, WhoWaitsCanBeStopped) {
  const EventHub hub;
  std::stop_source stop;
  std::thread stopper([&] { stop.request_stop(); });
  const auto started = std::chrono::steady_clock::now();
  EXPECT_TRUE(hub.after(0, milliseconds(60'000), stop.get_token()).empty());
  stopper.join();
  EXPECT_LT(std::chrono::steady_clock::now() - started, milliseconds(30'000));
}

}  // namespace
}  // namespace nadir::cli
