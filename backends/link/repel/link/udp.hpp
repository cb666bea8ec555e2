// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A link over plain UDP.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <repel/link/transport.hpp>

namespace repel::link {

/// Where the site listens.
struct UdpOptions {
  Side side = Side::site;  ///< which side this is
  /// Of the site, as numbers: the site listens there, the station sends there and is answered where
  /// it sent from. Who can reach it can drive the robot: see docs/two_machines.md
  std::string address = "127.0.0.1";
  std::uint16_t port = 7411;  ///< at which the site listens
  /// RemoteOptions::agreement: a station with another one is never answered. 0: any is
  std::uint64_t agreement = 0;
};

/// The site answers the station whose session its packets say it has heard, where that one sent
/// from: who is the partner is decided by RemoteLink alone, and nobody keeps its place by coming
/// first. A session stays with its address until it has been silent for 0.1 s. IPv4 and IPv6.
/// @throws SetupError for an address that is none, or that cannot be listened on
[[nodiscard]] std::unique_ptr<Transport> open_udp(const UdpOptions& options);

}  // namespace repel::link
