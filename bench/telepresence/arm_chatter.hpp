// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Chatter of the simulated arm: of the walls, of its joints and of the lever.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "arm_run.hpp"
#include "part.hpp"

namespace repel::telepresence {

/// Collects the forces and torques of a run: of the walls on the tool, about the origin of its
/// frame, the commanded torque of each joint, and that of the lever. Results are of the last
/// second: the chatter above 30 Hz and the largest jump from tick to tick. Of the walls they are
/// those of the worst axis of the world.
class ArmChatter {
 public:
  /// What the columns are, for the notes of a table.
  static constexpr const char* note =
      "Jumps are from one tick to the next. Torque: of the walls, about the origin of the tool; of "
      "it and of the jump of the force the worst axis counts, of the joints the worst one.";

  /// @param rate_hz [Hz] of the ticks
  explicit ArmChatter(double rate_hz);

  void add(const ArmTick& tick);

  /// Names of the cells of row(), with units.
  [[nodiscard]] static std::vector<std::string> columns();
  /// Jump of the walls' force; chatter and jump of the walls' torque, of the worst joint, and of
  /// the lever.
  [[nodiscard]] std::vector<Json> row() const;
  /// Number, chatter and jump [N m] of each joint, base outward.
  [[nodiscard]] Json joints() const;
  /// Curves for the plot: the largest torque of the walls in every 50 ms and its largest jump, both
  /// as lengths of vectors.
  [[nodiscard]] Json curves() const;

 private:
  double rate_hz_;
  std::array<Trace, 3> force_{};   // [N] of the walls, by axis
  std::array<Trace, 3> torque_{};  // [N m] likewise
  std::vector<Trace> joints_{};    // [N m]
  Trace lever_{};                  // [N m]
  std::vector<Vec3> torques_{};    // [N m] of the walls
};

/// Puts cells or names behind those of a table.
template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace repel::telepresence
