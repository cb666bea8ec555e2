// SPDX-License-Identifier: BSD-3-Clause
#include <repel/link/wire.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include <support/families.hpp>

namespace repel::link {
namespace wire_test {

constexpr unsigned seed = 720;

network::RemotePacket drawn(families::Rng& rng) {
  network::RemotePacket packet;
  packet.session = rng();
  packet.agreement = rng();
  packet.sequence = static_cast<std::int64_t>(rng() >> 1U);
  packet.sent = static_cast<std::int64_t>(rng() >> 1U);
  packet.heard = rng();
  packet.heard_sent = static_cast<std::int64_t>(rng() >> 1U);
  packet.heard_for = static_cast<std::int64_t>(rng() >> 1U);
  packet.energy_sent = families::uniform(rng, 0.0, 1e9);
  packet.energy_played = families::uniform(rng, 0.0, 1e9);
  for (double& x : packet.sum) x = families::uniform(rng, -1e9, 1e9);
  for (double& x : packet.values) x = families::uniform(rng, -1e9, 1e9);
  return packet;
}

TEST(Wire, APacketComesBackAsItWas) {
  families::Rng rng(seed);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "packet", i));
    const network::RemotePacket packet = drawn(rng);
    WireBytes bytes;
    encode(packet, bytes);
    network::RemotePacket back;
    ASSERT_TRUE(decode(bytes, back));
    EXPECT_EQ(std::memcmp(&packet, &back, sizeof packet), 0);
  }
}

// Two versions of the program may meet, on machines of different kinds.
TEST(Wire, HasTheseBytes) {
  network::RemotePacket packet;
  packet.session = 0x0102030405060708U;
  WireBytes bytes;
  encode(packet, bytes);
  const std::vector<int> expected{'r', 'e', 'p', 'e', 'l', 0, 0, 1, 8, 7, 6, 5, 4, 3, 2, 1};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << i;
  }
  EXPECT_EQ(bytes.size(), 720U);
}

TEST(Wire, OtherBytesAreNoPacket) {
  WireBytes bytes;
  encode({}, bytes);
  network::RemotePacket packet;
  EXPECT_FALSE(decode({bytes.data(), bytes.size() - 1}, packet));
  EXPECT_FALSE(decode({}, packet));
  std::vector<std::byte> longer(bytes.begin(), bytes.end());
  longer.push_back(std::byte{0});
  EXPECT_FALSE(decode(longer, packet));
  for (std::size_t i = 0; i < 8; ++i) {
    WireBytes other = bytes;
    other[i] ^= std::byte{1};
    EXPECT_FALSE(decode(other, packet));
  }
}

}  // namespace wire_test
}  // namespace repel::link
