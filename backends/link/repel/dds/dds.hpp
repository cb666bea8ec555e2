// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A link over Eclipse Cyclone DDS.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <repel/link/datagrams.hpp>
#include <repel/link/transport.hpp>

namespace repel::dds {

/// Where the other side is.
struct DdsOptions {
  link::Side side = link::Side::site;  ///< which side this is
  /// Network interface for the search of the other side. Unless the link is sealed, others on it
  /// can drive the robot, and read its state. Whatever it is, Cyclone DDS listens on all of them:
  /// see docs/two_machines.md
  std::string interface = "lo";
  std::string peer;          ///< address of the other side, where multicast does not reach it
  std::uint32_t domain = 0;  ///< DDS domain, 0 to 230
};

/// Topics `repel/to_site` and `repel/to_station` of type repel_dds::RemotePacket
/// (remote_packet.idl), best effort, the last eight kept. Both sides find each other, in any order.
/// @throws SetupError for a missing interface, and options refused by DDS
[[nodiscard]] std::unique_ptr<link::Transport> open_dds(const DdsOptions& options);

/// Topics `repel/sealed/to_site` and `repel/sealed/to_station` of type repel_dds::SealedPacket,
/// best effort, the last 1024 kept, for datagrams that are sealed. @throws SetupError likewise
[[nodiscard]] std::unique_ptr<link::Datagrams> open_dds_datagrams(const DdsOptions& options);

}  // namespace repel::dds
