// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Outputs the waves that another machine sent, in time and never more energy than was sent.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <repel/network/elements/wave_account.hpp>
#include <repel/network/remote/packet.hpp>
#include <repel/network/remote/playout.hpp>

namespace repel::network {

/// The receiving half of a remote line. The account of the sender - the sum of its waves and their
/// energy - is a function of the sender's time, known at the packets and taken as linear between
/// them. In each tick the player outputs the mean wave of the time that has passed for the sender,
/// by a Playout: whatever the rates of both sides, and across packets that are lost. The mean has
/// at most the energy of the waves, and what is output never exceeds what was sent.
///
/// Where nothing newer has arrived the wave is zero. What was missed then is output within some
/// `catch_up`, as far as its energy goes; after a silence it is dropped, so that nobody is moved by
/// what happened long ago.
///
/// What a packet says must be possible: the sum of waves over a time has no more than their energy
/// allows, and no more energy comes than waves of `most_power` have. What cannot be is refused at
/// arrival, before it is in any sum here.
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
  WavePlayer(int size, double period, const PlayoutOptions& options = {})
      : playout_(period, options), period_(period) {
    for (Entry& entry : entries_) entry.waves.clear(size);
    played_.clear(size);
    wave_ = played_.sum;
  }

  /// [W] Of the largest wave that a sound sender sends, squared.
  void set_most_power(double power) noexcept { most_power_ = power; }
  /// False for accounts that no session can have.
  [[nodiscard]] bool is_credible(const RemotePacket& packet) const noexcept {
    if (!(packet.energy_sent <= longest * most_power_)) return false;
    const double most = longest * std::sqrt(most_power_);
    return std::all_of(packet.sum.begin(), packet.sum.end(),
                       [&](double x) { return std::abs(x) <= most; });
  }
  /// The packet taken last told of larger waves than a sound sender sends.
  [[nodiscard]] bool is_beyond() const noexcept { return is_beyond_; }

  /// The packets that come now are of another session.
  void begin() noexcept {
    for (Entry& entry : entries_) entry.sequence = 0;
    newest_ = 0;
    output_ = 0.0;
    credit_ = 0.0;
    is_beyond_ = false;
  }

  /// Takes a packet that is sound. False when it is a copy of one before, too old, or contradicts
  /// what the sender said before. @param now [s] by the clock of the receiver
  bool arrive(const RemotePacket& packet, double now) noexcept {
    const double sent = 1e-9 * static_cast<double>(packet.sent);
    const bool anew = newest_ == 0 || now - last_arrival_ > silence;
    if (!is_credible(packet)) return false;
    if (packet.sequence > newest_) {
      const double before = anew ? sent : at(newest_).sent;
      if (!anew && !follows(at(newest_), packet, sent - before)) return false;
      if (!anew && !can_pay(packet.energy_sent - at(newest_).waves.energy, sent - before, now)) {
        return false;
      }
      if (anew) playout_.begin();
      playout_.arrive(sent, before, now);
      newest_ = packet.sequence;
      last_arrival_ = now;
    } else if (newest_ - packet.sequence >= static_cast<std::int64_t>(kept) ||
               at(packet.sequence).sequence == packet.sequence || !precedes(packet, sent)) {
      return false;
    }
    Entry& entry = at(packet.sequence);
    entry.sequence = packet.sequence;
    entry.sent = sent;
    entry.waves.energy = packet.energy_sent;
    for (Eigen::Index i = 0; i < entry.waves.sum.size(); ++i) {
      entry.waves.sum.coeffRef(i) = packet.sum[static_cast<std::size_t>(i)];
    }
    if (anew) {
      oldest_ = packet.sequence;
      begins_anew_ = true;
    }
    return true;
  }

  /// The wave of this tick [sqrt(W)]. @param now [s] must grow @param at_rest outputs nothing and
  /// drops what is due
  const Vec<any_size>& step(double now, bool at_rest) noexcept {
    wave_.setZero();
    if (newest_ == 0) return wave_;
    const double before = moment_;
    moment_ = playout_.advance(now);
    const WaveAccount due = account(moment_);
    if (begins_anew_ || at_rest) {
      played_ = due;
      begins_anew_ = false;
      return wave_;
    }
    // Both by what is known now: what a packet tells that came too late for it is missing, and is
    // made up for slowly.
    const WaveAccount last = account(before);
    const double share = std::min(1.0, period_ / catch_up);
    const Vec<any_size> wanted = due.sum - last.sum + share * (last.sum - played_.sum);
    const double spent = played_.energy;
    wave_ = played_.draw(wanted, due.energy - spent, period_);
    output_ += played_.energy - spent;
    return wave_;
  }

  /// [J] Output in this session; never more than the sender says it has sent.
  [[nodiscard]] double output() const noexcept { return output_; }
  /// [J] Sent and not output: in the buffer, or withheld for good.
  [[nodiscard]] double withheld() const noexcept {
    return newest_ == 0 ? 0.0 : at(newest_).waves.energy - output_;
  }
  [[nodiscard]] double buffer() const noexcept { return playout_.buffer(); }  ///< [s]
  /// The newest packet; 0 before the first.
  [[nodiscard]] std::int64_t newest() const noexcept { return newest_; }
  /// [s] when it came.
  [[nodiscard]] double last_arrival() const noexcept { return last_arrival_; }

 private:
  struct Entry {
    std::int64_t sequence = 0;
    double sent = 0.0;  ///< [s] by the clock of the sender
    WaveAccount waves;
  };

  /// The waves between two accounts, `elapsed` [s] apart by the clock of the sender, are possible.
  [[nodiscard]] bool are_possible(double energy, double square, double all,
                                  double elapsed) const noexcept {
    constexpr double rounding = 1e-11;  // of all that was sent so far, in many ticks
    return elapsed > 0.0 && energy >= 0.0 &&
           square <= (energy + rounding * all) * (elapsed + slack) * (1.0 + 1e-6);
  }
  [[nodiscard]] double square_between(const Entry& entry,
                                      const RemotePacket& packet) const noexcept {
    double square = 0.0;
    for (Eigen::Index i = 0; i < entry.waves.sum.size(); ++i) {
      const double off = packet.sum[static_cast<std::size_t>(i)] - entry.waves.sum.coeff(i);
      square += off * off;
    }
    return square;
  }
  [[nodiscard]] bool follows(const Entry& last, const RemotePacket& packet,
                             double elapsed) const noexcept {
    return are_possible(packet.energy_sent - last.waves.energy, square_between(last, packet),
                        packet.energy_sent, elapsed);
  }
  [[nodiscard]] bool precedes(const RemotePacket& packet, double sent) const noexcept {
    const Entry& last = at(newest_);
    return are_possible(last.waves.energy - packet.energy_sent, square_between(last, packet),
                        last.waves.energy, last.sent - sent);
  }
  /// Notes what a sound sender may have sent in `elapsed` [s] of its time; false for what is
  /// absurd.
  [[nodiscard]] bool can_pay(double energy, double elapsed, double now) noexcept {
    const double time = std::min(elapsed, now - last_arrival_ + late);
    if (energy > absurd * most_power_ * (time + slack)) return false;
    credit_ = std::min(credit_ + 1.01 * most_power_ * time, most_power_ * slack) - energy;
    is_beyond_ = credit_ < -most_power_ * slack;
    credit_ = std::max(credit_, -most_power_ * slack);
    return true;
  }

  [[nodiscard]] Entry& at(std::int64_t sequence) noexcept {
    return entries_[static_cast<std::size_t>(sequence) % kept];
  }
  [[nodiscard]] const Entry& at(std::int64_t sequence) const noexcept {
    return entries_[static_cast<std::size_t>(sequence) % kept];
  }

  /// The account of the sender at `moment`, as far as it is known: between the packets before and
  /// after it. Cost: a look at each packet after it, at most `kept`.
  [[nodiscard]] WaveAccount account(double moment) const noexcept {
    const Entry* after = nullptr;
    const std::int64_t first = std::max(oldest_, newest_ - static_cast<std::int64_t>(kept) + 1);
    for (std::int64_t i = newest_; i >= first; --i) {
      const Entry& entry = at(i);
      if (entry.sequence != i) continue;
      if (entry.sent > moment) {
        after = &entry;
        continue;
      }
      if (after == nullptr) return entry.waves;
      const double share = (moment - entry.sent) / (after->sent - entry.sent);
      WaveAccount between = entry.waves;
      between.energy += share * (after->waves.energy - between.energy);
      between.sum += share * (after->waves.sum - between.sum);
      return between;
    }
    return after->waves;
  }

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
