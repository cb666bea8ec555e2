// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The control of one arm: everything that happens in one tick, in the order it happens.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/loop/arm_command.hpp>
#include <repel/loop/arms/arm_bodies.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/barrier/hard_contacts.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/record.hpp>
#include <repel/loop/teleoperator_parts.hpp>
#include <repel/loop/tick_clock.hpp>
#include <repel/loop/watch/hand_speed.hpp>
#include <repel/loop/watch/kinematics_watch.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/modules/force_sensor.hpp>
#include <repel/network/modules/puma_joints.hpp>
#include <repel/network/operator.hpp>
#include <repel/schedule/pair_forces.hpp>
#include <repel/world/arm_kinematics.hpp>

namespace repel {

namespace detail {

/// Copies the readings `from` an arm; missing entries read as NaN.
void copy_readings(std::span<const double> from, std::vector<double>& to) noexcept;

/// Gives a network with a force sensor its reading, and the inertia of the arm in `signals` as the
/// modules on its left move it.
void pass_wrench(const std::optional<Wrench>& reading, const network::ForceSensor& sensor,
                 network::Signals& signals) noexcept;

}  // namespace detail

/// The control of one arm: from joint readings, the forces of the world and the operator's input,
/// through a network, to joint torques. Allocates at construction only. A cell has one per arm.
class Teleoperator {
 public:
  /// Timeout of an operator's device [s].
  static constexpr double patience = 0.02;

  /// @throws SetupError for a network that does not fit (`require_complete`), or an option
  Teleoperator(TeleoperatorParts parts, std::chrono::nanoseconds period,
               const TeleoperatorOptions& options = {});

  /// The first half of a tick: places the arm in the world. When all arms of a world have done
  /// this, one exchange of the coprocessor computes the forces for the second half.
  /// @param readings of the arm for this tick @param now the time the tick is due [ns]; it must
  /// grow from tick to tick
  void sense(const ArmReadings& readings, std::chrono::nanoseconds now) noexcept;

  /// The second half: writes the command of the arm to the record. @param forces of the world in
  /// which all arms have been placed, and the `contacts` they are of
  const TickRecord& act(const PairForces& forces, const WorkerReport& workers,
                        const Contacts& contacts, const network::Command& command) noexcept;

  /// The network, as of the last tick.
  [[nodiscard]] const network::Network& network() const noexcept { return network_; }
  /// What keeps the arm out of hard walls.
  [[nodiscard]] const EntryBarrier& barrier() const noexcept { return command_.barrier(); }
  /// Pose of the tool in the world [m], as of the last `sense`.
  [[nodiscard]] const Pose& X_WT() const noexcept { return X_WT_; }
  /// Time since the last tick, as of the last `sense` [s].
  [[nodiscard]] double elapsed() const noexcept { return signals_.elapsed; }

  /// Warms the caches for the next tick, without other effects. Call it just before it is due.
  void rehearse() noexcept;

 private:
  void begin(const ArmReadings& readings) noexcept;

  [[gnu::noinline]] void begin_tick(std::chrono::nanoseconds now) noexcept;

  [[gnu::noinline]] void read_joints(const ArmReadings& readings) noexcept;

  [[gnu::noinline]] void place_bodies() noexcept;

  [[gnu::noinline]] void push_away(const PairForces& forces, const WorkerReport& workers) noexcept;
  void damp_walls(std::span<const ActiveContact> contacts) noexcept;

  // Credits the walls with the power of an arm that leaves at exit_speed.
  void push_out(const PairTotals& totals) noexcept;

  [[gnu::noinline]] void follow(const network::Command& command) noexcept;

  [[gnu::noinline]] void run_network() noexcept;

  void note_limits() noexcept;

  [[gnu::noinline]] void drive() noexcept;

  [[gnu::noinline]] void finish_tick() noexcept;

  [[nodiscard]] static Eigen::Map<const network::Vec<network::any_size>> joints_vec(
      const std::vector<double>& values) noexcept;

  TeleoperatorOptions options_;
  ArmKinematics& kinematics_;
  World& world_;
  BodyId tool_;
  ArmBodies links_;
  network::Network network_;
  const network::ForceSensor* sensor_;  // in it; null: none
  TickClock clock_;
  double period_;   ///< [s]
  Vec3 gravity_W_;  ///< [m/s^2]
  JointWatch watch_;
  KinematicsWatch kinematics_watch_;
  ArmInertia inertia_;
  ArmCommand command_;
  std::vector<double> q_, v_, untold_;   ///< [rad], [rad/s], [rad/s]
  std::vector<double> probes_;           ///< [N m]
  std::vector<double> read_q_, read_v_;  ///< [rad], [rad/s]
  Jacobian jacobian_, new_jacobian_;
  Pose X_WT_ = Pose::Identity();
  Twist V_WT_;
  ArmState drive_state_ = ArmState::enabled;
  network::MeasuredFlow flow_;
  network::Signals signals_;
  int before_walls_ = -1;  // connection over which the operator's side acts on the tool
  LeverScales lever_scales_;
  bool pushing_out_;
  TickRecord record_;
  std::int64_t next_tick_ = 0;
  std::int64_t periods_ = 0;  ///< since the first tick
};

}  // namespace repel
