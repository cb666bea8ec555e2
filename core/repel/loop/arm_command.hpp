/// @file
/// From what the network gives and what is wrong to what the arm is told.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <repel/loop/arm_bodies.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/failsafe.hpp>
#include <repel/loop/joint_torques.hpp>
#include <repel/loop/joint_watch.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/record.hpp>
#include <repel/loop/speed_share.hpp>
#include <repel/loop/stop_control.hpp>
#include <repel/network/network.hpp>
#include <repel/network/puma_joints.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// What a tick has found out about the motion and the forces of an arm.
struct ArmMotion {
  const network::Network& network;    ///< solved
  const network::Jacobian& jacobian;  ///< of the tool
  const std::vector<double>& v;       ///< [rad/s] of the joints
  double tool_speed = 0.0;            ///< [m/s]
};

/// Decides on the stop, shares out the torques, and tells the arm: torques, brakes, enable. All
/// memory is taken at construction.
template <TorqueDrivenArm Arm>
class ArmCommand {
 public:
  /// @param arm kept by reference; @throws SetupError for an option out of range
  ArmCommand(const ArmModel& model, Arm& arm, double period, const TeleoperatorOptions& options)
      : options_(options),
        arm_(arm),
        failsafe_(options.failsafe),
        stop_control_(period, options.stop),
        torques_(model, period, options.torques) {
    walls_.setZero(static_cast<Eigen::Index>(model.links.size()));
  }

  /// From the status of the tick to gain, stop and brakes, in `record`. @param elapsed [s]
  void judge(TickRecord& record, const JointWatch& watch, double elapsed) noexcept {
    mind_arm(record, elapsed);
    if (is_poisoned_) record.status |= status::bad_torque;
    record.gain = failsafe_.step(record.status, elapsed);
    const bool lost = (record.status & (status::blind | status::bad_pose)) != 0U;
    record.stop = stop_control_.step(lost, watch.knows_nothing(), failsafe_.tripped(), elapsed);
    record.brakes = stop_control_.brakes();
  }

  /// Where gravity torques are to be written before `drive` [N m].
  [[nodiscard]] std::span<double> gravity() noexcept { return torques_.gravity(); }

  /// Tells the arm what `record` asks for.
  void drive(const ArmMotion& motion, const ArmInertia& inertia, JointWatch& watch,
             TickRecord& record) noexcept {
    gather_walls(motion);
    const auto* robot = motion.network.find<network::PumaJoints>();
    const TorqueShares shares = shares_of(motion, watch, record);
    const Status found = torques_.compose(robot->torques(), walls_, shares, motion.v, inertia);
    record.status |= found;
    is_poisoned_ = (found & status::bad_torque) != 0U;
    arm_.set_torques(torques_.torques());
    bool held = false;
    if constexpr (BrakedArm<Arm>) {
      arm_.engage_brakes(record.brakes);
      held = record.brakes || arm_.state() != ArmState::enabled;
    }
    watch.expect(torques_.net(), torques_.gravity(), torques_.expected_rate(), held);
  }

  [[nodiscard]] const std::vector<double>& torques() const noexcept {  ///< [N m] sent
    return torques_.torques();
  }
  /// The operator's force has gone down to nothing.
  [[nodiscard]] bool has_let_go() const noexcept {
    return failsafe_.tripped() && failsafe_.gain() == 0.0;
  }
  /// Of what pushes the arm out of where it starts, nothing is held back any more.
  [[nodiscard]] bool pushes_out_whole() const noexcept { return exit_share_ >= 1.0; }
  /// The last torques were no numbers: all memories begin anew.
  [[nodiscard]] bool is_poisoned() const noexcept { return is_poisoned_; }

 private:
  // An arm that stopped by itself is enabled again once nothing else has been wrong for a while.
  void mind_arm(TickRecord& record, double elapsed) noexcept {
    if constexpr (BrakedArm<Arm>) {
      if (arm_.state() == ArmState::enabled) return;
      const bool is_sound = (record.status & status::failsafe) == 0U;
      stopped_for_ = is_sound ? stopped_for_ + elapsed : 0.0;
      record.status |= status::arm_stopped;
      if (arm_.state() != ArmState::stopped || stopped_for_ < options_.failsafe.hold) return;
      stopped_for_ = 0.0;
      arm_.enable();
    }
  }

  [[nodiscard]] TorqueShares shares_of(const ArmMotion& motion, const JointWatch& watch,
                                       TickRecord& record) noexcept {
    const bool let_go = failsafe_.tripped();
    const SpeedShare at_speed = speed_share(motion.tool_speed, options_.tool_speed);
    if (at_speed.drive < 1.0 && !let_go) record.status |= status::tool_speed;
    TorqueShares shares;
    shares.operators = record.brakes ? 0.0 : record.gain;
    shares.drive = let_go ? 0.0 : at_speed.drive;
    shares.walls = record.brakes ? 0.0 : 1.0;
    if ((record.status & status::pushed_out) != 0U) shares.walls = exit_share(motion.tool_speed);
    shares.friction = let_go ? 0.0 : record.gain;
    shares.brake = std::max(let_go ? 1.0 : 1.0 - record.gain, at_speed.brake);
    if (!BrakedArm<Arm>) return without_brakes(shares, watch);
    if (record.brakes) shares.brake = 0.0;
    if (record.stop == Stop::released) shares.gravity = 0.0;
    return shares;
  }

  // Of walls that push an arm out of what it starts in: from none up until it moves, and less again
  // where it is too fast.
  [[nodiscard]] double exit_share(double speed) noexcept {
    exit_share_ += speed < options_.exit_speed ? 0.005 : -0.02;
    return exit_share_ = std::clamp(exit_share_, 0.0, 1.0);
  }

  // Nothing but the motors holds the weight, as long as a pose is known.
  [[nodiscard]] static TorqueShares without_brakes(TorqueShares shares,
                                                   const JointWatch& watch) noexcept {
    if (watch.knows_nothing()) shares.gravity = 0.0;
    return shares;
  }

  // What walls and limits give, of all that the network sends to the joints.
  void gather_walls(const ArmMotion& motion) noexcept {
    walls_.setZero();
    for (const network::Node& node : motion.network.nodes()) {
      node.module->add_walls(motion.jacobian, walls_);
    }
  }

  TeleoperatorOptions options_;
  Arm& arm_;
  Failsafe failsafe_;
  StopControl stop_control_;
  JointTorques torques_;
  network::Vec<network::any_size> walls_;  // [N m] of walls and limits on the joints
  double exit_share_ = 0.0;
  bool is_poisoned_ = false;
  double stopped_for_ = 0.0;  // [s] the arm by itself, with nothing else wrong
};

}  // namespace repel
