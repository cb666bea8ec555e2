// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// LINE: connects two sides through a delayed channel, by wave variables.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <repel/network/elements/channel.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/elements/wave_account.hpp>

namespace repel::network {

/// What is sent over a line.
enum class LineKind {
  waves,           ///< passive for any delay, jitter and loss
  force_velocity,  ///< velocity one way, force the other; not passive, for comparison
};

/// Properties of a line.
struct LineOptions {
  LineKind kind = LineKind::waves;  ///< what is sent
  double impedance = 20.0;          ///< Z [N s/m]
  double angular_impedance = 0.5;   ///< [N m s/rad]; of a tool port
  ChannelOptions channel;           ///< of both directions, with different seeds
  /// [s] that the receiver waits beyond the channel delay, so that late packets are in time and
  /// lost ones can be interpolated from the next; negative: the jitter plus as many ticks as
  /// packets are lost in a row with probability 1e-6, clamped to 2 to 50
  double buffer = -1.0;
};

/// A two-port whose ends are one-ports of resistance Z. The wave a incident at one end leaves the
/// other with opposite sign when the channel delivers it: b = -a(t - delay). There is no
/// instantaneous path between the ends, so a line breaks a delay-free loop.
///
/// Waves cannot simply be output on arrival: holding one too long injects its energy twice,
/// dropping one loses the motion it stands for. Each packet carries the sum of all waves and of
/// their energy so far (after Niemeyer and Slotine 1998). The receiver outputs the wave that was
/// sent a fixed time ago: the channel delay plus a `buffer`. If that packet is missing, the sum in
/// the next one received gives the mean of the missing waves, which never has more energy than they
/// had. If none is there, the output is zero, and the missing sum is made up later as far as the
/// energy sent and not yet output allows. So the energy out never exceeds the energy in, whatever
/// the channel does.
class Line {
 public:
  /// @throws SetupError for a number out of range
  explicit Line(const LineOptions& options = {}) : options_(options) {
    checked("impedance", options.impedance, 1e-6, 1e6, "N s/m");
    checked("angular impedance", options.angular_impedance, 1e-6, 1e6, "N m s/rad");
    checked("buffer", options.buffer, -1.0, 10.0, "s");
    ChannelOptions back = options.channel;
    back.seed = ~back.seed;
    ends_[0].outgoing = Channel<Packet>(options.channel);
    ends_[1].outgoing = Channel<Packet>(back);
  }

  /// Sets the size of its port, and the impedance for that space.
  void fit(Space space, int size) {
    impedance_ = LineImpedance(space, size, options_.impedance, options_.angular_impedance);
  }
  /// Empties the channels. @param period [s] of the network. Allocates.
  void prepare(double period) {
    period_ = detail::checked_period(period);
    Packet nothing;
    nothing.waves.clear(impedance_.size());
    nothing.effort = nothing.flow = nothing.waves.sum;
    const ChannelOptions& channel = options_.channel;
    const double bridged =
        channel.loss > 0.0 ? std::clamp(std::log(1e-6) / std::log(channel.loss), 2.0, 50.0) : 2.0;
    const double buffer =
        options_.buffer < 0.0 ? channel.jitter + std::ceil(bridged) * period : options_.buffer;
    buffer_ = std::llround(buffer / period);
    for (End& end : ends_) {
      end.outgoing.prepare(period, nothing, buffer_);
      end.sent = nothing;
      end.played = nothing.waves;
      end.wave = nothing.waves.sum;
    }
  }

  /// Passive for waves only.
  [[nodiscard]] Traits traits() const noexcept {
    return {.passive = options_.kind == LineKind::waves};
  }

  /// Receives what arrives in this tick.
  void read(const Signals& signals) noexcept {
    for (int i = 0; i < 2; ++i) {
      ends_[1 - i].outgoing.advance();
      receive(ends_[i], ends_[1 - i].outgoing, signals.at_rest);
    }
  }

  /// Equivalent of the end at `side`, as seen by the module connected there.
  void equivalent(Side side, Equivalent<any_size>& shown) const noexcept {
    const End& end = ends_[index(side)];
    if (options_.kind == LineKind::waves) {
      shown.form = Form::impedance;
      shown.matrix = impedance_.diagonal().asDiagonal();
      shown.offset = impedance_.offset_of(end.wave);
      return;
    }
    const Packet& arrived = ends_[1 - index(side)].outgoing.newest();
    shown.form = side == Side::left ? Form::impedance : Form::admittance;
    shown.matrix.setZero(impedance_.size(), impedance_.size());
    shown.offset = side == Side::left ? -arrived.effort : arrived.flow;
  }

  /// Sends the state of the end at `side`, effort into the line.
  void incident(Side side, const PortState<any_size>& state) noexcept {
    End& end = ends_[index(side)];
    end.sent.waves.add(impedance_.wave_of(state), period_);
    end.sent.effort = state.effort;
    end.sent.flow = state.flow;
    end.outgoing.send(end.sent);
  }

  /// Counts of the packets sent from `side`.
  [[nodiscard]] auto counts(Side side) const noexcept {
    return ends_[index(side)].outgoing.counts();
  }
  /// Energy in transit, or withheld for good [J].
  [[nodiscard]] double stored() const noexcept {
    return ends_[0].sent.waves.energy - ends_[1].played.energy + ends_[1].sent.waves.energy -
           ends_[0].played.energy;
  }

 private:
  // `waves` serve one kind of line, `effort` and `flow` the other.
  struct Packet {
    WaveAccount waves;
    Vec<any_size> effort, flow;
  };
  struct End {
    Channel<Packet> outgoing;
    Packet sent;         // the last packet sent
    WaveAccount played;  // output at this end so far
    Vec<any_size> wave;  // output at this end in this tick
  };

  static constexpr int index(Side side) noexcept { return side == Side::left ? 0 : 1; }

  void receive(End& end, const Channel<Packet>& incoming, bool at_rest) const noexcept {
    end.wave.setZero();
    if (at_rest) {
      end.played = incoming.newest().waves;
      return;
    }
    // The packet due for output, or the first after it that has arrived.
    const std::int64_t turn = incoming.tick() - incoming.delay() - buffer_;
    if (turn < 1) return;  // the first packet is sent in tick 1
    for (std::int64_t ahead = 0; ahead <= buffer_; ++ahead) {
      const Packet* packet = incoming.sent_at(turn + ahead);
      if (packet == nullptr) continue;
      play(end, *packet, static_cast<double>(ahead + 1));
      return;
    }
  }
  // Outputs one of `count` equal waves that together make up the missing sum.
  void play(End& end, const Packet& packet, double count) const noexcept {
    // Each wave may use only its share of the energy: with part of the sum still missing from an
    // earlier loss, the first would otherwise leave nothing for the others.
    const Vec<any_size> missing = (packet.waves.sum - end.played.sum) / count;
    const double allowed = std::max(0.0, packet.waves.energy - end.played.energy) / count;
    end.wave = end.played.draw(missing, allowed, period_);
  }

  LineOptions options_;
  double period_ = 1.0;      // [s]
  std::int64_t buffer_ = 0;  // [ticks]
  LineImpedance impedance_;
  std::array<End, 2> ends_;  // left, right
};

}  // namespace repel::network
