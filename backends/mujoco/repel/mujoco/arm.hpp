// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm: an ArmModel as a model of the MuJoCo engine.
#pragma once

#include <span>

#include <repel/simulated/contact.hpp>
#include <repel/simulated/simulated_arm.hpp>

namespace repel::mujoco {

using ArmOptions = SimulationOptions;  ///< as of every simulated arm
using ArmFaults = SimulationFaults;    ///< as of every simulated arm

/// A step allocates nothing. What MuJoCo reports as an error is a fault of the arm. By itself it
/// would end the process, so the first arm sets `mju_user_error` and `mju_user_warning`; what comes
/// from elsewhere goes on to the handlers that were there before.
class Arm final : public SimulatedArm {
 public:
  /// @param parts collision parts on links, and obstacles; each of the former is tested against
  ///   each of the latter. Copied. Without parts the arm passes through everything
  /// @throws SetupError if a number of `model` or `options` is out of range, a joint moves no mass,
  ///   or a part is a cone or without thickness
  explicit Arm(const ArmModel& model, const ArmOptions& options = {},
               std::span<const ContactPart> parts = {});
};

}  // namespace repel::mujoco
