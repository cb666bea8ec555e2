/// @file
/// Who may talk to the server.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <boost/asio/ip/address.hpp>

namespace repel::visual {

/// The names under which a browser reaches us over one connection: the very address at our end of
/// it, and localhost where that is of the loopback interface. A page of another site that has its
/// name point here (DNS rebinding) comes with its own.
class Gate {
 public:
  /// @param address in numbers, of our end of the connection; without brackets
  Gate(const std::string& address, std::uint16_t port);

  /// True for the `Host` of a request that was meant for this server. Browsers leave out port 80.
  [[nodiscard]] bool is_host(std::string_view host) const;
  /// True for the `Origin` of the page that is served under that `Host`, and for no other.
  [[nodiscard]] static bool is_origin(std::string_view origin, std::string_view host);

 private:
  [[nodiscard]] bool is_name(std::string_view name) const;

  boost::asio::ip::address address_;
  std::uint16_t port_;
};

/// The IPv4 address within an IPv6 one that stands for it; any other as it is.
[[nodiscard]] boost::asio::ip::address plain(const boost::asio::ip::address& address);

}  // namespace repel::visual
