// SPDX-License-Identifier: BSD-3-Clause
#include "lobby.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace repel::visual {
namespace lobby_test {

/// Newcomers, identified by numbers, and those that were evicted.
struct Door {
  explicit Door(std::size_t most, std::size_t most_of_one) : lobby(most, most_of_one) {}

  std::shared_ptr<Seat> enter(int number, const std::string& from) {
    auto seat = lobby.enter(from);
    seat->leave = [this, number] { gone.push_back(number); };
    return seat;
  }

  Lobby lobby;
  std::vector<int> gone;
};

TEST(Lobby, TheOldestOfAnAddressMakesWayForItsNext) {
  Door door(10, 2);
  std::vector<std::shared_ptr<Seat>> seats;
  for (int i = 0; i < 5; ++i) seats.push_back(door.enter(i, "a"));
  EXPECT_EQ(door.gone, (std::vector<int>{0, 1, 2}));
  seats.push_back(door.enter(5, "b"));
  EXPECT_EQ(door.gone.size(), 3U) << "another address has seats of its own";
}

TEST(Lobby, WhenItIsFullOneOfTheLargestCrowdLeaves) {
  Door door(4, 3);
  std::vector<std::shared_ptr<Seat>> seats;
  seats.push_back(door.enter(0, "alone"));
  for (int i = 1; i <= 3; ++i) seats.push_back(door.enter(i, "crowd"));
  seats.push_back(door.enter(4, "newcomer"));
  EXPECT_EQ(door.gone, (std::vector<int>{1}));
}

TEST(Lobby, WhoIsBeingAnsweredStaysWhileOthersAreIdle) {
  Door door(3, 3);
  std::vector<std::shared_ptr<Seat>> seats;
  for (int i = 0; i < 3; ++i) seats.push_back(door.enter(i, "a"));
  seats[0]->idle = false;
  seats.push_back(door.enter(3, "a"));
  EXPECT_EQ(door.gone, (std::vector<int>{1}));
  for (const auto& seat : seats) seat->idle = false;
  seats.push_back(door.enter(4, "a"));
  EXPECT_EQ(door.gone, (std::vector<int>{1, 0})) << "one that takes its answer slowly";
}

TEST(Lobby, ASeatThatIsLeftIsFree) {
  Door door(1, 1);
  for (int i = 0; i < 5; ++i) (void)door.enter(i, "a");
  EXPECT_TRUE(door.gone.empty());
}

TEST(Lobby, OfIPv6EverybodyHasTheLowerHalf) {
  const auto network = [](const char* address) {
    return network_of(boost::asio::ip::make_address(address));
  };
  EXPECT_EQ(network("2001:db8::1"), network("2001:db8::ffff:1"));
  EXPECT_NE(network("2001:db8::1"), network("2001:db8:0:1::1"));
  EXPECT_NE(network("10.0.0.1"), network("10.0.0.2"));
  EXPECT_EQ(network("10.0.0.1"), network("::ffff:10.0.0.1"));
}

}  // namespace lobby_test
}  // namespace repel::visual
