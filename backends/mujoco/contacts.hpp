// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Contacts of an arm in MuJoCo: their law, and their forces.
#pragma once

#include <mujoco/mujoco.h>

#include <repel/base/spatial.hpp>
#include <repel/simulated/simulated_arm.hpp>

namespace repel::mujoco::detail {

/// A contact point is a spring K and a damper C along its normal, and a damper C along the surface,
/// limited by dry friction. MuJoCo solves for an acceleration a of each row of its constraints
///
///     a + R f = a_ref,   with x the (negative) distance, v the speed and v' = v + h a:
///     f = -K (x + h v') - C v'   gives   R = 1 / (h (C + h K)),   a_ref = -R K x - v / h.
///
/// The force is exactly that of an implicit spring and damper. MuJoCo's own parameters would make
/// it depend on the masses.
class Contacts {
 public:
  /// @param tally gets depths and forces; it must outlive this object
  Contacts(const ArmModel& model, const SimulationOptions& options, ContactTally& tally);

  /// Sets the law of all contact points, for a sub-step of `h` [s]: between the velocity stage of
  /// MuJoCo and its solver.
  void set_law(mjData& data, double h) noexcept;

  /// Adds up the forces on the last link, once they are solved in a sub-step.
  void note_forces(const mjModel& model, const mjData& data) noexcept;

 private:
  SimulationOptions options_;
  Pose X_LT_;  // [m]
  int last_;   // body of the link that carries the tool
  ContactTally& tally_;
};

}  // namespace repel::mujoco::detail
