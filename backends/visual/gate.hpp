// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checks the Host and Origin headers of requests.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <boost/asio/ip/address.hpp>

namespace repel::visual {

/// The host names of this server for a browser, over one connection: the local address of the
/// connection, and localhost for a loopback address. With DNS rebinding, a page of another site
/// sends its own name.
class Gate {
 public:
  /// @param address local address of the connection, numeric, without brackets
  /// @param tls whether it is sealed: its pages are https
  Gate(const std::string& address, std::uint16_t port, bool tls = false);

  /// Whether the `Host` of a request means this server. Browsers omit port 80,
  /// or 443 over TLS.
  [[nodiscard]] bool is_host(std::string_view host) const;
  /// Whether `Origin` is that of the page served under this `Host`.
  [[nodiscard]] static bool is_origin(std::string_view origin, std::string_view host,
                                      bool tls = false);

 private:
  [[nodiscard]] bool is_name(std::string_view name) const;

  boost::asio::ip::address address_;
  std::uint16_t port_;
  bool tls_;
};

/// Converts an IPv4-mapped IPv6 address to IPv4; returns any other unchanged.
[[nodiscard]] boost::asio::ip::address plain(const boost::asio::ip::address& address);

}  // namespace repel::visual
