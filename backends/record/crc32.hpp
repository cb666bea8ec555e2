// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The CRC32 of MCAP, zlib and Ethernet: polynomial 0x04c11db7, bits reflected. By hand:
/// zlib would be a package for the one function, and this one is checked while it is compiled.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace repel::record::detail {

/// Row k holds the remainder of each byte followed by k zero bytes, to process eight bytes per
/// step.
using Crc32Table = std::array<std::array<std::uint32_t, 256>, 8>;

[[nodiscard]] constexpr Crc32Table crc32_table() {
  Crc32Table table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320U : 0U);
    table[0][byte] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = table[k - 1][byte];
      table[k][byte] = (crc >> 8) ^ table[0][crc & 0xff];
    }
  }
  return table;
}

inline constexpr Crc32Table crc32_rows = crc32_table();

/// The CRC of `bytes`; given the CRC of the preceding bytes as `before`, that of both together.
/// Cost: less than a nanosecond per byte.
[[nodiscard]] constexpr std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0) {
  const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  std::uint32_t crc = ~before;
  while (bytes.size() >= 8) {
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      next ^= crc32_rows[7 - k][((crc >> (8 * k)) & 0xff) ^ at(k)];
      next ^= crc32_rows[3 - k][at(k + 4)];
    }
    crc = next;
    bytes.remove_prefix(8);
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    crc = (crc >> 8) ^ crc32_rows[0][(crc & 0xff) ^ at(i)];
  }
  return ~crc;
}

static_assert(crc32("123456789") == 0xcbf43926U);  // the check value of its definition

}  // namespace repel::record::detail
