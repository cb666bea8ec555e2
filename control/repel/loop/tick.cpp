// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/tick.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <repel/loop/arms/held_weight.hpp>
#include <repel/network/modules/limits.hpp>
#include <repel/network/modules/obstacle.hpp>
#include <repel/network/modules/puma_kin.hpp>

namespace repel::detail {

void copy_readings(std::span<const double> from, std::vector<double>& to) noexcept {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = i < from.size() ? from[i] : std::numeric_limits<double>::quiet_NaN();
  }
}

void pass_wrench(const std::optional<Wrench>& reading, const network::ForceSensor& sensor,
                 network::Signals& signals) noexcept {
  signals.is_measured = reading.has_value() && is_finite(*reading);
  signals.measured = signals.is_measured ? *reading : Wrench{};
  signals.inertia *= 1.0 / (1.0 + sensor.gain());
}

}  // namespace repel::detail

namespace repel {

Teleoperator::Teleoperator(TeleoperatorParts parts, std::chrono::nanoseconds period,
                           const TeleoperatorOptions& options)
    : options_((require_complete(parts), checked(options))),
      kinematics_(parts.kinematics),
      world_(parts.world),
      tool_(parts.tool),
      links_(joined(world_, tool_, parts.links), static_cast<int>(parts.model.links.size())),
      network_(std::move(parts.network)),
      sensor_(network_.find<network::ForceSensor>()),
      clock_(period, in_nanoseconds(options.longest_gap)),
      period_(std::chrono::duration<double>(period).count()),
      gravity_W_(parts.model.gravity_W),
      watch_(parts.model, period_, options.joints, options.drive_delay),
      kinematics_watch_(effort_bounds(parts.model)),
      inertia_(parts.model),
      command_(parts.model, period_, options, has_hard(world_) ? world_.pairs().size() : 0),
      q_(parts.model.links.size()),
      v_(q_),
      untold_(q_),
      probes_(q_),
      read_q_(q_),
      read_v_(q_),
      jacobian_(Jacobian::Zero(6, static_cast<Eigen::Index>(q_.size()))),
      new_jacobian_(jacobian_),
      flow_(static_cast<int>(q_.size())),
      pushing_out_(options.push_out) {
  const network::Node* at = network_.node_of<network::Obstacle>();
  if (at == nullptr) at = network_.node_of<network::PumaKin>();
  before_walls_ = at == nullptr ? -1 : at->left;
  lever_scales_ = lever_scales(network_);
  signals_.period = signals_.elapsed = period_;
  (void)inertia_.update(kinematics_);
}

void Teleoperator::sense(const ArmReadings& readings, std::chrono::nanoseconds now) noexcept {
  if (next_tick_ == 0) begin(readings);
  begin_tick(now);        // clock -> status
  read_joints(readings);  // arm -> q, v
  place_bodies();         // q, v -> poses and twists of tool and links in the world
}

const TickRecord& Teleoperator::act(const PairForces& forces, const WorkerReport& workers,
                                    const Contacts& contacts,
                                    const network::Command& command) noexcept {
  push_away(forces, workers);   // world -> virtual forces on tool and links
  damp_walls(contacts.active);  // what the implicit solution of the network needs of them
  command_.barrier().watch(contacts, tool_, jacobian_, links_, q_, v_, untold_);
  follow(command);  // operator's input
  run_network();    // operator's input, walls, joint rates -> torques
  command_.judge(record_, watch_, drive_state_, network_, signals_.elapsed);  // -> stop
  drive();                                                                    // torques for the arm
  finish_tick();  // everything -> record
  return record_;
}

void Teleoperator::rehearse() noexcept {
  kinematics_.update(q_);
  kinematics_.tool_jacobian(new_jacobian_);
  kinematics_.gravity_torques(command_.gravity());
}

void Teleoperator::begin(const ArmReadings& readings) noexcept {
  read_joints(readings);
  place_bodies();
  flow_.reset(joints_vec(q_));
}

void Teleoperator::begin_tick(std::chrono::nanoseconds now) noexcept {
  record_.status = clock_.step(now);
  record_.elapsed = clock_.elapsed();
  signals_.elapsed = period_ * static_cast<double>(clock_.elapsed());
  // The arm moved on without the loop: readings need not follow from the last ones.
  if ((record_.status & status::clock_gap) == 0U && next_tick_ != 0) return;
  watch_.begin_anew();
  inertia_.begin_anew();
}

void Teleoperator::read_joints(const ArmReadings& readings) noexcept {
  detail::copy_readings(readings.q, read_q_);
  detail::copy_readings(readings.v, read_v_);
  drive_state_ = readings.state;
  if (sensor_ != nullptr) record_.wrench_read = readings.wrench;
  if (drive_state_ != ArmState::enabled) watch_.hold();
  if (readings.homed) watch_.confirm();
  record_.status |= watch_.step(read_q_, read_v_, signals_.elapsed, inertia_.matrix());
  for (std::size_t i = 0; i < q_.size(); ++i) {
    q_[i] = watch_.position(i);
    v_[i] = watch_.rate(i);
    untold_[i] = watch_.untold_rate(i);
    probes_[i] = watch_.probe(i);
  }
}

void Teleoperator::place_bodies() noexcept {
  kinematics_.update(q_);
  kinematics_.tool_jacobian(new_jacobian_);
  const Pose X_WT = kinematics_.X_WT();
  const Twist V_WT = twist_through(new_jacobian_, v_);
  world_.motion().tick = next_tick_;
  bool is_sound = kinematics_watch_.agrees(q_, X_WT, new_jacobian_);
  is_sound = is_sound && world_.place(tool_, X_WT, V_WT);
  if (is_sound) {
    X_WT_ = X_WT;
    V_WT_ = V_WT;
    jacobian_.swap(new_jacobian_);
    kinematics_watch_.keep(q_, X_WT_, jacobian_);
    is_sound = inertia_.update(kinematics_);
  }
  kinematics_.gravity_torques(command_.gravity());
  is_sound = kinematics_watch_.believe(q_, command_.gravity()) && is_sound;
  is_sound = links_.place(world_, kinematics_, v_) && is_sound;
  if (!is_sound) record_.status |= status::bad_pose;
}

void Teleoperator::push_away(const PairForces& forces, const WorkerReport& workers) noexcept {
  record_.pairs = forces.totals;
  record_.workers = workers;
  if (workers.stood_in > 0) record_.status |= status::late_result;
  if (forces.totals.stale > 0) record_.status |= status::stale_pairs;
  if (forces.totals.crowded > 0) record_.status |= status::crowded_pairs;
  if (forces.totals.expired > 0) record_.status |= status::expired_pairs;
  signals_.walls = record_.virtual_force = forces.on_body[tool_.index];
  record_.virtual_force += forces.from_own[tool_.index];
  links_.gather(forces, tool_, jacobian_, signals_.arm_torques);
  signals_.walls_power = forces.carried[tool_.index];
  signals_.arm_power = links_.carried(forces);
  if (pushing_out_) push_out(forces.totals);
}

void Teleoperator::damp_walls(std::span<const ActiveContact> contacts) noexcept {
  gather_damping(contacts, tool_, jacobian_, links_, signals_.wall_damping);
  const Wrench turning =
      damp_turning(contacts, tool_, jacobian_, V_WT_.angular,
                   {inertia_.matrix(), period_, options_.drive_delay}, signals_.wall_damping);
  signals_.walls += turning;
  record_.virtual_force += turning;
}

void Teleoperator::push_out(const PairTotals& totals) noexcept {
  constexpr double lever = 0.5;  // [m] lever arm of a wall force about a joint
  const bool is_felt = totals.peak_force > 0.0;
  if (totals.nearest > 0.0 && (!is_felt || command_.pushes_out_whole())) {
    pushing_out_ = false;
    return;
  }
  record_.status |= status::pushed_out;
  signals_.walls_power += options_.exit_speed * signals_.walls.force.norm();
  signals_.arm_power += options_.exit_speed / lever * signals_.arm_torques.norm();
}

void Teleoperator::follow(const network::Command& command) noexcept {
  record_.command = command;
  const bool is_sound = rest_unless_finite(record_.command.hand, signals_.hand);
  if (!rest_unless_finite(record_.command.second, signals_.second) || !is_sound) {
    record_.command.sound = false;
  }
  if (!record_.command.sound) record_.status |= status::bad_command;
  if (command.is_silent(patience)) record_.status |= status::silent_device;
  signals_.hand = record_.command.hand;
  signals_.second = record_.command.second;
  if (cut_to_speed(signals_, options_.tool_speed, lever_scales_)) {
    record_.status |= status::saturated;
  }
}

void Teleoperator::run_network() noexcept {
  const auto begin = std::chrono::steady_clock::now();
  // Without the operator's force, springs and accounts of that side restart at this pose.
  signals_.released = record_.stop == Stop::released || command_.is_poisoned();
  signals_.at_rest = command_.has_let_go() || signals_.released;
  signals_.joints = joints_vec(q_);
  // What moved the arm while the loop stood was not the network.
  if (signals_.released || (record_.status & status::clock_gap) != 0U) {
    flow_.reset(signals_.joints);
  } else {
    flow_.step(signals_.joints, joints_vec(v_), period_, signals_.elapsed);
  }
  signals_.rates = flow_.flow();
  signals_.mean_rates = flow_.mean();
  signals_.sent = command_.sent();
  signals_.foreseen = command_.foreseen();
  signals_.jacobian = jacobian_;
  signals_.inertia = inertia_.matrix();
  signals_.X_WT = X_WT_;
  if (sensor_ != nullptr) detail::pass_wrench(record_.wrench_read, *sensor_, signals_);
  if (!network_.run(signals_)) record_.status |= status::network_fault;
  note_limits();
  record_.network_time = std::chrono::steady_clock::now() - begin;
}

void Teleoperator::note_limits() noexcept {
  for (const network::Node& node : network_.nodes()) {
    if (node.module->saturated()) record_.status |= status::saturated;
  }
  const auto* limits = network_.find<network::Limits>();
  if (limits != nullptr && limits->active()) record_.status |= status::joint_limit;
  if (sensor_ != nullptr && sensor_->is_lost()) record_.status |= status::bad_wrench;
  note_masters(network_, record_);
}

void Teleoperator::drive() noexcept {
  add_held_weight(world_, tool_, jacobian_, gravity_W_, Masses::known, command_.gravity());
  const double carried = signals_.walls_power + signals_.arm_power;
  command_.drive({network_, signals_.jacobian, q_, v_, probes_, V_WT_.linear.norm(), carried},
                 inertia_, watch_, record_);
}

void Teleoperator::finish_tick() noexcept {
  record_.tick = next_tick_++;
  if (record_.tick > 0) periods_ += record_.elapsed;
  record_.time = period_ * static_cast<double>(periods_);
  record_.phase = record_.command.phase;
  std::copy(q_.begin(), q_.end(), record_.q.begin());
  std::copy(v_.begin(), v_.end(), record_.v.begin());
  std::copy(read_q_.begin(), read_q_.end(), record_.q_read.begin());
  std::copy(read_v_.begin(), read_v_.end(), record_.v_read.begin());
  record_.p_WT = origin(X_WT_);
  record_.v_WT = V_WT_.linear;
  record_.coupling = before_walls_ < 0
                         ? Wrench{}
                         : network::to_wrench(network_.connection(before_walls_).effort());
  std::size_t module = 0;
  for (const network::Node& node : network_.nodes()) {
    record_.energy[module++] = static_cast<float>(node.ledger.energy);
  }
}

Eigen::Map<const network::Vec<network::any_size>> Teleoperator::joints_vec(
    const std::vector<double>& values) noexcept {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace repel
