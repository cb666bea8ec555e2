/// @file
/// The straight line: everything that happens in one tick, in the order it happens.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <vector>

#include <repel/loop/arm_bodies.hpp>
#include <repel/loop/arm_command.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/network_check.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/record.hpp>
#include <repel/loop/speed_share.hpp>
#include <repel/loop/tick_clock.hpp>
#include <repel/network/limits.hpp>
#include <repel/network/multiplex.hpp>
#include <repel/network/obstacle.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/plan.hpp>
#include <repel/network/puma_joints.hpp>
#include <repel/network/puma_kin.hpp>
#include <repel/network/torque_arm.hpp>
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
  /// @throws SetupError for a network that does not fit arm and world (`require_complete`), or an
  /// option out of range
  Teleoperator(const ArmModel& model, Arm& arm, Kinematics& kinematics, World& world, BodyId tool,
               Coprocessor& coprocessor, Operator& the_operator, network::Network network,
               std::chrono::nanoseconds period, std::vector<LinkBody> links = {},
               const TeleoperatorOptions& options = {})
      : options_(checked(options)),
        arm_(arm),
        kinematics_(kinematics),
        world_(world),
        tool_(tool),
        links_(std::move(links), static_cast<int>(model.links.size())),
        coprocessor_(coprocessor),
        operator_(the_operator),
        network_(std::move(network)),
        clock_(period, in_nanoseconds(options.longest_gap)),
        period_(std::chrono::duration<double>(period).count()),
        watch_(model, period_, options.joints),
        inertia_(model),
        command_(model, arm, period_, options),
        q_(model.links.size()),
        v_(model.links.size()),
        read_q_(model.links.size()),
        read_v_(model.links.size()),
        jacobian_(Jacobian::Zero(6, static_cast<Eigen::Index>(model.links.size()))),
        new_jacobian_(jacobian_),
        flow_(static_cast<int>(model.links.size())),
        pushing_out_(options.push_out) {
    require_complete(network_, static_cast<int>(model.links.size()), world, tool, links_.bodies());
    const network::Node* at = network_.node_of<network::Obstacle>();
    if (at == nullptr) at = network_.node_of<network::PumaKin>();
    before_walls_ = at == nullptr ? -1 : at->left;
    const auto* lever = network_.find<network::Multiplex>();
    lever_scale_ = lever == nullptr ? 1.0 : lever->velocity_scale();
    signals_.period = signals_.elapsed = period_;
    kinematics_.update(q_);
    inertia_.update(kinematics_);
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
    push_away(forces);                                  // world -> virtual forces on tool and links
    ask_operator();                                     // script -> what the hands do
    run_network();                                      // hands, walls, joint rates -> torques
    command_.judge(record_, watch_, signals_.elapsed);  // status -> stop, share of the operator
    drive();                                            // torques -> arm
    finish_tick();                                      // everything -> record
    return record_;
  }

  [[nodiscard]] const network::Network& network() const noexcept { return network_; }

  /// Brings the code and the data of the next tick into the caches and changes nothing. For the
  /// moment before it is due: a tick that begins cold takes several times as long.
  void rehearse() noexcept {
    kinematics_.update(q_);
    kinematics_.tool_jacobian(new_jacobian_);
    kinematics_.gravity_torques(command_.gravity());
    coprocessor_.rehearse();
  }

 private:
  void begin_tick(std::chrono::nanoseconds now) noexcept {
    record_.status = clock_.step(now);
    record_.elapsed = clock_.elapsed();
    signals_.elapsed = period_ * static_cast<double>(clock_.elapsed());
    // The arm went on without the loop: what it reports now need not follow what it reported then.
    if ((record_.status & status::clock_gap) != 0U || next_tick_ == 0) watch_.begin_anew();
  }

  void read_joints() noexcept {
    arm_.read_positions(read_q_);
    arm_.read_velocities(read_v_);
    if constexpr (BrakedArm<Arm>) {
      if (arm_.state() != ArmState::enabled) watch_.hold();
    }
    record_.status |= watch_.step(read_q_, read_v_, signals_.elapsed, inertia_.matrix());
    for (std::size_t i = 0; i < q_.size(); ++i) {
      q_[i] = watch_.position(i);
      v_[i] = watch_.rate(i);
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
      inertia_.update(kinematics_);
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
    if (pushing_out_) push_out(forces.totals);
  }

  // The walls may give what an arm takes that leaves at exit_speed, and nobody leads it meanwhile.
  void push_out(const PairTotals& totals) noexcept {
    constexpr double lever = 0.5;  // [m] of a wall that turns a joint
    const bool is_felt = totals.peak_force > 0.0;
    if (totals.nearest > 0.0 && (!is_felt || command_.pushes_out_whole())) {
      pushing_out_ = false;
      return;
    }
    record_.status |= status::pushed_out;
    signals_.walls_power += options_.exit_speed * signals_.walls.force.norm();
    signals_.arm_power += options_.exit_speed / lever * signals_.arm_torques.norm();
  }

  void ask_operator() noexcept {
    const network::Command& command = operator_.step(X_WT_.linear(), signals_.elapsed);
    if (!command.sound) record_.status |= status::bad_command;
    if (command.silent_for > patience) record_.status |= status::silent_device;
    signals_.hand = command.hand;
    record_.command = command;
    if (cut_to_speed(signals_.hand, options_.tool_speed, lever_scale_)) {
      record_.status |= status::saturated;
    }
  }

  void run_network() noexcept {
    const auto begin = std::chrono::steady_clock::now();
    // With the operator let go, springs and accounts of his side begin anew from where the tool is.
    signals_.released = record_.stop == Stop::released || command_.is_poisoned();
    signals_.at_rest = command_.has_let_go() || signals_.released;
    signals_.joints = joints_vec(q_);
    if (signals_.released) {
      flow_.reset(signals_.joints);
    } else {
      flow_.step(signals_.joints, joints_vec(v_), period_, signals_.elapsed);
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
    for (const network::Node& node : network_.nodes()) {
      if (node.module->saturated()) record_.status |= status::saturated;
    }
    const auto* arm = network_.find<network::TorqueArm>();
    const auto* limits = network_.find<network::Limits>();
    if (limits != nullptr && limits->active()) record_.status |= status::joint_limit;
    record_.lever_torque = arm != nullptr ? arm->felt() : 0.0;
  }

  void drive() noexcept {
    kinematics_.gravity_torques(command_.gravity());
    command_.drive({network_, signals_.jacobian, v_, V_WT_.linear.norm()}, inertia_, watch_,
                   record_);
  }

  void finish_tick() noexcept {
    record_.tick = next_tick_++;
    if (record_.tick > 0) periods_ += record_.elapsed;
    record_.time = period_ * static_cast<double>(periods_);
    record_.phase = static_cast<std::int32_t>(operator_.phase());
    std::copy(q_.begin(), q_.end(), record_.q.begin());
    std::copy(v_.begin(), v_.end(), record_.v.begin());
    std::copy(read_q_.begin(), read_q_.end(), record_.q_read.begin());
    std::copy(read_v_.begin(), read_v_.end(), record_.v_read.begin());
    const std::vector<double>& torques = command_.torques();
    std::copy(torques.begin(), torques.end(), record_.torques.begin());
    record_.p_WT = X_WT_.translation();
    record_.v_WT = V_WT_.linear;
    record_.virtual_force = signals_.walls;
    record_.coupling = before_walls_ < 0
                           ? Wrench{}
                           : network::to_wrench(network_.connection(before_walls_).effort());
    std::size_t module = 0;
    for (const network::Node& node : network_.nodes()) {
      record_.energy[module++] = static_cast<float>(node.ledger.energy);
    }
  }

  [[nodiscard]] static network::Vec<network::any_size> joints_vec(
      const std::vector<double>& values) noexcept {
    return Eigen::Map<const network::Vec<network::any_size>>(
        values.data(), static_cast<Eigen::Index>(values.size()));
  }

  [[nodiscard]] static std::chrono::nanoseconds in_nanoseconds(double seconds) noexcept {
    return std::chrono::nanoseconds(std::llround(1e9 * seconds));
  }

  TeleoperatorOptions options_;
  Arm& arm_;
  Kinematics& kinematics_;
  World& world_;
  BodyId tool_;
  ArmBodies links_;
  Coprocessor& coprocessor_;
  Operator& operator_;
  network::Network network_;
  TickClock clock_;
  double period_;  ///< [s]
  JointWatch watch_;
  ArmInertia inertia_;
  ArmCommand<Arm> command_;
  std::vector<double> q_, v_, read_q_, read_v_;  ///< [rad], [rad/s]
  Jacobian jacobian_, new_jacobian_;
  Pose X_WT_ = Pose::Identity();
  Twist V_WT_;
  network::MeasuredFlow flow_;
  network::Signals signals_;
  int before_walls_ = -1;     // connection over which the operator's side acts on the tool
  double lever_scale_ = 1.0;  ///< [m/rad]
  bool pushing_out_;
  TickRecord record_;
  std::int64_t next_tick_ = 0;
  std::int64_t periods_ = 0;  ///< since the first tick
};

}  // namespace repel
