// SPDX-License-Identifier: BSD-3-Clause
#include <repel/link/link_thread.hpp>

#include <gtest/gtest.h>

#include <atomic>

#include "link/joined.hpp"
#include "link/within.hpp"

namespace repel::link {
namespace link_thread_test {

std::atomic<int> begun{0};

TEST(LinkThread, CarriesWhatTheTicksSend) {
  test::Path forth, back;
  test::JoinedSide site(1, std::make_unique<test::Within>(forth, back));
  test::JoinedSide station(2, std::make_unique<test::Within>(back, forth));
  test::tick_both(site, station, 400);
  site.thread.stop();
  station.thread.stop();
  test::expect_joined(site, station);
  test::expect_joined(station, site);
  EXPECT_EQ(site.thread.name(), "within");
  EXPECT_EQ(site.thread.unsent(), 0);
  EXPECT_EQ(site.link.counts().lost, 0);
}

TEST(LinkThread, BeginsAsItIsTold) {
  test::Path forth, back;
  network::RemoteLink link({.session = 1});
  LinkThread thread(link, std::make_unique<test::Within>(forth, back),
                    {.begin = []() noexcept { ++begun; }});
  for (int i = 0; i < 1000 && begun == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  thread.stop();
  EXPECT_EQ(begun, 1);
}

}  // namespace link_thread_test
}  // namespace repel::link
