/// @file
/// A simulated arm: an ArmModel as rigid bodies and joints in the Open Dynamics Engine, in double
/// precision.
#pragma once

#include <memory>
#include <span>

#include <repel/base/layout.hpp>
#include <repel/world/contact.hpp>
#include <repel/world/simulated_arm.hpp>

namespace repel::ode {

/// Defined for the flags this part was built with: a program with others does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

using ArmOptions = SimulationOptions;
using ArmFaults = SimulationFaults;

/// Satisfies TorqueDrivenArm and BrakedArm. Each link is a free body that its joint holds: links
/// part by what a sub-step leaves, less the shorter it is. Same calls, bitwise the same motion. One
/// thread at a time.
class Arm {
 public:
  /// Starts at rest at zero, or at the limit nearest to it.
  /// @param parts what touches: those on links and obstacles, each of the former with each of the
  /// latter; copied. Without parts the arm passes through everything
  /// @throws SetupError when a number of `model` or `options` is out of range, or a link has no
  /// mass or an inertia that is not positive: here every link moves by itself; or when a part is
  /// a cone, a hull or without thickness
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

  /// Joint torques [N m] or forces [N], held until the next call. Beyond 1e9 none is usable.
  void set_torques(std::span<const double> torques) noexcept;

  /// Moves the arm by `period` [s]. Cost grows with substeps x links^3; ODE allocates.
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

  /// How far the joints have come apart [m]: the greatest distance between a link and where its
  /// parent and its joint position put it.
  [[nodiscard]] double parted() const noexcept;

  /// What the parts touched since the last reset.
  [[nodiscard]] ContactReport contact() const noexcept;

  [[nodiscard]] ArmFaults faults() const noexcept;
  void clear_faults() noexcept;

 private:
  struct Simulation;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace repel::ode
