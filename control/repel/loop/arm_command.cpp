// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arm_command.hpp>

#include <algorithm>
#include <cstddef>

#include <repel/loop/speed_share.hpp>
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
      torques_(model, period, options.torques),
      barrier_(model, period, options.drive_delay, options.torques.slew_time, pairs,
               options.barrier) {
  walls_.setZero(static_cast<Eigen::Index>(model.links.size()));
  asked_ = total_ = momenta_ = walls_;
  horizon_ = network::Prediction::horizon(options.drive_delay) * period;
  // What is sent takes the slew time and the delay of the drive to act, and the mass of the model
  // may be off.
  speed_horizon_ = (4.0 + 2.0 * options.drive_delay) * period + options.torques.slew_time;
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
  TorqueShares shares = shares_of(motion, watch, record);
  asked_ = robot->torques();
  walls_ = motion.network.walls();
  if (options_.is_remote) keep_speed(motion, inertia, shares, record);
  yield(motion, shares);
  bound_release(motion, inertia, shares.walls);
  // An arm that is pushed out of where it started, or held by its brakes, is not held by walls.
  const bool is_held = !record.brakes && (record.status & status::pushed_out) == 0U;
  if (!is_held) {
    const Status comes = barrier_.forget();
    if (record.brakes) record.status |= comes;
  }
  const Status found =
      torques_.compose(asked_, walls_, shares, motion.v, inertia, &barrier_, motion.probes);
  record.status |= found;
  record.held_force = barrier_.force();
  record.held_pair = barrier_.pushed();
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

TorqueShares ArmCommand::shares_of(const ArmMotion& motion, const JointWatch& watch,
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
  shares.brake = std::max({let_go ? 1.0 : 1.0 - record.gain, at_speed.brake, energy_watch_.brake(),
                           motion_watch_.brake()});
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

void ArmCommand::keep_speed(const ArmMotion& motion, const ArmInertia& inertia,
                            TorqueShares& shares, TickRecord& record) const noexcept {
  if (record.brakes || !(shares.operators * shares.drive > 0.0)) return;
  const double beyond = motion.tool_speed / options_.tool_speed - 1.0;
  shares.brake = std::max(shares.brake, std::clamp(beyond / 0.08, 0.0, 1.0));
  ArmInertia::Vector v = asked_;
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = motion.v[static_cast<std::size_t>(i)];
  const double share = share_within(motion.jacobian, v, shares.operators * (asked_ - walls_),
                                    inertia, speed_horizon_, options_.tool_speed);
  if (share >= shares.drive) return;
  shares.drive = share;
  record.status |= status::tool_speed;
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
  const auto less = motion.network.given_up(total_);
  asked_ = asked_ - less;
  walls_ = walls_ - less;
}

void ArmCommand::bound_release(const ArmMotion& motion, const ArmInertia& inertia,
                               double share) noexcept {
  if (!(share > 0.0)) return;
  inertia.momenta(motion.v, momenta_);
  double given = -motion.carried, power = 0.0, energy = 0.0;  // [W], [W] of all, [J] twice
  for (Eigen::Index i = 0; i < walls_.size(); ++i) {
    const double v = motion.v[static_cast<std::size_t>(i)];
    given += walls_.coeff(i) * v;
    power += total_.coeff(i) * v;
    energy += momenta_.coeff(i) * v;
  }
  if (!(given > 0.0 && energy > 0.0)) return;
  const double kept =
      release_share(motion.tool_speed, options_.tool_speed, horizon_ * power / energy);
  if (kept == 1.0) return;
  momenta_ *= (1.0 - kept) * given / energy;
  asked_ -= momenta_;
  walls_ -= momenta_;
}

}  // namespace repel
