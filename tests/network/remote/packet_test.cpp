// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/packet.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>

namespace repel::network {
namespace packet_test {

static_assert(std::is_trivially_copyable_v<RemotePacket>);

RemotePacket sound() {
  RemotePacket packet;
  packet.session = 7;
  packet.sequence = 1;
  packet.sent = 1000;
  return packet;
}

TEST(RemotePacket, OfFiniteNumbersIsSound) {
  EXPECT_TRUE(is_sound(sound()));
  EXPECT_FALSE(is_sound(RemotePacket{}));
}

TEST(RemotePacket, WithAnImpossibleNumberIsNot) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    RemotePacket packet = sound();
    packet.sum.back() = bad;
    EXPECT_FALSE(is_sound(packet));
    packet = sound();
    packet.values.back() = bad;
    EXPECT_FALSE(is_sound(packet));
    packet = sound();
    packet.energy_sent = bad;
    EXPECT_FALSE(is_sound(packet));
  }
  RemotePacket packet = sound();
  packet.energy_played = -1.0;
  EXPECT_FALSE(is_sound(packet));
  packet = sound();
  packet.sequence = 0;
  EXPECT_FALSE(is_sound(packet));
  packet = sound();
  packet.heard_for = -1;
  EXPECT_FALSE(is_sound(packet));
}

}  // namespace packet_test
}  // namespace repel::network
