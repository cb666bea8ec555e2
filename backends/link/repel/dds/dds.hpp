// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A link over Eclipse Cyclone DDS.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <repel/link/transport.hpp>

namespace repel::dds {

/// Where the other side is.
struct DdsOptions {
  link::Side side = link::Side::site;  ///< which side this is
  /// Network interface on which the other side is searched. Who can reach it can drive the robot,
  /// and read what it does: see docs/two_machines.md
  std::string interface = "lo";
  std::string peer;          ///< address of the other side, where multicast does not reach it
  std::uint32_t domain = 0;  ///< DDS domain, 0 to 230
};

/// Topics `repel/to_site` and `repel/to_station` of type repel_dds::RemotePacket
/// (remote_packet.idl), best effort, the last eight kept. Both sides find each other, in any order.
/// @throws SetupError for an interface that this machine has not, and what DDS refuses
[[nodiscard]] std::unique_ptr<link::Transport> open_dds(const DdsOptions& options);

}  // namespace repel::dds
