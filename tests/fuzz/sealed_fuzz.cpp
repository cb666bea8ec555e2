// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary datagrams by someone without the key, to both sides of a sealed link, before and after
// they have met: none is taken for a packet, no session comes of it, and the partner stays heard.
#include <repel/sealed/sealed.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <random>
#include <vector>

#include <sodium.h>

#include <fuzz/bytes.hpp>
#include <link/datagrams_within.hpp>

namespace repel::sealed {
namespace {

using fuzz::require;
using link::sealed_size;
using link::Side;
using test::Bytes;

/// An input is to do the same each time.
std::mt19937 numbers;
std::uint32_t next_number() {
  return static_cast<std::uint32_t>(numbers());
}
const char* their_name() {
  return "numbers of a fuzz target";
}

/// Two sides in one thread, with what is on the way, and all that ever was.
struct Sides {
  std::deque<Bytes> to_site, to_station;
  std::vector<Bytes> recorded;
  std::unique_ptr<link::Transport> site =
      seal(std::make_unique<test::DatagramsWithin>(to_station, to_site), Side::site, Key{1});
  std::unique_ptr<link::Transport> station =
      seal(std::make_unique<test::DatagramsWithin>(to_site, to_station), Side::station, Key{1});
  network::RemotePacket packet;

  /// Takes all that has come; only sound packets are, each once.
  void take(link::Transport& side, std::deque<Bytes>& way) {
    recorded.insert(recorded.end(), way.begin(), way.end());
    network::RemotePacket come;
    while (!way.empty()) {
      if (!side.receive(come)) continue;
      require(come.session == packet.session && come.sequence == packet.sequence,
              "what comes was sent");
      ++packet.values[0];
    }
  }
  /// Whether a packet of the station comes, and one of the site.
  void require_heard() {
    packet.session = packet.heard = 2;
    ++packet.sequence;
    for (const bool from_station : {true, false}) {
      const double before = packet.values[0];
      (void)(from_station ? station : site)->send(packet);
      take(from_station ? *site : *station, from_station ? to_site : to_station);
      require(packet.values[0] == before + 1.0, "a partner is heard");
    }
  }
  void join() {
    network::RemotePacket none;
    (void)station->receive(none);
    take(*site, to_site);
    take(*station, to_station);
    require_heard();
  }
};

/// Noise, noise with a sound head, or a datagram that was there, damaged, cut, or as it was.
Bytes forged(const Sides& sides, fuzz::Bytes& bytes) {
  const auto kind = bytes.take<std::uint8_t>();
  Bytes text(sealed_size);
  if (kind % 4 == 0 || sides.recorded.empty()) {
    if (kind % 8 == 0) text.resize(bytes.take<std::uint16_t>() % (sealed_size + 8));
    for (std::byte& each : text) each = bytes.take<std::byte>();
    if (kind % 3 == 0 && text.size() > 8) {
      constexpr std::array<char, 8> head{'r', 'e', 'p', 'e', 'l', 3, 0, 1};
      std::transform(head.begin(), head.end(), text.begin(),
                     [](char c) { return static_cast<std::byte>(c); });
      text[5] = static_cast<std::byte>(1 + kind / 3 % 3);
    }
    return text;
  }
  text = sides.recorded[bytes.take<std::uint16_t>() % sides.recorded.size()];
  if (kind % 4 == 1) return text;
  for (int i = bytes.take<std::uint8_t>() % 8; i >= 0; --i) {
    text[bytes.take<std::uint16_t>() % text.size()] ^= bytes.take<std::byte>();
  }
  if (kind % 4 == 3) text.resize(bytes.take<std::uint16_t>() % (sealed_size + 8));
  return text;
}

void attack(Sides& sides, fuzz::Bytes& bytes) {
  const double before = sides.packet.values[0];
  for (int i = bytes.take<std::uint8_t>() % 32; i > 0; --i) {
    const bool at_site = bytes.take<std::uint8_t>() % 2 == 0;
    std::deque<Bytes>& way = at_site ? sides.to_site : sides.to_station;
    way.push_back(forged(sides, bytes));
    network::RemotePacket none;
    while (!way.empty()) {
      if (at_site ? sides.site->receive(none) : sides.station->receive(none)) {
        require(false, "what others send is no packet");
      }
    }
  }
  require(sides.packet.values[0] == before, "nothing came");
}

}  // namespace
}  // namespace repel::sealed

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace repel;
  static randombytes_implementation known{
      sealed::their_name, sealed::next_number, nullptr, nullptr, nullptr, nullptr};
  known.buf = [](void* const out, const std::size_t count) {
    auto* const bytes = static_cast<std::uint8_t*>(out);
    std::generate_n(bytes, count, [] { return static_cast<std::uint8_t>(sealed::numbers()); });
  };
  (void)randombytes_set_implementation(&known);
  sealed::numbers.seed(1);
  fuzz::Bytes bytes(data, size);
  sealed::Sides sides;
  sealed::attack(sides, bytes);
  sides.join();
  for (int i = bytes.take<std::uint8_t>() % 4; i >= 0; --i) {
    sealed::attack(sides, bytes);
    sides.require_heard();
  }
  return 0;
}
