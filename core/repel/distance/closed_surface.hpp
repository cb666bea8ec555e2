// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The faces of a polytope as a warm start keeps them, and the proof that they are a closed
/// surface.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <repel/distance/query.hpp>

namespace repel::detail {

/// The corners of a triangle, counter-clockwise seen from outside.
using Triangle = std::array<std::uint8_t, 3>;

/// The corners in one number, four bits each.
[[nodiscard]] inline std::uint16_t packed(const Triangle& corners) noexcept {
  return static_cast<std::uint16_t>(corners[0] | corners[1] << 4 | corners[2] << 8);
}

/// Reads as many faces as there are `kept` into the member `corners` of each of `faces`. False
/// unless every edge of each is met by one in the other direction, no two edges are the same, and
/// all corners are below `corner_count`. Cost: a few dozen instructions for each face.
template <class Face>
[[nodiscard]] bool read_closed_surface(std::span<const std::uint16_t> kept,
                                       std::size_t corner_count, Face* faces) noexcept {
  // One bit for each corner reached by an edge, and for each from which an edge comes.
  std::array<std::uint16_t, WarmStart::most_corners> to{};
  std::array<std::uint16_t, WarmStart::most_corners> from{};
  unsigned used = 0;
  for (std::size_t f = 0; f < kept.size(); ++f) {
    const unsigned p = kept[f] & 15U;
    const unsigned q = kept[f] >> 4U & 15U;
    const unsigned r = kept[f] >> 8U & 15U;
    const auto bit_p = static_cast<std::uint16_t>(1U << p);
    const auto bit_q = static_cast<std::uint16_t>(1U << q);
    const auto bit_r = static_cast<std::uint16_t>(1U << r);
    used |= bit_p | bit_q | bit_r;
    to[p] |= bit_q;
    to[q] |= bit_r;
    to[r] |= bit_p;
    from[q] |= bit_p;
    from[r] |= bit_q;
    from[p] |= bit_r;
    faces[f].corners = {static_cast<std::uint8_t>(p), static_cast<std::uint8_t>(q),
                        static_cast<std::uint8_t>(r)};
  }
  std::size_t different = 0;
  for (const std::uint64_t ends : std::bit_cast<std::array<std::uint64_t, 4>>(to)) {
    different += static_cast<std::size_t>(std::popcount(ends));
  }
  return used >> corner_count == 0U && different == 3 * kept.size() && to == from;
}

}  // namespace repel::detail
