// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Outputs the waves of another machine, in time and without more energy than sent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <repel/network/elements/wave_account.hpp>
#include <repel/network/remote/packet.hpp>
#include <repel/network/remote/playout.hpp>

namespace repel::network {

/// The receiving half of a remote line. The account of the sender - the sum of its waves and their
/// energy - is a function of the sender's time, known at the packets and taken as linear between
/// them. In each tick the player outputs the mean wave over the elapsed time of the sender, by a
/// Playout: at any rates of both sides, and across lost packets. The mean has at most the energy of
/// the waves, so the output never exceeds the energy sent.
///
/// Without a newer packet the wave is zero. Waves missed then are output within some `catch_up`,
/// within their energy. After a silence they are dropped, so that old motion moves nobody.
///
/// The account in a packet must be possible: the sum of waves over a time within the bound by their
/// energy, and the energy within that of waves of `most_power`. Others are refused at arrival,
/// before entering any sum here.
class WavePlayer {
 public:
  static constexpr std::size_t kept = 256;  ///< packets
  static constexpr double catch_up = 0.1;   ///< [s]
  static constexpr double silence = 0.1;    ///< [s] without a packet; also by PlayoutOptions::most
  static constexpr double slack = 0.05;     ///< [s] by which the times of packets may be off
  static constexpr double late = 0.25;      ///< [s] by which packets may be late
  static constexpr double absurd = 100.0;   ///< times the most power: refused
  static constexpr double longest = 1e9;    ///< [s] of a session

  /// @param size of the port @param period [s] of the receiver
  WavePlayer() = default;
  /// For a port of `size`. @param period [s] of the network @throws SetupError for an option.
  WavePlayer(int size, double period, const PlayoutOptions& options = {});

  /// [W] Of the largest wave that a sound sender sends, squared.
  void set_most_power(double power) noexcept { most_power_ = power; }
  /// False for an impossible account.
  [[nodiscard]] bool is_credible(const RemotePacket& packet) const noexcept;
  /// The packet taken last told of larger waves than a sound sender sends.
  [[nodiscard]] bool is_beyond() const noexcept { return is_beyond_; }

  /// The packets that come now are of another session.
  void begin() noexcept;

  /// Takes a sound packet. False for a copy of an earlier one, one too old, or one contradicting
  /// earlier ones. @param now [s] by the clock of the receiver
  bool arrive(const RemotePacket& packet, double now) noexcept;

  /// The wave of this tick [sqrt(W)]. @param now [s] must grow @param at_rest outputs nothing and
  /// drops the waves due
  const Vec<any_size>& step(double now, bool at_rest) noexcept;

  /// [J] Output in this session; never more than the sender says it has sent.
  [[nodiscard]] double output() const noexcept { return output_; }
  /// [J] Sent and not output: in the buffer, or withheld for good.
  [[nodiscard]] double withheld() const noexcept;
  [[nodiscard]] double buffer() const noexcept { return playout_.buffer(); }  ///< [s]
  /// The newest packet; 0 before the first.
  [[nodiscard]] std::int64_t newest() const noexcept { return newest_; }

 private:
  struct Entry {
    std::int64_t sequence = 0;
    double sent = 0.0;  ///< [s] by the clock of the sender
    WaveAccount waves;
  };

  /// The waves between two accounts, `elapsed` [s] apart by the clock of the sender, are possible.
  [[nodiscard]] bool are_possible(double energy, double square, double all,
                                  double elapsed) const noexcept;
  [[nodiscard]] double square_between(const Entry& entry,
                                      const RemotePacket& packet) const noexcept;
  [[nodiscard]] bool follows(const Entry& last, const RemotePacket& packet,
                             double elapsed) const noexcept;
  [[nodiscard]] bool precedes(const RemotePacket& packet, double sent) const noexcept;
  /// Accounts for the energy sent in `elapsed` [s] of the sender's time; false for an absurd
  /// amount.
  [[nodiscard]] bool can_pay(double energy, double elapsed, double now) noexcept;

  [[nodiscard]] Entry& at(std::int64_t sequence) noexcept;
  [[nodiscard]] const Entry& at(std::int64_t sequence) const noexcept;

  /// The account of the sender at `moment`, as far as it is known: between the packets before and
  /// after it. Cost: a look at each packet after it, at most `kept`.
  [[nodiscard]] WaveAccount account(double moment) const noexcept;

  Playout playout_;
  double period_ = 1.0;       // [s]
  double most_power_ = 1e12;  // [W]
  double credit_ = 0.0;       // [J] that may still be sent
  bool is_beyond_ = false;
  std::array<Entry, kept> entries_;
  std::int64_t newest_ = 0, oldest_ = 0;
  double last_arrival_ = 0.0;  // [s]
  double moment_ = 0.0;        // [s] by the clock of the sender
  bool begins_anew_ = false;
  WaveAccount played_;   // of the account of the sender: output, or dropped
  double output_ = 0.0;  // [J]
  Vec<any_size> wave_;
};

}  // namespace repel::network
