// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Options of the loop: reactions to faults, and speed limits.
#pragma once

namespace repel {

/// Bounds of the energy that an arm gains by sampling (loop/watch/energy_watch.hpp).
struct EnergyWatchOptions {
  double taken_back = 1.0;  ///< [J] gained in `memory` above which the arm is braked in proportion
  double most = 5.0;        ///< [J] gained in `memory` above which it is a fault; both are for 400
                            ///< Hz and more, in proportion to the period for lower rates, and
                            ///< not watched below 10 Hz
  double memory = 1.0;      ///< [s] time constant with which a gain is forgotten
  double latch = 0.0;       ///< [s] for which a fault stays, twice as long each time it comes back
};

/// Ramps of the operator's force (loop/watch/failsafe.hpp).
struct FailsafeOptions {
  double fall = 0.05;  ///< [s] in which the force ramps to zero after a fault
  double hold = 0.25;  ///< [s] without a fault before the force comes back
  double rise = 0.5;   ///< [s] in which the force comes back
};

/// Handling of a motion that is not observed (loop/watch/stop_control.hpp).
struct StopOptions {
  double predicted = 0.02;  ///< [s], at least three ticks, for which an unobserved motion is braked
                            ///< by prediction before the brakes are requested
  double released = 0.5;    ///< [s] after which an arm with unobserved motion is released
};

/// Time constants of the torques (loop/joint_torques.hpp).
struct JointTorqueOptions {
  double brake_time = 0.02;  ///< [s], at least four ticks, in which braking removes 63 % of a
                             ///< speed, as far as the efforts of the joints allow
  double slew_time = 0.005;  ///< [s] in which a torque may go from zero to its limit
};

/// Options of the barrier before hard walls (loop/barrier/entry_barrier.hpp).
struct EntryBarrierOptions {
  double margin = 0.25e-3;  ///< [m] before the surface where an arm is held, at 400 Hz and more; in
                            ///< proportion to the period at lower rates
  double mass_uncertainty = 1.7;  ///< factor by which inertia and torque may be off
  double recovery = 0.05;         ///< [m/s] at most, at which an arm goes back to the margin
};

/// Tolerances for the readings of a sound arm. Angles; lengths likewise in [m] and [m/s].
struct JointWatchOptions {
  double position_noise = 1e-3;  ///< [rad] error of one reading relative to the next
  double rate_noise = 0.2;       ///< [rad/s] error of one rate relative to the next
  double resolution = 1e-5;      ///< [rad] smallest step of a position
  double jitter = 1.0;           ///< [periods] by which the time between readings may be off
  int repeats = 1;  ///< ticks a sound arm may report the same position of a moving joint; more for
                    ///< an arm read faster than it measures
  double mass_uncertainty = 1.7;  ///< factor by which inertia and torque may be off
  bool touches = false;  ///< the arm may press on unmodelled objects, and be pushed by them: a
                         ///< joint at rest against a force is believed, and motion without torque
                         ///< is no fault
  int regain = 4;        ///< consecutive sound readings after which they are believed again
};

/// Options of the control of one arm.
struct TeleoperatorOptions {
  double tool_speed = 0.25;  ///< [m/s] top speed of the tool, driven by the operator and by walls
                             ///< at rest; 1e-3 to 10
  double longest_gap = 0.1;  ///< [s] without a tick after which the operator's force is removed
  double exit_speed = 0.02;  ///< [m/s] at which an arm is pushed out of an obstacle it starts in
  bool push_out = false;     ///< the arm starts inside an obstacle and is to be pushed out of it
  /// The drive of the arm engages its brakes where TickRecord::brakes says so. Without brakes the
  /// motors hold the weight for as long as a pose is known.
  bool has_brakes = false;
  double drive_delay = 0.0;  ///< [ticks] from a torque to its effect, beyond its being held for one
                             ///< tick; 0 to 100: the longer, the softer the arm follows
  bool prediction = true;    ///< false: the network is solved for the measured rates, without the
                             ///< mass of the arm, to compare with
  EnergyWatchOptions energy;    ///< of the energy that sampling adds
  FailsafeOptions failsafe;     ///< of the operator's force
  StopOptions stop;             ///< of braking
  JointTorqueOptions torques;   ///< of what is sent to the joints
  JointWatchOptions joints;     ///< of which readings are believed
  EntryBarrierOptions barrier;  ///< of hard walls
};

/// Returns `options`. @throws SetupError naming the one that is out of range
[[nodiscard]] const TeleoperatorOptions& checked(const TeleoperatorOptions& options);

}  // namespace repel
