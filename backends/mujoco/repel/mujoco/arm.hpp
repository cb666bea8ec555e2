// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm: an ArmModel as a model of the MuJoCo engine.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <repel/base/layout.hpp>
#include <repel/simulated/contact.hpp>
#include <repel/simulated/simulated_arm.hpp>

namespace repel::mujoco {

/// Defined for the compiler flags of this library: a program with incompatible flags does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

using ArmOptions = SimulationOptions;  ///< as of every simulated arm
using ArmFaults = SimulationFaults;    ///< as of every simulated arm

/// A simulated arm with brakes. Deterministic: the same calls give bitwise the same motion. One
/// thread at a time.
///
/// What MuJoCo reports as an error is a fault of the arm. By itself it would end the process, so
/// the first arm sets `mju_user_error` and `mju_user_warning`; what comes from elsewhere goes on to
/// the handlers that were there before.
class Arm final : public TorqueDrivenArm {
 public:
  /// Starts at rest at zero, or at the joint limit nearest to it.
  /// @param parts collision parts on links, and obstacles; each of the former is tested against
  ///   each of the latter. Copied. Without parts the arm passes through everything
  /// @throws SetupError if a number of `model` or `options` is out of range, a joint moves no mass,
  ///   or a part is a cone or without thickness
  explicit Arm(const ArmModel& model, const ArmOptions& options = {},
               std::span<const ContactPart> parts = {});
  ~Arm() override;
  /// Moves; the other may then only be assigned to or destroyed.
  Arm(Arm&&) noexcept;
  /// Moves; the other may then only be assigned to or destroyed.
  Arm& operator=(Arm&&) noexcept;

  /// Number of links, equal to the number of joints.
  [[nodiscard]] int links() const noexcept;

  /// Puts the arm at `q` [rad] or [m], moving at `v` [rad/s] or [m/s] (at rest if `v` is empty),
  /// enabled, with zero torque and a cleared contact report. Faults stay.
  /// @throws SetupError if a size is wrong, `q` is outside the limits or `v` is not finite
  void reset(std::span<const double> q, std::span<const double> v = {});

  /// Joint torques [N m] or forces [N], held until the next call. One that is not finite counts as
  /// zero and sets a fault.
  void set_torques(std::span<const double> torques) noexcept override;

  /// Advances the arm by `period` [s]. No allocation, no lock; cost grows with substeps x links^3.
  void step(double period) noexcept override;

  /// Enables the arm: torques act and the brakes are off. This is the initial state.
  void enable() noexcept override;

  /// Stops the arm: no torque acts and the brakes are on, until `enable`. The watchdog of the
  /// options does the same if no torques are set for its timeout, in simulated time.
  void stop() noexcept override;

  /// Brakes on or off while the arm is enabled; no torque acts while they are on.
  void engage_brakes(bool on) noexcept override;

  /// Whether torques act, or it has been stopped.
  [[nodiscard]] ArmState state() const noexcept override;

  /// Joint positions [rad] or [m]; fills as many as `out` holds.
  void read_positions(std::span<double> out) const noexcept override;

  /// Joint velocities [rad/s] or [m/s]; fills as many as `out` holds.
  void read_velocities(std::span<double> out) const noexcept override;

  /// Contacts since the last reset.
  [[nodiscard]] ContactReport contact() const noexcept override;

  /// The sum of all contact forces on the parts of the last link, mean of the sub-steps of the last
  /// step; zero without parts. The weight of the tool is not part of it.
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override;

  /// What it has rejected since construction or `clear_faults`.
  [[nodiscard]] ArmFaults faults() const noexcept;
  /// Forgets these faults.
  void clear_faults() noexcept;

 private:
  struct Simulation;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace repel::mujoco
