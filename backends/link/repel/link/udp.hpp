// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A link over plain UDP.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <repel/link/datagrams.hpp>
#include <repel/link/transport.hpp>

namespace repel::link {

/// Where the site listens.
struct UdpOptions {
  Side side = Side::site;  ///< which side this is
  /// Of the site, as numbers: the site listens there, the station sends there and gets answers at
  /// its own source address. Unless the link is sealed, all who can reach it can drive the robot:
  /// see docs/two_machines.md
  std::string address = "127.0.0.1";
  std::uint16_t port = 7411;  ///< at which the site listens
  /// RemoteOptions::agreement: a station with another one is never answered. 0: any is
  std::uint64_t agreement = 0;
};

/// Whether only programs on this machine reach a site of that address.
/// @throws SetupError for an invalid address
[[nodiscard]] bool is_on_this_machine(const UdpOptions& options);

/// The site answers at the source address of the session named as heard in its packets. So
/// RemoteLink alone decides on the partner, and coming first holds no place. A session stays with
/// its address until it has been silent for 0.1 s. IPv4 and IPv6.
/// @throws SetupError for an address invalid or not available for listening
[[nodiscard]] std::unique_ptr<Transport> open_udp(const UdpOptions& options);

/// The same socket for datagrams that are to be sealed; of the options, `agreement` is not used.
/// @throws SetupError likewise
[[nodiscard]] std::unique_ptr<Datagrams> open_udp_datagrams(const UdpOptions& options);

}  // namespace repel::link
