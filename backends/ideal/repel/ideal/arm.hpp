// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated arm without a physics engine: decoupled joints without gravity.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/simulated/arm_drive.hpp>

namespace repel {

/// One joint of an IdealArm.
struct IdealJoint {
  double inertia = 1.0;           ///< [kg m^2] or [kg]; > 0
  double viscous_friction = 0.0;  ///< [N m s/rad] or [N s/m]; >= 0
  /// [N m] or [N] of its brake; >= 0. Infinite: the joint stops at once.
  double brake_torque = std::numeric_limits<double>::infinity();
};

/// Options of the drive of an IdealArm.
struct IdealOptions {
  double watchdog = 0.0;  ///< [s] without torques after which the arm stops; 0: never
};

/// An arm whose joints obey inertia * a = torque - viscous_friction * v, each independently,
/// integrated by semi-implicit Euler with the friction at the new velocity. A brake is dry
/// friction, which stops a joint and holds it.
class IdealArm final : public TorqueDrivenArm {
 public:
  /// Starts at rest at zero.
  /// @throws SetupError if there is no joint, or an inertia, friction or option is out of range
  explicit IdealArm(std::span<const IdealJoint> joints, const IdealOptions& options = {})
      : drive_(options.watchdog) {
    if (joints.empty()) throw SetupError("an IdealArm needs at least one joint");
    for (const IdealJoint& joint : joints) joints_.push_back({validated(joint), 0.0, 0.0, 0.0});
  }

  /// Number of joints.
  [[nodiscard]] int links() const noexcept { return static_cast<int>(joints_.size()); }

  /// Puts the arm at rest at `q` [rad] or [m], enabled, with zero torque. The fault stays.
  /// @throws SetupError if the size is wrong or an entry is not finite
  void reset(std::span<const double> q) {
    const bool finite = std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); });
    if (q.size() != joints_.size() || !finite) {
      throw SetupError("reset needs " + std::to_string(joints_.size()) + " finite positions");
    }
    for (std::size_t i = 0; i < q.size(); ++i) joints_[i] = {joints_[i].constants, q[i], 0.0, 0.0};
    drive_.reset();
  }

  /// Joint torques [N m] or forces [N], held until the next call. An entry that is not finite or
  /// missing counts as zero and sets `torque_fault`.
  void set_torques(std::span<const double> torques) noexcept override {
    drive_.heard();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const bool usable = i < torques.size() && std::isfinite(torques[i]);
      joints_[i].torque = usable ? torques[i] : 0.0;
      torque_fault_ = torque_fault_ || !usable;
    }
  }

  /// Advances the arm by `period` [s]; does nothing if that is not finite and positive.
  void step(double period) noexcept override {
    if (!(period > 0.0 && std::isfinite(period))) return;
    if (drive_.advance(period)) forget_torques();
    const bool braked = drive_.braked();
    for (Joint& joint : joints_) {
      const auto [inertia, viscous_friction, brake] = joint.constants;
      const double torque = braked ? 0.0 : joint.torque;
      const double divisor = inertia + period * viscous_friction;
      joint.velocity = (inertia * joint.velocity + period * torque) / divisor;
      if (braked) {
        const double stopped = period * brake / divisor;
        joint.velocity -= std::clamp(joint.velocity, -stopped, stopped);
      }
      joint.position += period * joint.velocity;
    }
  }

  /// Enables the arm: torques act and the brakes are off. This is the initial state.
  void enable() noexcept override { drive_.enable(); }

  /// Stops the arm: no torque acts and the brakes are on, until `enable`. The watchdog of the
  /// options does the same if no torques are set for its timeout, in simulated time.
  void stop() noexcept override {
    drive_.stop();
    forget_torques();
  }

  /// Brakes on or off while the arm is enabled; no torque acts while they are on.
  void engage_brakes(bool on) noexcept override { drive_.engage_brakes(on); }

  /// Whether torques act, or it has been stopped.
  [[nodiscard]] ArmState state() const noexcept override { return drive_.state(); }

  /// Joint positions [rad] or [m]; fills as many as `out` holds.
  void read_positions(std::span<double> out) const noexcept override {
    const auto count = std::min(out.size(), joints_.size());
    for (std::size_t i = 0; i < count; ++i) out[i] = joints_[i].position;
  }

  /// Joint velocities [rad/s] or [m/s]; fills as many as `out` holds.
  void read_velocities(std::span<double> out) const noexcept override {
    const auto count = std::min(out.size(), joints_.size());
    for (std::size_t i = 0; i < count; ++i) out[i] = joints_[i].velocity;
  }

  /// Zero: the arm touches nothing.
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override { return Wrench{}; }

  /// True once an entry passed to `set_torques` was unusable.
  [[nodiscard]] bool torque_fault() const noexcept { return torque_fault_; }
  void clear_fault() noexcept { torque_fault_ = false; }  ///< forgets that one was not finite

 private:
  struct Joint {
    IdealJoint constants;
    double position, velocity, torque;  // [rad], [rad/s], [N m]
  };

  void forget_torques() noexcept {
    for (Joint& joint : joints_) joint.torque = 0.0;
  }

  static IdealJoint validated(const IdealJoint& joint) {
    constexpr double largest = std::numeric_limits<double>::max();
    constexpr double smallest = std::numeric_limits<double>::min();
    checked("IdealJoint::inertia", joint.inertia, smallest, largest, "kg m^2");
    checked("IdealJoint::viscous_friction", joint.viscous_friction, 0.0, largest, "N m s/rad");
    checked("IdealJoint::brake_torque", joint.brake_torque, 0.0,
            std::numeric_limits<double>::infinity(), "N m");
    return joint;
  }

  ArmDrive drive_;
  std::vector<Joint> joints_;
  bool torque_fault_ = false;
};

}  // namespace repel
