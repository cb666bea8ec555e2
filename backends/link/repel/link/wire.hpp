// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Packets as bytes.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <repel/network/remote/packet.hpp>

namespace repel::link {

/// The words of a packet, in the order of its members, 8 bytes each, the least significant first;
/// before them the mark `repel` and the version. 720 bytes: fits a datagram of any network.
inline constexpr std::size_t wire_size = 8 + sizeof(network::RemotePacket);
using WireBytes = std::array<std::byte, wire_size>;  ///< a packet as it is sent

/// Writes a packet as bytes, the least significant of each number first.
void encode(const network::RemotePacket& packet, WireBytes& bytes) noexcept;
/// False for bytes of another length, mark or version; their numbers are not checked.
[[nodiscard]] bool decode(std::span<const std::byte> bytes, network::RemotePacket& packet) noexcept;

}  // namespace repel::link
