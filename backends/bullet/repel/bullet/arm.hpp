/// @file
/// A simulated arm: an ArmModel as an articulated body in the Bullet engine, in double precision.
#pragma once

#include <memory>
#include <span>

#include <repel/base/layout.hpp>
#include <repel/world/contact.hpp>
#include <repel/world/simulated_arm.hpp>

namespace repel::bullet {

/// Defined for the flags this part was built with: a program with others does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

using ArmOptions = SimulationOptions;
using ArmFaults = SimulationFaults;

/// Satisfies TorqueDrivenArm and BrakedArm. Same calls, bitwise the same motion. One thread at a
/// time.
class Arm {
 public:
  /// Starts at rest at zero, or at the limit nearest to it.
  /// @param parts what touches: those on links and obstacles, each of the former with each of the
  /// latter; copied. Without parts the arm passes through everything
  /// @throws SetupError when a number of `model` or `options` is out of range, when a part has no
  /// thickness, or when the Bullet library in use is not the double-precision one
  explicit Arm(const ArmModel& model, const ArmOptions& options = {},
               std::span<const ContactPart> parts = {});
  ~Arm();
  Arm(Arm&&) noexcept;
  Arm& operator=(Arm&&) noexcept;

  /// Number of links, which is the number of joints.
  [[nodiscard]] int links() const noexcept;

  /// Puts the arm at `q` [rad] or [m], moving at `v` [rad/s] or [m/s] (at rest when `v` is empty),
  /// enabled, with zero torque and nothing touched. Faults stay.
  /// @throws SetupError when a size is wrong, `q` is outside the limits or `v` is not finite
  void reset(std::span<const double> q, std::span<const double> v = {});

  /// Joint torques [N m] or forces [N], held until the next call.
  void set_torques(std::span<const double> torques) noexcept;

  /// Moves the arm by `period` [s]. No allocation, no lock; cost grows with substeps x links^3.
  /// With parts each sub-step has to find what they touch, and Bullet may allocate for it.
  void step(double period) noexcept;

  /// Torques act and the brakes are off, from now on; so the arm begins.
  void enable() noexcept;

  /// No torque acts and the brakes are on, until `enable`. So it ends as well when the watchdog of
  /// the options finds that no torques were set for too long a time of the arm.
  void stop() noexcept;

  /// Brakes on or off while the arm is enabled; no torque acts while they are on.
  void engage_brakes(bool on) noexcept;

  [[nodiscard]] ArmState state() const noexcept;

  /// Joint positions [rad] or [m]; fills as many as `out` holds.
  void read_positions(std::span<double> out) const noexcept;

  /// Joint velocities [rad/s] or [m/s]; fills as many as `out` holds.
  void read_velocities(std::span<double> out) const noexcept;

  /// What the parts touched since the last reset.
  [[nodiscard]] ContactReport contact() const noexcept;

  [[nodiscard]] ArmFaults faults() const noexcept;
  void clear_faults() noexcept;

 private:
  struct Simulation;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace repel::bullet
