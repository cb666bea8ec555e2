// SPDX-License-Identifier: BSD-3-Clause
#include <repel/link/wire.hpp>

#include <bit>
#include <cstdint>

namespace repel::link {
namespace {

using network::RemotePacket;

constexpr std::size_t words = sizeof(RemotePacket) / 8;
using Words = std::array<std::uint64_t, words>;
// Nothing but members of 8 bytes: seven integers, two energies, sums and values.
static_assert(words == 9 + network::most_joints + RemotePacket::most_values);

/// "repel" and the version of this layout.
constexpr std::uint64_t mark = 0x01'00'00'6c'65'70'65'72U;

void put(std::uint64_t word, std::byte* to) noexcept {
  for (int i = 0; i < 8; ++i) to[i] = static_cast<std::byte>(word >> (8 * i) & 0xFFU);
}
std::uint64_t get(const std::byte* from) noexcept {
  std::uint64_t word = 0;
  for (int i = 0; i < 8; ++i) word |= std::to_integer<std::uint64_t>(from[i]) << (8 * i);
  return word;
}

}  // namespace

void encode(const RemotePacket& packet, WireBytes& bytes) noexcept {
  const auto all = std::bit_cast<Words>(packet);
  put(mark, bytes.data());
  for (std::size_t i = 0; i < words; ++i) put(all[i], bytes.data() + 8 * (i + 1));
}

bool decode(std::span<const std::byte> bytes, RemotePacket& packet) noexcept {
  if (bytes.size() != wire_size || get(bytes.data()) != mark) return false;
  Words all;
  for (std::size_t i = 0; i < words; ++i) all[i] = get(bytes.data() + 8 * (i + 1));
  packet = std::bit_cast<RemotePacket>(all);
  return true;
}

}  // namespace repel::link
