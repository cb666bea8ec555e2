// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm: an ArmModel as an articulated body in the Bullet engine, in double precision.
#pragma once

#include <span>

#include <repel/simulated/contact.hpp>
#include <repel/simulated/simulated_arm.hpp>

namespace repel::bullet {

using ArmOptions = SimulationOptions;  ///< as of every simulated arm
using ArmFaults = SimulationFaults;    ///< as of every simulated arm

/// A step allocates nothing, unless it has parts: Bullet may allocate in the search for contacts,
/// which each sub-step makes then.
class Arm final : public SimulatedArm {
 public:
  /// @param parts collision parts on links, and obstacles; each of the former is tested against
  ///   each of the latter. Copied. Without parts the arm passes through everything
  /// @throws SetupError if a number of `model` or `options` is out of range, a part has no
  ///   thickness, or the Bullet library is not built in double precision
  explicit Arm(const ArmModel& model, const ArmOptions& options = {},
               std::span<const ContactPart> parts = {});
};

}  // namespace repel::bullet
