// SPDX-License-Identifier: BSD-3-Clause
#include <repel/link/udp.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <optional>
#include <string>

#include "link/joined.hpp"

namespace repel::link {
namespace udp_test {

/// A site on a port that is free.
std::unique_ptr<Transport> open_site(UdpOptions& options) {
  for (int i = 0;; ++i) {
    options.port = static_cast<std::uint16_t>(20000 + (getpid() * 13 + i) % 20000);
    try {
      return open_udp(options);
    } catch (const SetupError&) {
      if (i == 100) throw;
    }
  }
}
UdpOptions station_of(UdpOptions site) {
  site.side = Side::station;
  return site;
}

TEST(Udp, JoinsTwoSidesOfOneMachine) {
  for (const char* const address : {"127.0.0.1", "::1"}) {
    UdpOptions options{.address = address};
    std::optional<test::JoinedSide> site;
    try {
      site.emplace(1, open_site(options));
    } catch (const SetupError&) {
      if (std::string(address) == "::1") continue;  // a machine without IPv6
      throw;
    }
    test::JoinedSide station(2, open_udp(station_of(options)));
    test::tick_both(*site, station, 400);
    test::expect_joined(*site, station);
    test::expect_joined(station, *site);
    EXPECT_NE(station.thread.name().find(std::to_string(options.port)), std::string::npos);
  }
}

TEST(Udp, TheStationMayComeFirst) {
  UdpOptions options;
  open_site(options);  // finds a port, and leaves it
  test::JoinedSide station(2, open_udp(station_of(options)));
  for (int i = 0; i < 40; ++i) {
    station.tick(1.0);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  test::JoinedSide site(1, open_udp(options));
  test::tick_both(site, station, 100);
}

TEST(Udp, ASecondStationIsNotAnsweredWhileThereIsOne) {
  UdpOptions options;
  test::JoinedSide site(1, open_site(options));
  auto station = std::make_unique<test::JoinedSide>(2, open_udp(station_of(options)));
  test::tick_both(site, *station, 50);
  test::JoinedSide second(3, open_udp(station_of(options)));
  for (int i = 0; i < 50; ++i) {
    site.tick(1.0);
    station->tick(1.0);
    second.tick(1.0);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
  }
  EXPECT_EQ(site.link.counts().sessions, 1);
  EXPECT_FALSE(second.link.is_linked());
  station.reset();
  test::tick_both(site, second, 50);
  EXPECT_EQ(site.link.counts().sessions, 2);
}

// It keeps sending, and was first.
TEST(Udp, AStationOfAnotherSceneKeepsNobodyOut) {
  UdpOptions options{.agreement = 5};
  test::JoinedSide site(1, open_site(options));
  const auto stranger = open_udp(station_of(options));
  network::RemotePacket packet;
  packet.session = 9;
  packet.agreement = 6;
  const auto knock = [&] {
    ++packet.sequence;
    packet.sent += 2500000;
    (void)stranger->send(packet);
  };
  for (int i = 0; i < 40; ++i) {
    knock();
    site.tick(1.0);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
  }
  EXPECT_FALSE(site.link.is_linked());
  test::JoinedSide station(2, open_udp(station_of(options)));
  int both = 0;
  for (int i = 0; i < 4000 && both < 50; ++i) {
    knock();
    site.tick(1.0);
    station.tick(1.0);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
    both += site.link.is_linked() && station.link.is_linked() ? 1 : 0;
  }
  EXPECT_EQ(both, 50);
  EXPECT_GT(site.link.counts().strangers, 40);
  EXPECT_EQ(site.link.counts().sessions, 1);
  EXPECT_FALSE(stranger->receive(packet)) << "it is never answered";
}

TEST(Udp, SaysWhoElseCanReachTheSite) {
  UdpOptions options;
  EXPECT_EQ(open_site(options)->exposure(), "");
  options.address = "127.3.2.1";
  EXPECT_EQ(open_site(options)->exposure(), "");
  options.address = "0.0.0.0";
  const std::string open = open_site(options)->exposure();
  EXPECT_NE(open.find("0.0.0.0:" + std::to_string(options.port)), std::string::npos) << open;
  EXPECT_NE(open.find("any network of this machine can drive the robot"), std::string::npos);
  EXPECT_NE(open.find("--key FILE"), std::string::npos) << open;
  for (const char* const any : {"::", "::ffff:0.0.0.0"}) {
    options.address = any;
    try {
      EXPECT_NE(open_site(options)->exposure(), "") << any;
    } catch (const SetupError&) {
      continue;  // a machine without IPv6
    }
  }
  // A station hears only where it sends to.
  options.address = "0.0.0.0";
  EXPECT_EQ(open_udp(station_of(options))->exposure(), "");
}

TEST(Udp, KnowsTheAddressesOfThisMachineAlone) {
  for (const char* const here : {"127.0.0.1", "127.3.2.1", "::1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(is_on_this_machine({.address = here})) << here;
  }
  for (const char* const elsewhere : {"0.0.0.0", "10.0.0.7", "::", "fe80::1", "::ffff:10.0.0.7"}) {
    EXPECT_FALSE(is_on_this_machine({.address = elsewhere})) << elsewhere;
  }
}

TEST(Udp, CountsWhatIsNoPacket) {
  UdpOptions options;
  const auto site = open_site(options);
  const auto station = open_udp(station_of(options));
  network::RemotePacket packet;
  EXPECT_FALSE(site->send(packet));  // there is nobody yet
  EXPECT_TRUE(station->send(packet));
  site->wait(std::chrono::milliseconds(100));
  EXPECT_TRUE(site->receive(packet));
  EXPECT_FALSE(site->receive(packet));
  EXPECT_EQ(site->foreign(), 0);
}

TEST(Udp, RefusesAnAddressThatIsNone) {
  EXPECT_THROW((void)open_udp({.address = "not an address"}), SetupError);
  UdpOptions options;
  const auto site = open_site(options);
  try {
    (void)open_udp(options);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(options.port)), std::string::npos);
  }
  EXPECT_THROW((void)open_udp({.address = "192.0.2.1"}), SetupError);  // not of this machine
}

}  // namespace udp_test
}  // namespace repel::link
