/// @file
/// The straight line: everything that happens in one tick, in the order it happens.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <vector>

#include <repel/loop/arm_bodies.hpp>
#include <repel/loop/failsafe.hpp>
#include <repel/loop/joint_speed.hpp>
#include <repel/loop/record.hpp>
#include <repel/network/friction.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/plan.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// A teleoperator: an operator, a network, a world model and an arm. It keeps references to what
/// it is built from, but for the network, which becomes its own; all memory is taken at
/// construction.
template <TorqueDrivenArm Arm, ArmKinematics Kinematics,
          network::Operator Operator = network::ScriptedOperator>
class Teleoperator {
 public:
  /// A device that has not answered for this long is silent [s].
  static constexpr double patience = 0.02;

  /// @param network built for `period`
  /// @param links bodies whose forces act on the arm through the module ARM_OBSTACLE
  /// @throws SetupError when the network does not end in as many joints as the arm has
  Teleoperator(const ArmModel& model, Arm& arm, Kinematics& kinematics, World& world, BodyId tool,
               Coprocessor& coprocessor, Operator& the_operator, network::Network network,
               std::chrono::nanoseconds period, std::vector<LinkBody> links = {})
      : model_(model),
        arm_(arm),
        kinematics_(kinematics),
        world_(world),
        tool_(tool),
        links_(std::move(links), static_cast<int>(model.links.size())),
        coprocessor_(coprocessor),
        operator_(the_operator),
        network_(std::move(network)),
        period_(std::chrono::duration<double>(period).count()),
        q_(model.links.size()),
        v_(model.links.size()),
        new_q_(model.links.size()),
        new_v_(model.links.size()),
        torques_(model.links.size()),
        jacobian_(Jacobian::Zero(6, static_cast<Eigen::Index>(model.links.size()))),
        new_jacobian_(jacobian_),
        flow_(static_cast<int>(model.links.size())) {
    if (robot() == nullptr || robot()->size() != static_cast<int>(model.links.size())) {
      throw SetupError("the network must end in a robot (puma_joints) of " +
                       std::to_string(model.links.size()) + " joints");
    }
    const network::Node* at = network_.node_of<network::Obstacle>();
    if (at == nullptr) at = network_.node_of<network::PumaKin>();
    before_walls_ = at == nullptr ? -1 : at->left;
    signals_.period = period_;
    begin_tick({});
    read_joints();
    place_bodies();
    flow_.reset(joints_vec(q_));
  }

  /// One tick. @param now the time it is due [ns]; it must grow from tick to tick
  const TickRecord& tick(std::chrono::nanoseconds now) noexcept {
    sense(now);
    return act(coprocessor_.exchange());
  }

  /// The first half of a tick. Arms that share a world all sense, then one exchange of the
  /// coprocessor tells each how to act.
  void sense(std::chrono::nanoseconds now) noexcept {
    begin_tick(now);  // clock -> status
    read_joints();    // arm -> q, v
    place_bodies();   // q, v -> poses and twists of tool and links in the world
  }

  /// The second half. @param forces of the world in which all arms have been placed
  const TickRecord& act(const PairForces& forces) noexcept {
    push_away(forces);  // world -> virtual forces on tool and links
    ask_operator();     // script -> what the hands do
    run_network();      // hands, walls, joint rates -> torques
    const double gain = failsafe_.step(record_.status, period_);  // status -> share allowed
    drive(gain);                                                  // torques -> arm
    finish_tick(gain);                                            // everything -> record
    return record_;
  }

  [[nodiscard]] const network::Network& network() const noexcept { return network_; }

  /// Brings the code and the data of the next tick into the caches and changes nothing. For the
  /// moment before it is due: a tick that begins cold takes several times as long.
  void rehearse() noexcept {
    kinematics_.update(q_);
    kinematics_.tool_jacobian(new_jacobian_);
    kinematics_.gravity_torques(torques_);
    coprocessor_.rehearse();
  }

 private:
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

  void place_bodies() noexcept {
    kinematics_.update(q_);
    kinematics_.tool_jacobian(new_jacobian_);
    const Pose X_WT = kinematics_.X_WT();
    const Twist V_WT = twist_through(new_jacobian_, v_);
    world_.motion().tick = next_tick_;
    if (world_.place(tool_, X_WT, V_WT)) {
      X_WT_ = X_WT;
      V_WT_ = V_WT;
      jacobian_.swap(new_jacobian_);
    } else {
      record_.status |= status::bad_pose;
    }
    if (!links_.place(world_, kinematics_, v_)) record_.status |= status::bad_pose;
  }

  void push_away(const PairForces& forces) noexcept {
    record_.pairs = forces.totals;
    record_.workers = coprocessor_.workers();
    if (coprocessor_.late()) record_.status |= status::late_result;
    if (forces.totals.stale > 0) record_.status |= status::stale_pairs;
    if (forces.totals.crowded > 0) record_.status |= status::crowded_pairs;
    if (forces.totals.expired > 0) record_.status |= status::expired_pairs;
    signals_.walls = forces.on_body[tool_.index];
    links_.gather(forces, signals_.arm_torques);
    signals_.walls_power = forces.carried[tool_.index];
    signals_.arm_power = links_.carried(forces);
  }

  void ask_operator() noexcept {
    const network::Command& command = operator_.step(X_WT_.linear(), period_);
    if (!command.sound) record_.status |= status::bad_command;
    if (command.silent_for > patience) record_.status |= status::silent_device;
    signals_.hand = command.hand;
    record_.command = command;
  }

  void run_network() noexcept {
    const auto begin = std::chrono::steady_clock::now();
    // With all force gone, springs and accounts begin anew from where the tool is.
    signals_.at_rest = failsafe_.tripped() && failsafe_.gain() == 0.0;
    signals_.joints = joints_vec(q_);
    if (signals_.at_rest) {
      flow_.reset(signals_.joints);
    } else {
      flow_.step(signals_.joints, joints_vec(v_), period_);
    }
    signals_.rates = flow_.flow();
    signals_.mean_rates = flow_.mean();
    signals_.jacobian = jacobian_;
    signals_.X_WT = X_WT_;
    if (!network_.run(signals_)) record_.status |= status::network_fault;
    note_limits();
    record_.network_time = std::chrono::steady_clock::now() - begin;
  }

  void note_limits() noexcept {
    const auto* arm = network_.find<network::TorqueArm>();
    const auto* ball = network_.find<network::Spaceball>();
    const auto* coupling = network_.find<network::Kbb2>();
    const auto* limits = network_.find<network::Limits>();
    if ((arm != nullptr && arm->saturated()) || (ball != nullptr && ball->saturated()) ||
        (coupling != nullptr && coupling->saturated())) {
      record_.status |= status::saturated;
    }
    if (limits != nullptr && limits->active()) record_.status |= status::joint_limit;
    record_.lever_torque = arm != nullptr ? arm->felt() : 0.0;
  }

  // tau = g(q) + those of the network + dry friction, within the speed of each joint and cut to
  // what it can give. The joint limits hold during a fault as well.
  void drive(double gain) noexcept {
    kinematics_.gravity_torques(torques_);
    const auto* limits = network_.find<network::Limits>();
    network::Vec<network::any_size> wanted = gain * robot()->torques();
    if (limits != nullptr) wanted += (1.0 - gain) * limits->torques();
    for (std::size_t i = 0; i < torques_.size(); ++i) {
      const ArmLink& link = model_.links[i];
      const double wish = wanted(static_cast<Eigen::Index>(i));
      const double asked = within_speed(wish, v_[i], link.velocity_limit);
      if (asked != wish) record_.status |= status::speed_limit;
      torques_[i] += asked + friction_(link.coulomb_friction, v_[i], asked);
      const double most = link.effort_limit > 0.0 ? link.effort_limit : 1e9;
      if (!(std::abs(torques_[i]) <= most)) {
        record_.status |= status::torque_limit;
        torques_[i] = std::isnan(torques_[i]) ? 0.0 : std::clamp(torques_[i], -most, most);
      }
    }
    arm_.set_torques(torques_);
  }

  void finish_tick(double gain) noexcept {
    record_.tick = next_tick_++;
    record_.time = period_ * static_cast<double>(record_.tick);
    record_.phase = static_cast<std::int32_t>(operator_.phase());
    std::copy(q_.begin(), q_.end(), record_.q.begin());
    std::copy(v_.begin(), v_.end(), record_.v.begin());
    std::copy(torques_.begin(), torques_.end(), record_.torques.begin());
    record_.p_WT = X_WT_.translation();
    record_.v_WT = V_WT_.linear;
    record_.virtual_force = signals_.walls;
    record_.coupling = before_walls_ < 0
                           ? Wrench{}
                           : network::to_wrench(network_.connection(before_walls_).effort());
    record_.gain = gain;
    std::size_t module = 0;
    for (const network::Node& node : network_.nodes()) {
      record_.energy[module++] = static_cast<float>(node.ledger.energy);
    }
  }

  [[nodiscard]] const network::PumaJoints* robot() const noexcept {
    return network_.find<network::PumaJoints>();
  }
  [[nodiscard]] static network::Vec<network::any_size> joints_vec(
      const std::vector<double>& values) noexcept {
    return Eigen::Map<const network::Vec<network::any_size>>(
        values.data(), static_cast<Eigen::Index>(values.size()));
  }

  const ArmModel& model_;
  Arm& arm_;
  Kinematics& kinematics_;
  World& world_;
  BodyId tool_;
  ArmBodies links_;
  Coprocessor& coprocessor_;
  Operator& operator_;
  network::Network network_;
  network::FrictionCompensation friction_;
  Failsafe failsafe_;
  double period_;                              ///< [s]
  std::vector<double> q_, v_, new_q_, new_v_;  ///< [rad], [rad/s]
  std::vector<double> torques_;                ///< [N m]
  Jacobian jacobian_, new_jacobian_;
  Pose X_WT_ = Pose::Identity();
  Twist V_WT_;
  network::MeasuredFlow flow_;
  network::Signals signals_;
  int before_walls_ = -1;  // connection over which the operator's side acts on the tool
  TickRecord record_;
  std::int64_t next_tick_ = 0;
  std::chrono::nanoseconds last_now_ = std::chrono::nanoseconds::min();
};

}  // namespace repel
