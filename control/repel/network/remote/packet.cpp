// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/packet.hpp>

#include <cstdint>

namespace repel::network {

bool is_sound(const RemotePacket& packet) noexcept {
  double all = packet.energy_sent - packet.energy_sent;
  all += packet.energy_played - packet.energy_played;
  for (const double x : packet.sum) all += x - x;
  for (const double x : packet.values) all += x - x;
  constexpr std::int64_t most = std::int64_t{1} << 52;  // a packet every microsecond for a century
  return all == 0.0 && packet.session != 0 && packet.sequence > 0 && packet.sequence < most &&
         packet.sent >= 0 && packet.heard_sent >= 0 && packet.heard_for >= 0 &&
         packet.energy_sent >= 0.0 && packet.energy_played >= 0.0;
}

}  // namespace repel::network
