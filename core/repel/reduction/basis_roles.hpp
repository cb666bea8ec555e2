// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The roles of the rows of a basis.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace repel::detail {

/// The role of each of the five rows of a basis, by the set of rows that belong to B.
struct BasisRoles {
  std::array<std::uint8_t, 2> base{};          ///< for A and B: the row that eliminates the depth
  std::array<std::uint8_t, 3> equation{};      ///< the other rows, which determine x
  std::array<std::uint8_t, 3> side{};          ///< the side of each of these, 0 for A, 1 for B
  std::array<std::array<double, 4>, 2> has{};  ///< 1 where an equation belongs to A, and to B
};

[[nodiscard]] constexpr std::array<BasisRoles, 32> all_basis_roles() {
  std::array<BasisRoles, 32> all{};
  for (unsigned of_b = 1; of_b < 31; ++of_b) {
    std::array<bool, 2> has_base{};
    std::size_t equations = 0;
    for (unsigned k = 0; k < 5; ++k) {
      const unsigned side = of_b >> k & 1U;
      if (!has_base[side]) {
        all[of_b].base[side] = static_cast<std::uint8_t>(k);
        has_base[side] = true;
      } else {
        all[of_b].equation[equations] = static_cast<std::uint8_t>(k);
        all[of_b].has[side][equations] = 1.0;
        all[of_b].side[equations++] = static_cast<std::uint8_t>(side);
      }
    }
  }
  return all;
}

}  // namespace repel::detail
