// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/line.hpp>

#include <algorithm>
#include <cmath>

namespace repel::network {

Line::Line(const LineOptions& options) : options_(checked_fields(options)) {
  checked("buffer", options.buffer, -1.0, 10.0, "s");
  ChannelOptions back = options.channel;
  back.seed = ~back.seed;
  ends_[0].outgoing = Channel<Packet>(options.channel);
  ends_[1].outgoing = Channel<Packet>(back);
}

void Line::fit(Space space, int size) {
  impedance_ = LineImpedance(space, size, options_.impedance, options_.angular_impedance);
}

void Line::prepare(double period) {
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

Traits Line::traits() const noexcept {
  return {.passive = options_.kind == LineKind::waves};
}

void Line::read(const Signals& signals) noexcept {
  for (int i = 0; i < 2; ++i) {
    ends_[1 - i].outgoing.advance();
    receive(ends_[i], ends_[1 - i].outgoing, signals.at_rest);
  }
}

void Line::equivalent(Side side, Equivalent<any_size>& shown) const noexcept {
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

void Line::incident(Side side, const PortState<any_size>& state) noexcept {
  End& end = ends_[index(side)];
  end.sent.waves.add(impedance_.wave_of(state), period_);
  end.sent.effort = state.effort;
  end.sent.flow = state.flow;
  end.outgoing.send(end.sent);
}

double Line::stored() const noexcept {
  return ends_[0].sent.waves.energy - ends_[1].played.energy + ends_[1].sent.waves.energy -
         ends_[0].played.energy;
}

void Line::receive(End& end, const Channel<Packet>& incoming, bool at_rest) const noexcept {
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

void Line::play(End& end, const Packet& packet, double count) const noexcept {
  // Each wave may use only its share of the energy: with part of the sum still missing from an
  // earlier loss, the first would otherwise leave nothing for the others.
  const Vec<any_size> missing = (packet.waves.sum - end.played.sum) / count;
  const double allowed = std::max(0.0, packet.waves.energy - end.played.energy) / count;
  end.wave = end.played.draw(missing, allowed, period_);
}

}  // namespace repel::network
