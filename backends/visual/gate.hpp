/// @file
/// Who may talk to the server.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace repel::visual {

/// The names under which a browser on this machine, or one that was told the address, reaches us. A
/// page of another site that has its name point here (DNS rebinding) comes with its own.
class Gate {
 public:
  Gate(const std::string& address, std::uint16_t port);

  /// True for the `Host` of a request that was meant for this server.
  [[nodiscard]] bool is_host(std::string_view host) const;
  /// True for the `Origin` of a page of this server, and for none: programs that are no browsers
  /// have none, and they could claim any.
  [[nodiscard]] bool is_origin(std::string_view origin) const;

 private:
  bool any_;  ///< listens on every interface: whatever name it is called by must be in numbers
  std::string port_;
  std::string address_;
};

}  // namespace repel::visual
