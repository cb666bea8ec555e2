// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Carrier of bytes between the two sides of a link, for packets that are sealed.
#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include <repel/link/wire.hpp>

namespace repel::link {

/// Size of every datagram of a sealed link: a head of 48 bytes, a packet, a tag of 16 bytes.
inline constexpr std::size_t sealed_size = 48 + wire_size + 16;

/// Where a datagram came from; for the carrier alone. Empty where a carrier has no addresses.
struct Origin {
  sockaddr_storage address{};  ///< of a socket
  socklen_t size = 0;          ///< of the address

  /// Whether they are the same place.
  friend bool operator==(const Origin& a, const Origin& b) noexcept {
    return a.size == b.size && std::memcmp(&a.address, &b.address, a.size) == 0;
  }
};

/// Carries datagrams to the other side and back, from and to whoever can reach it; any may be
/// lost, doubled, overtaken or forged. For one thread, not that of the tick.
class Datagrams {
 public:
  Datagrams() = default;
  Datagrams(const Datagrams&) = delete;
  Datagrams& operator=(const Datagrams&) = delete;
  virtual ~Datagrams() = default;

  /// Sends without waiting. False when it could not be sent. @param to of a site: where to; a
  /// station knows its site
  virtual bool send(std::span<const std::byte, sealed_size> bytes, const Origin& to) noexcept = 0;
  /// Takes a datagram that has arrived, cut to the size of `bytes`. Returns its size; -1: none.
  [[nodiscard]] virtual std::ptrdiff_t receive(std::span<std::byte> bytes,
                                               Origin& from) noexcept = 0;
  /// Transport::wait.
  virtual void wait(std::chrono::microseconds longest) noexcept = 0;
  /// Transport::name.
  [[nodiscard]] virtual std::string name() const = 0;
};

}  // namespace repel::link
