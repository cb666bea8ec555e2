// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm: an ArmModel as rigid bodies and joints in the Open Dynamics Engine, in double
/// precision.
#pragma once

#include <span>

#include <repel/simulated/contact.hpp>
#include <repel/simulated/simulated_arm.hpp>

namespace repel::ode {

using ArmOptions = SimulationOptions;  ///< as of every simulated arm
using ArmFaults = SimulationFaults;    ///< as of every simulated arm

/// Each link is a free body held by its joint. The links drift apart by the constraint error of a
/// sub-step; shorter sub-steps drift less. A step allocates. A torque above 1e9 counts as zero.
class Arm final : public SimulatedArm {
 public:
  /// @param parts collision parts on links, and obstacles; each of the former is tested against
  ///   each of the latter. Copied. Without parts the arm passes through everything
  /// @throws SetupError if a number of `model` or `options` is out of range, a link has no mass or
  ///   an inertia that is not positive definite (each link is a free body), or a part is a cone, a
  ///   hull, an ellipsoid or without thickness
  explicit Arm(const ArmModel& model, const ArmOptions& options = {},
               std::span<const ContactPart> parts = {});

  /// Constraint drift of the joints [m]: the greatest distance between the centre of mass of a link
  /// and where its parent and its joint position put it.
  [[nodiscard]] double parted() const noexcept;
};

}  // namespace repel::ode
