// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated channel with delay, jitter, packet loss and reordering.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::network {

/// Properties of a channel. A number out of range is a SetupError of the channel.
struct ChannelOptions {
  double delay = 0.0;      ///< [s] of every packet, 0 to 10; at least one tick
  double jitter = 0.0;     ///< [s] greatest additional delay, uniformly distributed
  double loss = 0.0;       ///< probability that a packet is lost, 0 to 1
  std::uint64_t seed = 1;  ///< the same seed gives the same channel
};

/// Carries one packet per tick. Arrived packets are looked up by the tick of their sending;
/// `newest` is the one sent last. Deterministic; only `prepare` allocates.
template <class Payload>
class Channel {
 public:
  /// Packet counts since construction.
  struct Counts {
    std::int64_t sent = 0;       ///< packets handed over
    std::int64_t lost = 0;       ///< of them, that will never arrive
    std::int64_t overtaken = 0;  ///< arrived with or after a newer one
  };

  /// @throws SetupError for a number out of range
  explicit Channel(const ChannelOptions& options = {}) : options_(options), state_(options.seed) {
    checked("delay", options.delay, 0.0, 10.0, "s");
    checked("jitter", options.jitter, 0.0, 10.0, "s");
    checked("loss", options.loss, 0.0, 1.0, "");
  }

  /// @param period [s]; `nothing` is returned by `newest` before the first packet arrives; packets
  /// are kept for `kept` ticks after the latest possible arrival
  void prepare(double period, const Payload& nothing, std::int64_t kept = 0) {
    delay_ = std::max<std::int64_t>(1, std::llround(options_.delay / period));
    jitter_ = std::llround(options_.jitter / period);
    newest_ = {nothing, -1, 0};
    packets_.assign(static_cast<std::size_t>(delay_ + jitter_ + kept) + 2, newest_);
    tick_ = 0;
  }

  /// Sends the packet of this tick.
  void send(const Payload& payload) noexcept {
    ++counts_.sent;
    const auto late = static_cast<std::int64_t>(uniform() * static_cast<double>(jitter_ + 1));
    const bool lost = uniform() < options_.loss;
    counts_.lost += lost ? 1 : 0;
    packet(tick_) = {payload, lost ? -1 : tick_, tick_ + delay_ + std::min(late, jitter_)};
  }

  /// Advances by one tick.
  void advance() noexcept {
    ++tick_;
    // Packets that can arrive in this tick, the last one sent first.
    const std::int64_t oldest = std::max<std::int64_t>(0, tick_ - delay_ - jitter_);
    for (std::int64_t sent = tick_ - delay_; sent >= oldest; --sent) {
      const Packet& arriving = packet(sent);
      if (arriving.sent != sent || arriving.arrives != tick_) continue;
      if (sent > newest_.sent) {
        newest_ = arriving;
      } else {
        ++counts_.overtaken;
      }
    }
  }

  /// The packet sent in `tick`; null if it was lost, has not arrived or is no longer kept.
  [[nodiscard]] const Payload* sent_at(std::int64_t tick) const noexcept {
    if (tick < 0) return nullptr;
    const Packet& packet = packets_[static_cast<std::size_t>(tick) % packets_.size()];
    return packet.sent == tick && packet.arrives <= tick_ ? &packet.payload : nullptr;
  }
  /// The packet sent last of those that have arrived.
  [[nodiscard]] const Payload& newest() const noexcept { return newest_.payload; }
  /// Ticks since `prepare`.
  [[nodiscard]] std::int64_t tick() const noexcept { return tick_; }
  /// Age of `newest` [ticks].
  [[nodiscard]] std::int64_t age() const noexcept { return tick_ - newest_.sent; }
  [[nodiscard]] std::int64_t delay() const noexcept { return delay_; }    ///< [ticks]
  [[nodiscard]] std::int64_t jitter() const noexcept { return jitter_; }  ///< [ticks]
  /// Packet counts since construction.
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  struct Packet {
    Payload payload;
    std::int64_t sent = -1;    // tick; -1: none, or lost
    std::int64_t arrives = 0;  // tick
  };

  Packet& packet(std::int64_t tick) noexcept {
    return packets_[static_cast<std::size_t>(tick) % packets_.size()];
  }
  // Uniform in [0, 1): SplitMix64 (Steele, Lea and Flood 2014).
  double uniform() noexcept {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  }

  ChannelOptions options_;
  std::uint64_t state_;
  std::int64_t delay_ = 1, jitter_ = 0;  // [ticks]
  std::vector<Packet> packets_;          // by the tick in which they were sent
  Packet newest_;
  std::int64_t tick_ = 0;
  Counts counts_;
};

}  // namespace repel::network
