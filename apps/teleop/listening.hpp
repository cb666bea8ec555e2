/// @file
/// Where the live view listens, and what whoever opens it must know.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "session.hpp"

namespace repel::teleop {

struct Place {
  std::string address;  ///< in numbers, without brackets
  std::uint16_t port = 0;
};

/// Of ADDRESS:PORT, an address of IPv6 in brackets; none if that is not what it says.
[[nodiscard]] std::optional<Place> place_of(const std::string& listen);

/// Whether only programs of this machine reach it.
[[nodiscard]] bool is_loopback(const Place& place);

/// Says on stderr where the view is, and what one who opens it needs besides.
/// @param url on this machine
void announce(const SessionOptions& session, const std::string& url);

}  // namespace repel::teleop
