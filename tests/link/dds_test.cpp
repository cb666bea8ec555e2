// SPDX-License-Identifier: BSD-3-Clause
#include <repel/dds/dds.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "link/joined.hpp"
#ifdef REPEL_TEST_SEALED
#include "link/sealed_carriers.hpp"
#endif

namespace repel::dds {
namespace dds_test {

/// So that tests beside each other do not meet.
std::uint32_t own_domain() {
  return 1 + static_cast<std::uint32_t>(getpid()) % 200;
}

TEST(Dds, JoinsTwoSidesOnTheLoopbackInterface) {
  const std::uint32_t domain = own_domain();
  test::JoinedSide site(1, open_dds({.side = link::Side::site, .peer = {}, .domain = domain}));
  test::JoinedSide station(2,
                           open_dds({.side = link::Side::station, .peer = {}, .domain = domain}));
  site.link.values()[0] = 4.5;
  test::tick_both(site, station, 400);
  test::expect_joined(site, station);
  test::expect_joined(station, site);
  EXPECT_EQ(station.link.heard()[0], 4.5);
}

TEST(Dds, MeetsASideThatBeginsAnew) {
  const std::uint32_t domain = own_domain();
  test::JoinedSide site(1, open_dds({.side = link::Side::site, .peer = {}, .domain = domain}));
  for (const std::uint64_t session : {2U, 3U}) {
    test::JoinedSide station(session,
                             open_dds({.side = link::Side::station, .peer = {}, .domain = domain}));
    test::tick_both(site, station, 200);
  }
  EXPECT_EQ(site.link.counts().sessions, 2);
}

TEST(Dds, RefusesWhatThisMachineHasNot) {
  try {
    (void)open_dds({.interface = "no_such_if", .peer = {}});
    FAIL();
  } catch (const SetupError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("no_such_if"), std::string::npos);
    EXPECT_NE(what.find("allowed: "), std::string::npos);
    EXPECT_NE(what.find("lo"), std::string::npos);
  }
  EXPECT_THROW((void)open_dds({.peer = "a\"b"}), SetupError);
  EXPECT_THROW((void)open_dds({.peer = {}, .domain = 231}), SetupError);
}

// Whichever interface it sends by, Cyclone DDS listens on all of them.
TEST(Dds, SaysThatOthersCanReachTheSite) {
  const std::uint32_t domain = own_domain();
  const auto exposure_of = [&](link::Side side) {
    return open_dds({.side = side, .peer = {}, .domain = domain})->exposure();
  };
  EXPECT_NE(exposure_of(link::Side::site).find("can drive the robot"), std::string::npos);
  EXPECT_EQ(exposure_of(link::Side::station), "");
}

}  // namespace dds_test
}  // namespace repel::dds

#ifdef REPEL_TEST_SEALED
namespace repel::test {

INSTANTIATE_TEST_SUITE_P(
    Carrier, SealedOver,
    ::testing::Values(SealedCarrier{
        "Dds",
        [] {
          const std::uint32_t domain = dds::dds_test::own_domain();
          const auto open = [domain](link::Side side) {
            return dds::open_dds_datagrams({.side = side, .peer = {}, .domain = domain});
          };
          // Whoever comes first in a program has the domain, and takes it away
          // at its end.
          const std::shared_ptr<link::Datagrams> first = open(link::Side::station);
          return std::function([open, first](link::Side side) { return open(side); });
        }}),
    carrier_name);

}  // namespace repel::test
#endif
