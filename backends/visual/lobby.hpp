// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Limits the number of connections that have not been answered yet.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include <boost/asio/ip/address.hpp>

namespace repel::visual {

/// The network of a client, to tell clients apart: an IPv4 address, or the upper half of an IPv6
/// address, whose lower half each client can choose.
[[nodiscard]] std::string network_of(const boost::asio::ip::address& address);

/// The place of a waiting connection. It is free again when the last reference to it is gone.
struct Seat {
  std::string from;             ///< see network_of
  bool idle = true;             ///< has sent no request, or no secret, yet
  std::function<void()> leave;  ///< closes the connection
};

/// Bounds the number of waiting connections, yet always admits a new one. If its network has too
/// many, the oldest idle connection of that network is closed; if there are too many in all, one of
/// the network with most connections. Without an idle one, the oldest.
class Lobby {
 public:
  /// @param most in total
  /// @param most_of_one from one network
  Lobby(std::size_t most, std::size_t most_of_one) : most_(most), most_of_one_(most_of_one) {}

  [[nodiscard]] std::shared_ptr<Seat> enter(const std::string& from);

 private:
  void send_away(const std::string& from);

  std::size_t most_, most_of_one_;
  std::deque<std::weak_ptr<Seat>> seats_;  ///< in the order of arrival
};

}  // namespace repel::visual
