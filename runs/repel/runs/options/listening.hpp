// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The network address of the live view, and the secret that guards it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <repel/runs/options/session_options.hpp>

namespace repel::runs {

struct Place {
  std::string address;  ///< numeric, without brackets
  std::uint16_t port = 0;
};

/// Parses ADDRESS:PORT, an IPv6 address in brackets; none if malformed.
[[nodiscard]] std::optional<Place> place_of(const std::string& listen);

/// Whether only programs on this machine can reach it.
[[nodiscard]] bool is_loopback(const Place& place);

/// What is wrong with ADDRESS:PORT; empty: nothing.
[[nodiscard]] std::string listen_complaint(const std::string& listen);

/// Reads the secret from the file or variable of the options. Returns a complaint about it, or the
/// absence of secret or TLS on an address reachable from other machines; empty: none.
[[nodiscard]] std::string settle_secret(SessionOptions& session);

/// What is wrong with the choice of a certificate; empty: nothing.
[[nodiscard]] std::string tls_complaint(const std::string& tls);

/// Prints on stderr the URL of the view, and what else is needed to open it.
/// @param url as seen from this machine
/// @param fingerprint of a certificate that no browser knows; empty: none
void announce(const SessionOptions& session, const std::string& url,
              const std::string& fingerprint);

}  // namespace repel::runs
