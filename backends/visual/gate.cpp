// SPDX-License-Identifier: BSD-3-Clause
#include "gate.hpp"

namespace repel::visual {
namespace {

namespace ip = boost::asio::ip;

bool is_made_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

}  // namespace

ip::address plain(const ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return ip::make_address_v4(ip::v4_mapped, address.to_v6());
}

Gate::Gate(const std::string& address, std::uint16_t port, bool tls)
    : address_(plain(ip::make_address(address))), port_(port), tls_(tls) {}

bool Gate::is_host(std::string_view host) const {
  if (port_ == (tls_ ? 443 : 80) && is_name(host)) return true;
  std::string port(":");
  port += std::to_string(port_);
  return host.ends_with(port) && is_name(host.substr(0, host.size() - port.size()));
}

bool Gate::is_name(std::string_view name) const {
  boost::system::error_code error;
  if (is_made_of(name, "0123456789.")) {
    const auto v4 = ip::make_address_v4(std::string(name), error);
    return !error && address_.is_v4() && v4 == address_.to_v4();
  }
  if (name.starts_with('[') && name.ends_with(']')) {
    const std::string_view inside = name.substr(1, name.size() - 2);
    if (!is_made_of(inside, "0123456789abcdefABCDEF.:") || !address_.is_v6()) return false;
    // A browser never gives the zone index of a link-local address.
    const auto v6 = ip::make_address_v6(std::string(inside), error);
    return !error && v6.to_bytes() == address_.to_v6().to_bytes();
  }
  return name == "localhost" && address_.is_loopback();
}

bool Gate::is_origin(std::string_view origin, std::string_view host, bool tls) {
  const std::string_view scheme = tls ? "https://" : "http://";
  const auto without_port = [tls](std::string_view name) {
    const std::string_view port = tls ? ":443" : ":80";
    if (name.ends_with(port)) name.remove_suffix(port.size());
    return name;
  };
  return origin.starts_with(scheme) &&
         without_port(origin.substr(scheme.size())) == without_port(host);
}

}  // namespace repel::visual
