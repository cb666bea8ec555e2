// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Tells a joint at rest from one with a frozen encoder.
#pragma once

#include <limits>

#include <repel/loop/options.hpp>

namespace repel {

/// Bounds of the torques on a joint between two readings. Forces for a prismatic joint.
struct JointLoad {
  double surely = 0.0;        ///< [N m] lower bound of the net torque over all delays of the drive;
                              ///< signed
  double at_most = 0.0;       ///< [N m] upper bound of its magnitude
  double dry = 0.0;           ///< [N m] dry friction of the model
  double weight = 0.0;        ///< [N m] gravity torque
  double effort = 0.0;        ///< [N m] limit
  double inertia = 1.0;       ///< [kg m^2] or [kg] of the model
  double free_inertia = 1.0;  ///< [kg m^2] or [kg] while all other joints give way
  double elapsed = 0.0;       ///< [s]
  bool is_held = false;       ///< by a brake
};

/// Decides by the torques on a joint while it reports the same position, bit for bit. Friction is
/// known to a factor only, so there are three cases:
///
/// - The joint moved, or moves by its rate, or is pushed by more than dry friction and an error of
///   the gravity model can hold: its encoder is frozen.
/// - It is pushed by less than it withstood before, or by less than half of its dry friction: it
///   stands still.
/// - Between these, it may move unseen. Before it can be `unseen` far, the torque is raised until
///   it must move (`probe`). A sound joint breaks away; from then on, it is known to withstand its
///   last torque at rest.
class StillJoint {
 public:
  /// Advances by a reading. @param q [rad] @param v [rad/s] this reading; `last_q`, `last_v` the
  /// one before
  /// @return true while the encoder is taken for frozen
  [[nodiscard]] bool step(double q, double v, double last_q, double last_v, const JointLoad& load,
                          const JointWatchOptions& options) noexcept;

  /// [N m] Net torque at which the joint must move, signed; 0: there is no doubt. To be sent at
  /// least, within all limits.
  [[nodiscard]] double probe(const JointLoad& load,
                             const JointWatchOptions& options) const noexcept;

  /// [rad/s] Rate by the torques of a joint reporting none, signed.
  [[nodiscard]] double rate() const noexcept;
  /// [rad] Estimated unseen way, signed. @param elapsed [s] from reading to reading
  [[nodiscard]] double way(double elapsed) const noexcept;
  /// A frozen joint begun anew is probed again.
  void forget() noexcept;

 private:
  static constexpr double surely_sticks = 0.5;  // of the dry friction
  static constexpr double unseen = 0.1;         // of the position noise
  static constexpr double seen = 0.1;           // of the position noise: what a probe has to move
  static constexpr double coarse = 0.1;         // of the position noise: coarsest encoder, not told
  static constexpr double at_once = 0.005;      // [s]
  static constexpr double ramp = 0.0075;        // [s] of a probe
  static constexpr double memory = 10.0;        // [s] of the withstood torque

  // [rad] After which the position must have changed.
  [[nodiscard]] double shown(const JointWatchOptions& options) const noexcept;

  // [N m] at which it must move.
  [[nodiscard]] double held_by(const JointLoad& load) const noexcept;

  void push(const JointLoad& load, const JointWatchOptions& options) noexcept;

  void move_on() noexcept;

  // [rad] Beyond the last reading, if friction and all torque brake the joint.
  [[nodiscard]] static double shortest_way(double last_v, const JointLoad& load,
                                           const JointWatchOptions& options) noexcept;

  double finest_ = std::numeric_limits<double>::infinity();  // [rad] step of the position
  double resolution_ = 0.0;                                  // [rad]
  double step_ = 0.0;                                        // [rad] that it may be at most
  int same_ = 0;
  int moving_ = 0;                               // consecutive, by the rate
  bool has_moved_ = false;                       // before the position repeated
  bool is_frozen_ = false;                       // until another position is reported
  double moved_at_ = 0.0;                        // [rad/s] before the position repeated
  double direction_ = 1.0;                       // sign of the torque
  double begun_ = 1.0;                           // likewise, when probing began
  bool turns_ = false;                           // probing began the other way
  double withstood_ = 0.0;                       // [N m] at which it was seen to stand still
  double stood_under_ = 0.0;                     // [N m] since the position repeats, but for probes
  double free_rate_ = 0.0, free_way_ = 0.0;      // [rad/s], [rad] without friction
  double forced_rate_ = 0.0, forced_way_ = 0.0;  // at least, with the greatest friction
  double unseen_rate_ = 0.0, unseen_way_ = 0.0;  // at most, with the least friction
  double enough_ = 0.0;                          // [rad] forced way that proves a frozen encoder
  double evident_ = 0.0;                         // [rad] free way that proves friction
  double probing_ = 0.0;                         // [s]
};

}  // namespace repel
