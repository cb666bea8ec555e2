// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// LINE: connects two sides through a delayed channel, by wave variables.
#pragma once

#include <array>

#include <repel/base/field.hpp>
#include <repel/network/elements/channel.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/elements/wave_account.hpp>

namespace repel::network {

/// The quantities sent over a line.
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
  /// [s] wait of the receiver beyond the channel delay, to have late packets in time and
  /// interpolate lost ones from the next; negative: the jitter plus the number of packets lost in a
  /// row with probability 1e-6, in ticks, clamped to 2 to 50
  double buffer = -1.0;

  /// Calls visit(Field, x) for each number but `buffer` and the seed.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Choice{"kind", {"waves", "force_velocity"}}, o.kind);
    visit(Field{"impedance", "N s/m", 1e-6, 1e6}, o.impedance);
    visit(Field{"angular_impedance", "N m s/rad", 1e-6, 1e6}, o.angular_impedance);
    visit(Field{"delay", "s", 0.0, 10.0}, o.channel.delay);
    visit(Field{"jitter", "s", 0.0, 10.0}, o.channel.jitter);
    visit(Field{"loss", "", 0.0, 1.0}, o.channel.loss);
  }
};

/// A two-port whose ends are one-ports of resistance Z. The wave a incident at one end leaves the
/// other with opposite sign when the channel delivers it: b = -a(t - delay). There is no
/// instantaneous path between the ends, so a line breaks a delay-free loop.
///
/// Waves cannot simply be output on arrival: holding one too long injects its energy twice,
/// dropping one loses its motion. Each packet carries the sum of all waves and of their energy so
/// far (after Niemeyer and Slotine 1998). The receiver outputs the wave sent a fixed time ago: the
/// channel delay plus a `buffer`. If that packet is missing, the sum in the next one received gives
/// the mean of the missing waves; its energy never exceeds theirs. Without a later packet the
/// output is zero, and the missing sum is made up later within the energy sent and not yet output.
/// So the energy out never exceeds the energy in, on any channel.
class Line {
 public:
  /// @throws SetupError for a number out of range
  explicit Line(const LineOptions& options = {});

  /// Sets the size of its port, and the impedance for that space.
  void fit(Space space, int size);
  /// Empties the channels. @param period [s] of the network. Allocates.
  void prepare(double period);

  /// Passive for waves only.
  [[nodiscard]] Traits traits() const noexcept;

  /// Receives what arrives in this tick.
  void read(const Signals& signals) noexcept;

  /// Equivalent of the end at `side`, as seen by the module connected there.
  void equivalent(Side side, Equivalent<any_size>& shown) const noexcept;

  /// Sends the state of the end at `side`, effort into the line.
  void incident(Side side, const PortState<any_size>& state) noexcept;

  /// Counts of the packets sent from `side`.
  [[nodiscard]] auto counts(Side side) const noexcept {
    return ends_[index(side)].outgoing.counts();
  }
  /// Energy in transit, or withheld for good [J].
  [[nodiscard]] double stored() const noexcept;

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

  void receive(End& end, const Channel<Packet>& incoming, bool at_rest) const noexcept;
  // Outputs one of `count` equal waves that together make up the missing sum.
  void play(End& end, const Packet& packet, double count) const noexcept;

  LineOptions options_;
  double period_ = 1.0;      // [s]
  std::int64_t buffer_ = 0;  // [ticks]
  LineImpedance impedance_;
  std::array<End, 2> ends_;  // left, right
};

}  // namespace repel::network
