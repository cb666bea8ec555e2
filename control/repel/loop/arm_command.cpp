// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arm_command.hpp>

#include <algorithm>
#include <cstddef>

#include <repel/network/machinery/prediction.hpp>
#include <repel/network/modules/puma_joints.hpp>

namespace repel {

ArmCommand::ArmCommand(const ArmModel& model, double period, const TeleoperatorOptions& options,
                       std::size_t pairs)
    : options_(options),
      failsafe_(options.failsafe),
      energy_watch_(period, options.energy),
      motion_watch_(period, out_of_phase),
      stop_control_(period, options.stop),
      torques_(model, period, options.torques, options.drive_delay),
      barrier_(model, period, options.drive_delay, options.torques.slew_time, pairs,
               options.barrier) {
  walls_.setZero(static_cast<Eigen::Index>(model.links.size()));
  asked_ = total_ = foreseen_ = walls_;
}

void ArmCommand::judge(TickRecord& record, const JointWatch& watch, ArmState state,
                       const network::Network& network, double elapsed) noexcept {
  const double sampled = network.find<network::PumaJoints>()->sampling_energy();
  record.status |= energy_watch_.step(sampled, elapsed);
  const Status late = watch_phase(watch, elapsed);
  record.status |= late;
  watch_drive(record, state, elapsed);
  if (is_poisoned_) record.status |= status::bad_torque;
  record.gain = failsafe_.step(record.status, elapsed);
  // Out of phase, the torques of walls and braking may be what drives the arm. Without brakes
  // there is nothing better.
  const bool drives = late != 0U && options_.has_brakes;
  const bool lost = (record.status & (status::blind | status::bad_pose)) != 0U || drives;
  record.stop = stop_control_.step(lost, watch.knows_nothing(), failsafe_.tripped(), elapsed);
  record.brakes = stop_control_.brakes();
}

void ArmCommand::drive(const ArmMotion& motion, const ArmInertia& inertia, JointWatch& watch,
                       TickRecord& record) noexcept {
  const auto* robot = motion.network.find<network::PumaJoints>();
  const TorqueShares shares = shares_of(watch, record, motion.tool_speed);
  asked_ = robot->torques();
  walls_ = motion.network.walls();
  yield(motion, shares);
  // An arm that is pushed out of where it started, or held by its brakes, is not held by walls.
  const bool is_held = !record.brakes && (record.status & status::pushed_out) == 0U;
  if (!is_held) {
    const Status comes = barrier_.forget();
    if (record.brakes) record.status |= comes;
  }
  const ToolSpeed tool{.jacobian = record.brakes ? nullptr : &motion.jacobian,
                       .limit = options_.tool_speed,
                       .is_carried = motion.carried > 0.0};
  const Status found = torques_.compose(
      asked_, walls_, shares, motion.v, inertia,
      {.barrier = &barrier_, .tool = tool, .probes = motion.probes, .q = motion.q});
  record.status |= found;
  record.held_force = barrier_.force();
  record.held_pair = barrier_.pushed();
  record.hold = barrier_.proof();
  is_poisoned_ = (found & status::bad_torque) != 0U;
  std::copy(torques_.torques().begin(), torques_.torques().end(), record.torques.begin());
  const bool held = options_.has_brakes && (record.brakes || !is_enabled_);
  watch.expect(torques_.net(), torques_.alone(), torques_.gravity(), torques_.expected_rate(),
               held);
}

bool ArmCommand::has_let_go() const noexcept {
  return failsafe_.tripped() && failsafe_.gain() == 0.0;
}

Status ArmCommand::watch_phase(const JointWatch& watch, double elapsed) noexcept {
  if (options_.joints.touches) return 0;
  if (watch.drive().strays()) motion_watch_.latch();
  const double error = 2.0 * (1.0 - 1.0 / options_.joints.mass_uncertainty);
  const MotionAccount& account = watch.account();
  return motion_watch_.step(account.gained(), elapsed, error * account.kinetic());
}

void ArmCommand::watch_drive(TickRecord& record, ArmState state, double elapsed) noexcept {
  is_enabled_ = state == ArmState::enabled;
  record.enable = false;
  if (is_enabled_) return;
  const bool is_sound = (record.status & status::failsafe) == 0U;
  stopped_for_ = is_sound ? stopped_for_ + elapsed : 0.0;
  record.status |= status::arm_stopped;
  if (state != ArmState::stopped || stopped_for_ < options_.failsafe.hold) return;
  stopped_for_ = 0.0;
  is_enabled_ = record.enable = true;
}

TorqueShares ArmCommand::shares_of(const JointWatch& watch, const TickRecord& record,
                                   double tool_speed) noexcept {
  const bool let_go = failsafe_.tripped();
  TorqueShares shares;
  shares.operators = record.brakes ? 0.0 : record.gain;
  shares.drive = let_go ? 0.0 : 1.0;
  shares.walls = record.brakes ? 0.0 : 1.0;
  if ((record.status & status::pushed_out) != 0U) shares.walls = exit_share(tool_speed);
  shares.friction = let_go ? 0.0 : record.gain;
  shares.brake =
      std::max({let_go ? 1.0 : 1.0 - record.gain, energy_watch_.brake(), motion_watch_.brake()});
  if (!options_.has_brakes) return without_brakes(shares, watch);
  if (record.brakes) shares.brake = 0.0;
  if (record.stop == Stop::released) shares.gravity = 0.0;
  return shares;
}

double ArmCommand::exit_share(double speed) noexcept {
  exit_share_ += speed < options_.exit_speed ? 0.005 : -0.02;
  return exit_share_ = std::clamp(exit_share_, 0.0, 1.0);
}

TorqueShares ArmCommand::without_brakes(TorqueShares shares, const JointWatch& watch) noexcept {
  if (watch.knows_nothing()) shares.gravity = 0.0;
  return shares;
}

void ArmCommand::yield(const ArmMotion& motion, const TorqueShares& shares) noexcept {
  double power = 0.0;  // of the operator [W]
  for (Eigen::Index i = 0; i < walls_.size(); ++i) {
    power += (asked_.coeff(i) - walls_.coeff(i)) * motion.v[static_cast<std::size_t>(i)];
  }
  const double share = shares.operators * (power > 0.0 ? shares.drive : 1.0);
  for (Eigen::Index i = 0; i < walls_.size(); ++i) {
    // A contribution of share zero may be NaN.
    total_.coeffRef(i) = shares.walls > 0.0 ? shares.walls * walls_.coeff(i) : 0.0;
    if (share > 0.0) total_.coeffRef(i) += share * (asked_.coeff(i) - walls_.coeff(i));
  }
  foreseen_ = motion.network.foreseen(total_);
  const auto less = motion.network.given_up(foreseen_);
  asked_ = asked_ - less;
  walls_ = walls_ - less;
}

}  // namespace repel
