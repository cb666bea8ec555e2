#include "gate.hpp"

namespace repel::visual {
namespace {

bool is_made_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

/// An address of IPv4, or one of IPv6 in brackets: no name that somebody could own.
bool is_numeric(std::string_view name) {
  if (is_made_of(name, "0123456789.")) return true;
  return name.starts_with('[') && name.ends_with(']') &&
         is_made_of(name.substr(1, name.size() - 2), "0123456789abcdefABCDEF.:");
}

}  // namespace

Gate::Gate(const std::string& address, std::uint16_t port)
    : any_(address == "0.0.0.0" || address == "::"),
      port_(":"),
      address_(address.find(':') == std::string::npos ? address : "[") {
  port_ += std::to_string(port);
  if (address_ == "[") {
    address_ += address;
    address_ += ']';
  }
}

bool Gate::is_host(std::string_view host) const {
  if (host.size() <= port_.size() || !host.ends_with(port_)) return false;
  const std::string_view name = host.substr(0, host.size() - port_.size());
  if (name == address_ || (any_ && is_numeric(name))) return true;
  const bool loopback = any_ || address_ == "[::1]" || address_.starts_with("127.");
  return loopback && name == "localhost";
}

bool Gate::is_origin(std::string_view origin) const {
  constexpr std::string_view scheme = "http://";
  return origin.empty() || (origin.starts_with(scheme) && is_host(origin.substr(scheme.size())));
}

}  // namespace repel::visual
