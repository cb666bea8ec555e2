// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The packet of a remote line, sent in each tick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <repel/network/elements/port.hpp>

namespace repel::network {

/// A packet of one tick. Trivially copyable, of fixed size. Every packet has the totals since its
/// session began, so any may be lost, doubled or overtaken.
struct RemotePacket {
  static constexpr std::size_t most_values = 64;  ///< of what a side tells besides waves

  std::uint64_t session = 0;    ///< of the sender: drawn at random by each run, not 0
  std::uint64_t agreement = 0;  ///< what both sides must share: see RemoteOptions
  std::int64_t sequence = 0;    ///< 1, 2, ... in the session
  std::int64_t sent = 0;        ///< [ns] by the clock of the sender
  std::uint64_t heard = 0;      ///< session of the last packet that came from the other side
  std::int64_t heard_sent = 0;  ///< [ns] when that was sent, by the clock of the other side
  std::int64_t heard_for = 0;   ///< [ns] time since it came
  double energy_sent = 0.0;     ///< [J] of all waves of the session
  double energy_played = 0.0;   ///< [J] output by the sender, of the session `heard`
  std::array<double, most_joints> sum{};     ///< of all waves, times their period [sqrt(J s)]
  std::array<double, most_values> values{};  ///< of the program; not interpreted by the line
};

/// True when all numbers are finite and none has an impossible sign or size.
[[nodiscard]] bool is_sound(const RemotePacket& packet) noexcept;

}  // namespace repel::network
