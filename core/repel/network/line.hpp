/// @file
/// LINE: joins two sides over a channel with delay, by wave variables.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <repel/network/channel.hpp>
#include <repel/network/equivalent.hpp>
#include <repel/network/signals.hpp>

namespace repel::network {

/// What is sent over a line.
enum class LineKind {
  waves,           ///< passive for any delay, jitter and loss
  force_velocity,  ///< velocity one way, force the other: the plain line, to compare with
};

struct LineOptions {
  LineKind kind = LineKind::waves;
  double impedance = 20.0;         ///< Z [N s/m]
  double angular_impedance = 0.5;  ///< [N m s/rad]; of a tool port
  ChannelOptions channel;          ///< of both directions; the seeds differ
  /// [s] that the receiver waits beyond the delay of the channel, so that late packets are in time
  /// and lost ones can be bridged from the next; less than zero: the jitter and as many ticks as
  /// are lost in a row once in a million, two to fifty
  double buffer = -1.0;
};

/// A two-port whose ends are one-ports of resistance Z. The wave a that goes in at one end comes
/// out at the other, turned round, when the channel delivers it: b = -a(t - delay). Between them
/// there is no instantaneous path, so a line cuts a delay-free loop.
///
/// Waves cannot simply be played as they come: one that is held too long gives energy twice, one
/// that is left out takes the motion it stood for away. Each packet carries the sum of all waves
/// and the energy of all waves so far (after Niemeyer and Slotine 1998). The receiver plays what
/// was sent a fixed time ago: the delay of the channel and a `buffer`. Of a packet that is missing
/// then, the next one that is there tells what it must have held together with those between; their
/// mean never takes more energy than they had. Where nothing is there, nothing is played, and what
/// is missing in the sum is made good later, as far as energy sent and not yet played allows. So
/// what comes out never exceeds what went in, whatever the channel does.
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

  /// Takes the size of the port it stands at.
  void fit(Space space, int size) {
    impedance_.setConstant(size, options_.impedance);
    if (space == Space::tool) impedance_.tail<3>().setConstant(options_.angular_impedance);
    to_wave_ = (0.5 * impedance_.cwiseSqrt().cwiseInverse());
  }
  void prepare(double period) {
    period_ = detail::checked_period(period);
    Packet nothing;
    nothing.sum.setZero(impedance_.size());
    nothing.effort = nothing.flow = nothing.sum;
    const ChannelOptions& channel = options_.channel;
    const double bridged =
        channel.loss > 0.0 ? std::clamp(std::log(1e-6) / std::log(channel.loss), 2.0, 50.0) : 2.0;
    const double buffer =
        options_.buffer < 0.0 ? channel.jitter + std::ceil(bridged) * period : options_.buffer;
    buffer_ = std::llround(buffer / period);
    for (End& end : ends_) {
      end.outgoing.prepare(period, nothing, buffer_);
      end.sent = nothing;
      end.played = nothing;
      end.wave = nothing.sum;
    }
  }

  [[nodiscard]] Traits traits() const noexcept {
    return {.passive = options_.kind == LineKind::waves};
  }

  void read(const Signals& signals) noexcept {
    for (int i = 0; i < 2; ++i) {
      ends_[1 - i].outgoing.advance();
      receive(ends_[i], ends_[1 - i].outgoing, signals.at_rest);
    }
  }

  /// What the end at `side` shows to what is connected there.
  void equivalent(Side side, Equivalent<any_size>& shown) const noexcept {
    const End& end = ends_[index(side)];
    if (options_.kind == LineKind::waves) {
      shown.form = Form::impedance;
      shown.matrix = impedance_.asDiagonal();
      // b = -(2 sqrt(Z) u): the wave of the other end, turned round.
      shown.offset = -2.0 * impedance_.cwiseSqrt().cwiseProduct(end.wave);
      return;
    }
    const Packet& arrived = ends_[1 - index(side)].outgoing.newest();
    shown.form = side == Side::left ? Form::impedance : Form::admittance;
    shown.matrix.setZero(impedance_.size(), impedance_.size());
    shown.offset = side == Side::left ? Vec<any_size>(-arrived.effort) : arrived.flow;
  }

  /// The state of that end, effort into the line. It goes on its way.
  void incident(Side side, const PortState<any_size>& state) noexcept {
    End& end = ends_[index(side)];
    const Vec<any_size> wave =
        to_wave_.cwiseProduct(state.effort + impedance_.cwiseProduct(state.flow));
    end.sent.sum += period_ * wave;
    end.sent.energy += period_ * wave.squaredNorm();
    end.sent.effort = state.effort;
    end.sent.flow = state.flow;
    end.outgoing.send(end.sent);
  }

  /// Packets that set out at that side.
  [[nodiscard]] auto counts(Side side) const noexcept {
    return ends_[index(side)].outgoing.counts();
  }
  /// Under way, or held back for good [J].
  [[nodiscard]] double stored() const noexcept {
    return ends_[0].sent.energy - ends_[1].played.energy + ends_[1].sent.energy -
           ends_[0].played.energy;
  }

 private:
  // Waves are a / (2 sqrt(Z)), so that their square is a power. All four are of size 6 or less in
  // use; two of them serve one kind of line each.
  struct Packet {
    Vec<any_size> sum;           // of all waves, times T [sqrt(J s)]
    double energy = 0.0;         // of all waves [J]
    Vec<any_size> effort, flow;  // for the plain line
  };
  struct End {
    Channel<Packet> outgoing;
    Packet sent;         // the newest
    Packet played;       // what has come out here
    Vec<any_size> wave;  // that comes out here in this tick
  };

  static constexpr int index(Side side) noexcept { return side == Side::left ? 0 : 1; }

  void receive(End& end, const Channel<Packet>& incoming, bool at_rest) const noexcept {
    end.wave.setZero();
    if (at_rest) {
      end.played = incoming.newest();
      return;
    }
    // The packet whose turn it is, or the first after it that is there.
    const std::int64_t turn = incoming.tick() - incoming.delay() - buffer_;
    if (turn < 1) return;  // the first packet sets out in tick 1
    for (std::int64_t ahead = 0; ahead <= buffer_; ++ahead) {
      const Packet* packet = incoming.sent_at(turn + ahead);
      if (packet == nullptr) continue;
      play(end, *packet, static_cast<double>(ahead + 1));
      return;
    }
  }
  // One of `count` equal waves that together make up what is missing in the sum.
  void play(End& end, const Packet& packet, double count) const noexcept {
    end.wave = (packet.sum - end.played.sum) / (count * period_);
    const double wanted = period_ * end.wave.squaredNorm();
    // Each may take its share and no more: else, with something still missing from an earlier loss,
    // the first would leave nothing for the others.
    const double allowed = std::max(0.0, packet.energy - end.played.energy) / count;
    if (wanted > allowed) end.wave *= std::sqrt(allowed / wanted);
    end.played.sum += period_ * end.wave;
    end.played.energy += std::min(wanted, allowed);
  }

  LineOptions options_;
  double period_ = 1.0;                // [s]
  std::int64_t buffer_ = 0;            // [ticks]
  Vec<any_size> impedance_, to_wave_;  // diagonals
  std::array<End, 2> ends_;            // left, right
};

}  // namespace repel::network
