// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary packets of a false partner, between sound ones: what comes out of the line stays finite
// and within its bounds, the accounts stay finite, and a sound partner is heard afterwards.
#include <repel/link/wire.hpp>
#include <repel/network/remote/remote_line.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>

#include <fuzz/bytes.hpp>

namespace repel::network {
namespace {

using fuzz::Bytes;
using fuzz::require;

constexpr std::uint64_t agreement = 5;
constexpr std::uint64_t sound_session = 0x736f756e64;
constexpr double period = 0.0025;
constexpr LineBounds bounds{.speed = 0.25, .turning = 1.0, .force = 40.0, .torque = 2.0};

/// One end of a line, before a robot that is a damper.
struct End {
  RemoteLink link{{.session = 1, .agreement = agreement}};
  RemoteLine line{link, {.impedance = 60.0, .bounds = bounds}};
  std::int64_t ticks = 0;
  double push = 0.0;  ///< [N]

  End() {
    line.fit(Space::tool, 6);
    line.prepare(period);
  }
  void tick() {
    link.receive(std::chrono::nanoseconds(2500000 * ++ticks));
    Signals signals;
    signals.jacobian.setZero(6, 0);
    line.read(signals);
    Equivalent<any_size> shown;
    line.equivalent(shown);
    PortState<any_size> state;
    const Vec<any_size> flow = -0.01 * shown.offset;
    shown.at_flow(flow, state);
    line.incident(state);
    push = -state.effort.coeff(0);
    require(state.effort.allFinite() && shown.offset.allFinite(), "what comes out is finite");
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double most = i < 3 ? bounds.force + 2.0 * 60.0 * bounds.speed
                                : bounds.torque + 2.0 * 0.5 * bounds.turning;
      require(std::abs(shown.offset.coeff(i)) <= most, "no wave is beyond the bounds");
    }
    require(std::isfinite(link.player().output()) && std::isfinite(link.energy_sent()) &&
                std::isfinite(link.partner_sent()) && std::isfinite(link.partner_played()),
            "the accounts are finite");
    while (link.outgoing().front() != nullptr) link.outgoing().pop();
  }
  void post(const RemotePacket& packet) {
    link.incoming().draft() = packet;
    (void)link.incoming().post();
  }
};

/// The next packet of a sender that pushes with a wave along x.
void advance(RemotePacket& packet, double wave) {
  ++packet.sequence;
  packet.sent += 2500000;
  packet.sum[0] += period * wave;
  packet.energy_sent += period * wave * wave;
}

/// Spoils one member.
void spoil(RemotePacket& packet, Bytes& bytes) {
  link::WireBytes text;
  link::encode(packet, text);
  const std::size_t at = 8 + bytes.take<std::uint8_t>() % (link::wire_size / 8 - 1) * 8;
  const bool is_number = bytes.take<std::uint8_t>() % 2 != 0;
  const auto word =
      is_number ? std::bit_cast<std::uint64_t>(bytes.number()) : bytes.take<std::uint64_t>();
  for (std::size_t i = 0; i < 8; ++i) text[at + i] = static_cast<std::byte>(word >> (8 * i));
  (void)link::decode(text, packet);
}

void attack(End& end, Bytes& bytes) {
  RemotePacket packet;
  packet.session = 9;
  packet.agreement = agreement;
  for (int i = bytes.take<std::uint8_t>(); i > 0; --i) {
    const auto kind = bytes.take<std::uint8_t>();
    if (kind < 8) packet.session = bytes.take<std::uint16_t>();
    advance(packet, kind < 128 ? 1.0 : bytes.number());
    if (kind % 4 == 0) {
      RemotePacket spoilt = packet;
      spoil(spoilt, bytes);
      if (kind % 8 == 0) packet = spoilt;
      end.post(spoilt);
    } else {
      end.post(packet);
    }
    if (kind % 3 != 0) end.tick();
    // So that the increments above stay defined.
    packet.sequence = std::clamp<std::int64_t>(packet.sequence, 0, 1LL << 60);
    packet.sent = std::clamp<std::int64_t>(packet.sent, 0, 1LL << 60);
  }
}

/// Once the false one is silent, a sound one is heard within the silence after which a partner is
/// another one.
void expect_heard(End& end) {
  RemotePacket sound;
  sound.session = sound_session;
  sound.agreement = agreement;
  for (int i = 0; i < 160; ++i) {
    advance(sound, 0.5);
    end.post(sound);
    end.tick();
  }
  require(end.link.is_linked() && end.link.silent_for() < 0.01, "a sound partner is heard");
  require(end.push > 1.0 && end.push < 10.0, "and its waves come out");
}

void check_wire(Bytes& bytes) {
  std::array<std::byte, link::wire_size + 8> text{};
  for (std::byte& each : text) each = bytes.take<std::byte>();
  if (bytes.take<std::uint8_t>() % 2 == 0) {  // with the mark
    link::WireBytes marked;
    link::encode({}, marked);
    std::copy_n(marked.begin(), 8, text.begin());
  }
  const std::size_t size = bytes.take<std::uint8_t>() % 2 == 0
                               ? link::wire_size
                               : bytes.take<std::uint16_t>() % text.size();
  RemotePacket packet;
  if (!link::decode({text.data(), size}, packet)) return;
  link::WireBytes again;
  link::encode(packet, again);
  require(std::equal(again.begin(), again.end(), text.begin()), "a packet is its bytes");
  End end;
  packet.agreement = agreement;
  end.post(packet);
  end.tick();
  expect_heard(end);
}

}  // namespace
}  // namespace repel::network

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::fuzz::Bytes bytes(data, size);
  if (bytes.take<std::uint8_t>() % 8 == 0) {
    repel::network::check_wire(bytes);
  } else {
    repel::network::End end;
    repel::network::attack(end, bytes);
    repel::network::expect_heard(end);
  }
  return 0;
}
