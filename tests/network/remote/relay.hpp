// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A seeded path between two sides of a link, with delay, jitter, loss and copies.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <repel/network/remote/link.hpp>

#include "support/families.hpp"

namespace repel::test {

struct RelayPath {
  double delay = 0.02;  ///< [s]
  double jitter = 0.0;  ///< [s]
  double loss = 0.0;    ///< of each packet
  double copies = 0.0;  ///< share of packets that arrive twice
};

/// Carries the packets of one side to the other.
class Relay {
 public:
  explicit Relay(std::uint64_t seed) : rng_(seed) {}

  /// Takes what `from` has sent and gives `to` what arrives until `now` [s].
  void carry(network::RemoteLink& from, network::RemoteLink& to, const RelayPath& path,
             double now) {
    while (const network::RemotePacket* packet = from.outgoing().front()) {
      send(*packet, path, now);
      from.outgoing().pop();
    }
    for (std::size_t i = 0; i < on_the_way_.size();) {
      if (on_the_way_[i].arrives > now) {
        ++i;
        continue;
      }
      to.incoming().draft() = on_the_way_[i].packet;
      (void)to.incoming().post();
      on_the_way_.erase(on_the_way_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  void send(const network::RemotePacket& packet, const RelayPath& path, double now) {
    if (drawn() < path.loss) return;
    for (int copies = drawn() < path.copies ? 2 : 1; copies > 0; --copies) {
      on_the_way_.push_back({packet, now + path.delay + drawn() * path.jitter});
    }
  }
  /// Loses what is on the way.
  void cut() { on_the_way_.clear(); }

 private:
  struct Packet {
    network::RemotePacket packet;
    double arrives;  ///< [s]
  };

  double drawn() { return families::uniform(rng_, 0.0, 1.0); }

  families::Rng rng_;
  std::vector<Packet> on_the_way_;
};

[[nodiscard]] inline std::chrono::nanoseconds at(double seconds) {
  return std::chrono::nanoseconds(std::llround(1e9 * seconds));
}

}  // namespace repel::test
