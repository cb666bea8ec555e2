/// @file
/// The straight line: everything that happens in one tick, in the order it happens.
#pragma once

#include <chrono>
#include <cmath>
#include <span>
#include <vector>

#include <repel/loop/failsafe.hpp>
#include <repel/loop/record.hpp>
#include <repel/network/coupling.hpp>
#include <repel/network/friction.hpp>
#include <repel/network/joint_limits.hpp>
#include <repel/network/operator.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// A teleoperator: an operator, a coupling, a world model and an arm. It keeps references to what
/// it is built from; all memory is taken at construction.
template <TorqueDrivenArm Arm, ArmKinematics Kinematics>
class Teleoperator {
 public:
  Teleoperator(const ArmModel& model, Arm& arm, Kinematics& kinematics, World& world, BodyId tool,
               Coprocessor& coprocessor, network::ScriptedOperator& the_operator,
               const network::CouplingGains& gains, std::chrono::nanoseconds period)
      : model_(model),
        arm_(arm),
        kinematics_(kinematics),
        world_(world),
        tool_(tool),
        coprocessor_(coprocessor),
        operator_(the_operator),
        coupling_(gains),
        period_(std::chrono::duration<double>(period).count()),
        q_(model.links.size()),
        v_(model.links.size()),
        new_q_(model.links.size()),
        new_v_(model.links.size()),
        torques_(model.links.size()),
        jacobian_(Jacobian::Zero(6, static_cast<Eigen::Index>(model.links.size()))),
        new_jacobian_(jacobian_) {
    begin_tick({});
    read_joints();
    place_tool();
    coupling_.reset(X_WT_);
  }

  /// One tick. @param now the time it is due [ns]; it must grow from tick to tick
  const TickRecord& tick(std::chrono::nanoseconds now) noexcept {
    begin_tick(now);                                    // clock -> status
    read_joints();                                      // arm -> q, v
    place_tool();                                       // q, v -> X_WT, V_WT in the world
    const Wrench walls = push_away();                   // world -> virtual force on the tool
    const Twist wanted = ask_operator(coupled_.force);  // what is felt -> commanded twist
    coupled_ = couple(wanted);                          // commanded twist -> coupling force
    const double gain =
        failsafe_.step(record_.status, period_);  // status -> share of force allowed
    drive(gain * (walls + coupled_));             // force on the tool -> joint torques
    finish_tick(walls, gain);                     // everything -> record
    return record_;
  }

  /// Brings the code and the data of the next tick into the caches and changes nothing. For the
  /// moment before it is due: a tick that begins cold takes several times as long.
  void rehearse() noexcept {
    kinematics_.update(q_);
    kinematics_.tool_jacobian(new_jacobian_);
    kinematics_.gravity_torques(torques_);
    coprocessor_.rehearse();
  }

 private:
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  void begin_tick(std::chrono::nanoseconds now) noexcept {
    record_.status = now > last_now_ ? 0U : status::clock_fault;
    last_now_ = now;
  }

  void read_joints() noexcept {
    arm_.read_positions(new_q_);
    arm_.read_velocities(new_v_);
    double zero = 0.0;
    for (std::size_t i = 0; i < q_.size(); ++i) {
      zero += (new_q_[i] - new_q_[i]) + (new_v_[i] - new_v_[i]);
    }
    if (zero == 0.0) {
      q_.swap(new_q_);
      v_.swap(new_v_);
    } else {
      record_.status |= status::bad_joints;
    }
  }

  void place_tool() noexcept {
    kinematics_.update(q_);
    kinematics_.tool_jacobian(new_jacobian_);
    const Pose X_WT = kinematics_.X_WT();
    Twist V_WT;
    for (std::size_t i = 0; i < v_.size(); ++i) {
      const auto column = new_jacobian_.col(static_cast<Eigen::Index>(i));
      V_WT.linear += v_[i] * column.template head<3>();
      V_WT.angular += v_[i] * column.template tail<3>();
    }
    world_.motion().tick = next_tick_;
    if (world_.place(tool_, X_WT, V_WT)) {
      X_WT_ = X_WT;
      V_WT_ = V_WT;
      jacobian_.swap(new_jacobian_);
    } else {
      record_.status |= status::bad_pose;
    }
  }

  [[nodiscard]] Wrench push_away() noexcept {
    const PairForces& forces = coprocessor_.exchange();
    record_.pairs = forces.totals;
    record_.workers = coprocessor_.workers();
    if (coprocessor_.late()) record_.status |= status::late_result;
    if (forces.totals.stale > 0) record_.status |= status::stale_pairs;
    if (forces.totals.crowded > 0) record_.status |= status::crowded_pairs;
    if (forces.totals.expired > 0) record_.status |= status::expired_pairs;
    return forces.on_body[tool_.index];
  }

  // The master feels the coupling's force of the last period, turned round.
  [[nodiscard]] Twist ask_operator(const Vec3& on_tool_W) noexcept {
    const network::Command command = operator_.step(X_WT_.linear(), -on_tool_W, period_);
    if (!command.sound) record_.status |= status::bad_command;
    return command.twist;
  }

  [[nodiscard]] Wrench couple(const Twist& wanted) noexcept {
    // After a fault the command begins where the tool is, not where it was left.
    if (failsafe_.tripped()) coupling_.reset(X_WT_);
    return coupling_.step(wanted, X_WT_, V_WT_, period_);
  }

  // tau = g(q) + J'F + dry friction + joint limits, cut to what each joint can give.
  void drive(const Wrench& on_tool) noexcept {
    kinematics_.gravity_torques(torques_);
    for (std::size_t i = 0; i < torques_.size(); ++i) {
      const ArmLink& link = model_.links[i];
      const auto column = jacobian_.col(static_cast<Eigen::Index>(i));
      const double asked = column.template head<3>().dot(on_tool.force) +
                           column.template tail<3>().dot(on_tool.torque);
      torques_[i] += asked + friction_(link.coulomb_friction, v_[i], asked) +
                     limits_(q_[i], v_[i], link.lower, link.upper);
      const double most = link.effort_limit > 0.0 ? link.effort_limit : 1e9;
      if (!(std::abs(torques_[i]) <= most)) {
        record_.status |= status::torque_limit;
        torques_[i] = std::isnan(torques_[i]) ? 0.0 : std::clamp(torques_[i], -most, most);
      }
    }
    arm_.set_torques(torques_);
  }

  void finish_tick(const Wrench& walls, double gain) noexcept {
    record_.tick = next_tick_++;
    record_.time = period_ * static_cast<double>(record_.tick);
    record_.phase = static_cast<std::int32_t>(operator_.phase());
    record_.p_WT = X_WT_.translation();
    record_.v_WT = V_WT_.linear;
    record_.virtual_force = walls;
    record_.coupling = coupled_;
    record_.lever_torque = operator_.lever().felt();
    record_.gain = gain;
  }

  const ArmModel& model_;
  Arm& arm_;
  Kinematics& kinematics_;
  World& world_;
  BodyId tool_;
  Coprocessor& coprocessor_;
  network::ScriptedOperator& operator_;
  network::Coupling coupling_;
  network::JointLimits limits_;
  network::FrictionCompensation friction_;
  Failsafe failsafe_;
  double period_;                              ///< [s]
  std::vector<double> q_, v_, new_q_, new_v_;  ///< [rad], [rad/s]
  std::vector<double> torques_;                ///< [N m]
  Jacobian jacobian_, new_jacobian_;
  Pose X_WT_ = Pose::Identity();
  Twist V_WT_;
  Wrench coupled_;
  TickRecord record_;
  std::int64_t next_tick_ = 0;
  std::chrono::nanoseconds last_now_ = std::chrono::nanoseconds::min();
};

}  // namespace repel
