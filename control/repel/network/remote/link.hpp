// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One side of a link between two machines, as a tick sees it.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include <repel/base/ring.hpp>
#include <repel/network/remote/packet.hpp>
#include <repel/network/remote/wave_player.hpp>

namespace repel::network {

/// What both sides of a link agree on.
struct RemoteOptions {
  std::uint64_t session = 1;  ///< of this run, drawn at random, not 0
  /// What both sides must share, such as a hash of the scene and the impedance of the line: packets
  /// with another one are not listened to
  std::uint64_t agreement = 0;
  PlayoutOptions playout{};  ///< when waves are output
};

/// Counts of the packets over a link since the run began.
struct RemoteCounts {
  std::int64_t sent = 0;         ///< packets handed to the thread
  std::int64_t received = 0;     ///< packets taken from it
  std::int64_t overtaken = 0;    ///< of those received: arrived after a newer one
  std::int64_t lost = 0;         ///< of the sessions heard: never arrived, or not yet
  std::int64_t doubled = 0;      ///< copies of others, or too late to be told from one
  std::int64_t refused = 0;      ///< not sound, or of a side that contradicts itself
  std::int64_t strangers = 0;    ///< of another agreement, or of a second partner
  std::int64_t sessions = 0;     ///< of the other side: 1, and one more for each restart
  std::int64_t beyond = 0;       ///< of those received: told of larger waves than the bounds allow
  std::int64_t cut = 0;          ///< ticks in which a wave was cut to the bounds
  std::int64_t closed = 0;       ///< partners closed for unsound packets or waves beyond the bounds
  double longest_silence = 0.0;  ///< [s] between two packets of one session
};

/// One side of a link: the queues between the tick and the thread of the link. The tick never waits
/// for that thread, nor for the other side. In each tick: `receive`, then the network, whose
/// RemoteLine sends. The memory is allocated at construction.
class RemoteLink {
 public:
  static constexpr std::size_t room = 64;  ///< packets between two visits of the thread
  /// A partner is closed after so many packets beyond the bounds or unsound, less a quarter of its
  /// others: 0.1 s at 400 Hz. Its session is not met again.
  static constexpr double patience = 40.0;

  /// @throws SetupError for a number out of range
  explicit RemoteLink(const RemoteOptions& options);

  /// For the thread of input and output: the producer of one, the consumer of the other.
  [[nodiscard]] Ring<RemotePacket>& incoming() noexcept { return incoming_; }
  [[nodiscard]] Ring<RemotePacket>& outgoing() noexcept { return outgoing_; }  ///< likewise

  /// Set-up: by RemoteLine, for its port. @param period [s]
  void prepare(int size, double period);
  /// [W] Of the largest wave that a sound side sends, squared: by RemoteLine.
  void set_most_power(double power) noexcept { player_.set_most_power(power); }
  /// In this tick a wave was cut: by RemoteLine.
  void count_cut() noexcept { ++counts_.cut; }

  /// First in a tick: takes all that has arrived. @param now [ns] must grow
  void receive(std::chrono::nanoseconds now) noexcept;
  /// The wave that comes out in this tick [sqrt(W)].
  const Vec<any_size>& play(bool at_rest) noexcept { return player_.step(seconds(now_), at_rest); }
  /// Sends the wave of this tick, and the values set before; nothing before the first `receive`.
  /// @param wave [sqrt(W)] @param period [s]
  void send(const Vec<any_size>& wave, double period) noexcept;

  /// Of the program, sent with the packets from now on. All must be finite.
  [[nodiscard]] std::span<double, RemotePacket::most_values> values() noexcept { return values_; }
  /// Of the other side, as of the newest packet.
  [[nodiscard]] std::span<const double, RemotePacket::most_values> heard() const noexcept;
  /// True once the other side has been heard.
  [[nodiscard]] bool is_linked() const noexcept { return partner_ != 0; }
  /// [s] since the newest packet came; before any, since the first `receive`, or since the partner
  /// was closed.
  [[nodiscard]] double silent_for() const noexcept;

  /// Counts since the run began.
  [[nodiscard]] const RemoteCounts& counts() const noexcept { return counts_; }
  /// Outputs the waves that arrive.
  [[nodiscard]] const WavePlayer& player() const noexcept { return player_; }
  /// [J] Of all waves sent.
  [[nodiscard]] double energy_sent() const noexcept { return sent_.energy; }
  /// [J] Energy reported by the other side for this session; 0 before it has heard of it.
  [[nodiscard]] double partner_sent() const noexcept { return partner_sent_; }
  /// [J] likewise: output of this side's waves.
  [[nodiscard]] double partner_played() const noexcept { return partner_played_; }
  /// Round trips by the packets of this tick, without the time at the other side; valid until the
  /// next `receive`.
  [[nodiscard]] std::span<const std::chrono::nanoseconds> round_trips() const noexcept;

 private:
  [[nodiscard]] static double seconds(std::chrono::nanoseconds t) noexcept;

  void take(const RemotePacket& packet) noexcept;

  /// A partner is another program only once the one before has been silent.
  bool meet(const RemotePacket& packet) noexcept;

  /// Counts a packet of the partner beyond the bounds or unsound. True if it is closed for that:
  /// the place is free, and this session is not met again.
  bool distrust() noexcept;

  void hear(const RemotePacket& packet) noexcept;

  RemoteOptions options_;
  Ring<RemotePacket> incoming_, outgoing_;
  WavePlayer player_;
  WaveAccount sent_;
  int size_ = 0;
  std::array<double, RemotePacket::most_values> values_{}, heard_values_{};
  std::chrono::nanoseconds now_{0};
  std::int64_t began_ = -1;                 // [ns]
  std::uint64_t partner_ = 0, former_ = 0;  // sessions
  std::array<std::uint64_t, 16> closed_{};  // the last ones
  double distrust_ = 0.0;
  std::int64_t heard_at_ = 0;                         // [ns]
  std::int64_t heard_sent_ = 0;                       // [ns] by the clock of the other side
  double partner_sent_ = 0.0, partner_played_ = 0.0;  // [J]
  RemoteCounts counts_;
  std::array<std::chrono::nanoseconds, room> round_trips_{};  // the first ones, `told_`
  std::size_t told_ = 0;
};

}  // namespace repel::network
