// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From the output of the network and the faults of a tick to the command of the arm.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/barrier/entry_barrier.hpp>
#include <repel/loop/joint_torques.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/record.hpp>
#include <repel/loop/watch/energy_watch.hpp>
#include <repel/loop/watch/failsafe.hpp>
#include <repel/loop/watch/joint_watch.hpp>
#include <repel/loop/watch/stop_control.hpp>
#include <repel/network/network.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Motion and forces of an arm, as determined in this tick.
struct ArmMotion {
  const network::Network& network;    ///< solved
  const network::Jacobian& jacobian;  ///< of the tool
  const std::vector<double>& q;       ///< [rad] of the joints
  const std::vector<double>& v;       ///< [rad/s] likewise
  std::span<const double> probes;     ///< [N m] of joints that may be frozen (JointWatch::probe)
  double tool_speed = 0.0;            ///< [m/s]
  double carried = 0.0;               ///< [W] from moving walls
};

/// Decides on the stop and composes the joint torques; the command of the arm is in the record.
/// Allocates at construction only.
class ArmCommand {
 public:
  /// @throws SetupError for an option out of range
  /// @param pairs of the world
  ArmCommand(const ArmModel& model, double period, const TeleoperatorOptions& options,
             std::size_t pairs = 0);

  /// Derives gain, stop, brakes and enable from the status of the tick, all in `record`.
  /// @param state of the drive of the arm; @param network solved; @param elapsed [s]
  [[gnu::noinline]] void judge(TickRecord& record, const JointWatch& watch, ArmState state,
                               const network::Network& network, double elapsed) noexcept;

  /// The barrier before hard walls: takes its contacts before `drive`.
  [[nodiscard]] EntryBarrier& barrier() noexcept { return barrier_; }
  /// What keeps the arm out of hard walls.
  [[nodiscard]] const EntryBarrier& barrier() const noexcept { return barrier_; }

  /// Buffer for the gravity torques, to be filled before `drive` [N m].
  [[nodiscard]] std::span<double> gravity() noexcept { return torques_.gravity(); }

  /// Writes the command of the arm to `record`.
  void drive(const ArmMotion& motion, const ArmInertia& inertia, JointWatch& watch,
             TickRecord& record) noexcept;

  /// The operator's force has been ramped down to zero.
  [[nodiscard]] bool has_let_go() const noexcept;
  /// The ramp of the walls pushing the arm out of its start position is complete.
  [[nodiscard]] bool pushes_out_whole() const noexcept { return exit_share_ >= 1.0; }
  /// [N m] Sent in the last tick, without the weight.
  [[nodiscard]] const network::Vec<network::any_size>& sent() const noexcept {
    return torques_.net();
  }
  /// [rad/s] Change of the rates expected from the torques asked for in the last tick.
  [[nodiscard]] const network::Vec<network::any_size>& foreseen() const noexcept {
    return foreseen_;
  }
  /// The last torques were not finite: all states are to be reset.
  [[nodiscard]] bool is_poisoned() const noexcept { return is_poisoned_; }

 private:
  // Beyond the error of the kinetic energy, an arm that follows its torques gains next to nothing.
  static constexpr EnergyWatchOptions out_of_phase{
      .taken_back = 0.1, .most = 0.2, .memory = 1.0, .latch = 3.0};

  // Unmodelled objects may move an arm touching them.
  [[nodiscard]] Status watch_phase(const JointWatch& watch, double elapsed) noexcept;

  // A drive that stopped by itself is enabled again after FailsafeOptions::hold without other
  // faults.
  void watch_drive(TickRecord& record, ArmState state, double elapsed) noexcept;

  [[nodiscard]] TorqueShares shares_of(const JointWatch& watch, const TickRecord& record,
                                       double tool_speed) noexcept;

  // Share of the walls pushing an arm out of its start position: ramped up from zero while the tool
  // is below exit_speed, down while above.
  [[nodiscard]] double exit_share(double speed) noexcept;

  // Without brakes the motors alone hold the weight, as long as a pose is known.
  [[nodiscard]] static TorqueShares without_brakes(TorqueShares shares,
                                                   const JointWatch& watch) noexcept;

  // Subtracts the share of the wall torques that the predicted motion cancels.
  void yield(const ArmMotion& motion, const TorqueShares& shares) noexcept;

  TeleoperatorOptions options_;
  Failsafe failsafe_;
  EnergyWatch energy_watch_;  // by sampling
  EnergyWatch motion_watch_;  // by torques acting later than told
  StopControl stop_control_;
  JointTorques torques_;
  EntryBarrier barrier_;
  network::Vec<network::any_size> walls_;     // [N m] of walls and limits on the joints
  network::Vec<network::any_size> asked_;     // [N m] of the whole network
  network::Vec<network::any_size> total_;     // [N m] the part of it sent
  network::Vec<network::any_size> foreseen_;  // [rad/s] expected change of the rates by it
  double exit_share_ = 0.0;
  bool is_poisoned_ = false;
  bool is_enabled_ = true;    // the drive of the arm
  double stopped_for_ = 0.0;  // [s] the drive was stopped, with no other fault
};

}  // namespace repel
