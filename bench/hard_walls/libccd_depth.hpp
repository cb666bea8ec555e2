// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How deep arms are in walls, by a computation that shares no distance with the library.
#pragma once

#include <span>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::hard_walls {

/// Was libccd found when this was built? Else nothing is deep.
#ifdef REPEL_HAS_LIBCCD
inline constexpr bool has_libccd = true;
#else
inline constexpr bool has_libccd = false;
#endif

/// Poses from the joints alone, and overlaps by libccd: Gilbert, Johnson and Keerthi's algorithm,
/// then the expanding polytope, on the support maps of the shapes with their rounding.
class LibccdDepth {
 public:
  /// @param cell whose bodies and pairs are looked at; it must live as long
  explicit LibccdDepth(const Cell& cell);
  /// Depth of the deepest overlap of two parts that must not enter each other [m]; 0: there is
  /// none. @param time [s] since the first tick, for walls that move
  [[nodiscard]] double at(std::span<const ArmReadings> readings, double time);

 private:
  void place(std::span<const ArmReadings> readings, double time);

  const Cell& cell_;
  World world_;
  std::vector<Kinematics> kinematics_;
};

}  // namespace repel::hard_walls
