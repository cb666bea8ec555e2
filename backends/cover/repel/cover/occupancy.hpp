// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boxes of a map whose cubes are solid or not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/base/types.hpp>

namespace repel::cover {

/// Space divided into cubes, each of them solid or not.
struct OccupancyGrid {
  static constexpr std::size_t most = 200'000'000;  ///< cubes

  Vec3 low = Vec3::Zero();           ///< [m] lowest corner
  double edge = 0.1;                 ///< [m] of a cube
  std::array<int, 3> size{0, 0, 0};  ///< cubes along x, y, z
  std::vector<std::uint8_t> solid;   ///< 1 or 0 for each, x fastest, then y

  /// Index of a cube in `solid`.
  [[nodiscard]] std::size_t place(int x, int y, int z) const noexcept {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(x);
  }
  /// The cube along x, y, z with this index.
  [[nodiscard]] std::array<int, 3> cube(std::size_t place) const noexcept {
    const auto x = static_cast<std::size_t>(size[0]);
    const auto y = static_cast<std::size_t>(size[1]);
    return {static_cast<int>(place % x), static_cast<int>(place / x % y),
            static_cast<int>(place / x / y)};
  }
};

/// Cubes from `low` to `high`, both included.
struct CubeRange {
  std::array<int, 3> low{0, 0, 0};   ///< the first cube along x, y, z
  std::array<int, 3> high{0, 0, 0};  ///< the last one

  /// The same cubes.
  friend bool operator==(const CubeRange&, const CubeRange&) = default;
};

/// The same with cubes `factor` times as large, 1 or more; one is solid if any within it is.
/// @param before cubes of the first large one along x, y, z before the first of `grid`, to begin
/// large cubes at multiples of their edge: 0 to `factor` - 1
[[nodiscard]] OccupancyGrid coarser(const OccupancyGrid& grid, int factor,
                                    const std::array<int, 3>& before = {0, 0, 0});

/// The box grown from a cube, in all directions in turn while all of it is solid.
/// @param cube solid @param reach [m] largest from the centre of the box to its corners, unless one
/// cube alone has a larger one
[[nodiscard]] CubeRange grown_from(const OccupancyGrid& grid, const std::array<int, 3>& cube,
                                   double reach = std::numeric_limits<double>::infinity());

/// Boxes that contain every solid cube and nothing else, as their 8 corners [m]. Each starts from a
/// cube in no box yet, and grows in all directions while all of it is solid, through others too: so
/// there are few, and they reach far into each other. Cost: about a second for a million cubes.
/// @throws SetupError if there are more than `most`, with their number
[[nodiscard]] std::vector<std::vector<Vec3>> boxes_of(const OccupancyGrid& grid, int most);

}  // namespace repel::cover
