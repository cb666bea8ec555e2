// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// RELIEF: compliance along chosen degrees of freedom.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/two_port.hpp>

namespace repel::network {

/// Frame in which the compliant directions are stated.
enum class ReliefFrame { world, tool };

/// Damping may be `automatic`: critical for the stiffness and the arm (see `suited`).
struct ReliefOptions {
  /// Which of x, y, z, and rotation about x, y, z, are compliant.
  std::array<bool, 6> compliant{};
  ReliefFrame frame = ReliefFrame::tool;  ///< of `compliant`
  double stiffness = 500.0;        ///< [N/m]; 0: a pure damper, which creeps and does not return
  double damping = 50.0;           ///< [N s/m]
  double angular_stiffness = 5.0;  ///< [N m/rad]; 0: a pure damper
  double angular_damping = 0.5;    ///< [N m s/rad]
};

/// A series two-port: compliant, with a spring-damper, along each chosen direction s of the task
/// frame,
///
///     u = s.f / (K T / 2 + B) - what the spring reflects       v_right = v_left + sum s u
///
/// and rigid along the others. The directions rotate with their frame; the same ones are used for
/// effort and flow in one tick, and the spring states are stored along them, so that rotating the
/// frame neither stores nor releases energy.
///
/// HandInput::compliant changes directions and frame at any time, in `switching_time`: the damper
/// of a direction that becomes rigid grows until nothing moves. Its spring, whose energy is then
/// dissipated, is forgotten, and its extension is held. One that becomes compliant begins with a
/// spring without force and a damper that shrinks to its own. In all of this the module is a spring
/// and a positive damper in each tick: passive, and u changes by no more than its share of the
/// time.
class Relief {
 public:
  /// A tool on both sides.
  static constexpr Traits traits{.left = Space::tool, .right = Space::tool};
  static constexpr double switching_time = 0.2;  ///< [s] of a direction; of a frame twice as long
  /// Of HandInput::compliant: in the axes of the world.
  static constexpr std::int32_t world_bit = 1 << 6;

  /// @throws SetupError for a number out of range, or when a direction would have neither spring
  /// nor damper
  explicit Relief(const ReliefOptions& options = {}) : options_(options) {
    checked("stiffness", options.stiffness, 0.0, 1e7, "N/m");
    detail::checked_gain("damping", options.damping, 0.0, 1e6, "N s/m");
    checked("angular stiffness", options.angular_stiffness, 0.0, 1e6, "N m/rad");
    detail::checked_gain("angular damping", options.angular_damping, 0.0, 1e6, "N m s/rad");
    for (std::size_t i = 0; i < options.compliant.size(); ++i) {
      if (!options.compliant[i] || may_give(options, i)) continue;
      throw SetupError("a compliant direction has neither stiffness nor damping");
    }
  }

  /// Whether the i-th direction has a spring or a damper, so that it can be made compliant.
  [[nodiscard]] static bool may_give(const ReliefOptions& options, std::size_t i) noexcept {
    return i < 3 ? options.stiffness != 0.0 || options.damping > 0.0
                 : options.angular_stiffness != 0.0 || options.angular_damping > 0.0;
  }

  /// Chooses the dampings that are `automatic`; those of the defaults for an arm without a known
  /// mass.
  void suit(const RobotEnd& robot) noexcept {
    options_.damping = suited({options_.stiffness, options_.damping}, robot.mass, robot.response,
                              {0.0, ReliefOptions{}.damping})
                           .damping;
    options_.angular_damping =
        suited({options_.angular_stiffness, options_.angular_damping}, robot.inertia,
               robot.response, {0.0, ReliefOptions{}.angular_damping})
            .damping;
  }
  /// @param period [s] of the network.
  void prepare(double period) {
    step_ = std::min(1.0, detail::checked_period(period) / switching_time);
    frame_ = options_.frame;
    is_settled_ = false;
    for (int i = 0; i < 6; ++i) {
      const bool angular = i >= 3;
      const double k = angular ? options_.angular_stiffness : options_.stiffness;
      const double b = angular ? options_.angular_damping : options_.damping;
      spring_resistance_[i] = 0.5 * k * period;
      const double resistance = spring_resistance_[i] + b;
      full_conductance_[i] = resistance > 0.0 ? 1.0 / resistance : 0.0;
      conductance_[i] = options_.compliant[i] ? full_conductance_[i] : 0.0;
      inverse_stiffness_[i] = k > 0.0 ? 1.0 / k : 0.0;
    }
  }
  /// Takes the orientation of the tool, and what the hand has switched.
  void read(const Signals& signals) noexcept {
    switch_over(signals.hand.compliant);
    turn_ = frame_ == ReliefFrame::tool ? rotation(signals.X_WT) : Mat3(Mat3::Identity());
    if (signals.at_rest) wave_.setZero();
  }

  /// What is behind, with the compliant directions in series. False where it cannot be formed.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    Mat<any_size> G = Mat<any_size>::Zero(6, 6);
    for (int block = 0; block < 6; block += 3) {
      if (is_rigid(block)) continue;
      for (int row = 0; row < 3; ++row) {
        const Vec3 left = times_gains(row, block);
        for (int column = 0; column < 3; ++column) {
          const double* t = turn_.data() + column;
          G.coeffRef(block + row, block + column) =
              left[0] * t[0] + (left[1] * t[3] + left[2] * t[6]);
        }
      }
    }
    shown = behind;
    shown.add_admittance(G, -in_world(product(conductance_, wave_)));
    return true;
  }
  /// The same effort; the flow without that of the springs, which advance.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept {
    const Six effort = in_task(at_root.effort);
    const Six relative = product(conductance_, effort - wave_);
    wave_ += 2.0 * product(spring_resistance_, relative);
    most_ = most_.cwiseMax(product(wave_, inverse_stiffness_).cwiseAbs());
    at_leaf.effort = at_root.effort;
    at_leaf.flow = at_root.flow - in_world(relative);
  }

  /// Energy stored in the springs [J].
  [[nodiscard]] double stored() const noexcept {
    return 0.5 * product(wave_, wave_).dot(inverse_stiffness_);
  }

  /// Energy of springs whose direction became rigid, since set-up [J].
  [[nodiscard]] double forgotten() const noexcept { return forgotten_; }
  /// Whether it gives way along, or about, the i-th axis, if only while that changes.
  [[nodiscard]] bool gives(int i) const noexcept { return conductance_[i] > 0.0; }
  /// The frame in use.
  [[nodiscard]] ReliefFrame frame() const noexcept { return frame_; }

  /// How far it gave along, and about, each axis of the task frame at most since set-up [m, rad];
  /// 0 where it is rigid or a pure damper.
  [[nodiscard]] const Eigen::Matrix<double, 6, 1>& most_given() const noexcept { return most_; }

 private:
  using Six = Eigen::Matrix<double, 6, 1>;
  // A frame changes while all directions are rigid: their springs have no force.
  void switch_over(std::int32_t wanted) noexcept {
    if (wanted == wanted_ && is_settled_) return;
    wanted_ = wanted;
    is_settled_ = true;
    const ReliefFrame frame = wanted < 0                  ? options_.frame
                              : (wanted & world_bit) != 0 ? ReliefFrame::world
                                                          : ReliefFrame::tool;
    const bool turns = frame != frame_;
    bool is_rigid = true;
    for (int i = 0; i < 6; ++i) {
      const bool is_wanted =
          wanted < 0 ? options_.compliant[static_cast<std::size_t>(i)] : ((wanted >> i) & 1) != 0;
      const double target = is_wanted && !turns ? full_conductance_[i] : 0.0;
      const double step = step_ * full_conductance_[i];
      conductance_[i] = std::clamp(target, conductance_[i] - step, conductance_[i] + step);
      if (conductance_[i] < 1e-9 * step) conductance_[i] = 0.0;
      is_settled_ = is_settled_ && !turns && conductance_[i] == target;
      if (conductance_[i] > 0.0) is_rigid = false;
      if (conductance_[i] > 0.0 || wave_[i] == 0.0) continue;
      forgotten_ += 0.5 * wave_[i] * wave_[i] * inverse_stiffness_[i];
      wave_[i] = 0.0;
    }
    if (is_rigid) frame_ = frame;
  }

  [[nodiscard]] Six in_task(const Vec<any_size>& world) const noexcept {
    Six task;
    for (int i = 0; i < 6; ++i) {
      const double* t = &turn_(0, i % 3);
      const Vec3 v = three(world, i - i % 3);
      task[i] = t[0] * v[0] + t[1] * v[1] + t[2] * v[2];
    }
    return task;
  }
  [[nodiscard]] Vec<any_size> in_world(const Six& task) const noexcept {
    return to_vec(turn_ * three(task, 0), turn_ * three(task, 3));
  }
  /// Along, or about, all three axes.
  [[nodiscard]] bool is_rigid(int block) const noexcept {
    const double* g = conductance_.data() + block;
    return g[0] == 0.0 && g[1] == 0.0 && g[2] == 0.0;
  }
  /// Row `row` of `turn_`, times the conductances along the axes of the task frame.
  [[nodiscard]] Vec3 times_gains(int row, int block) const noexcept {
    const double* t = turn_.data() + row;
    return {t[0] * conductance_[block], t[3] * conductance_[block + 1],
            t[6] * conductance_[block + 2]};
  }

  ReliefOptions options_;
  ReliefFrame frame_ = ReliefFrame::tool;
  std::int32_t wanted_ = -1;      // in the last tick
  bool is_settled_ = false;       // nothing is left to change for it
  double step_ = 1.0;             // of a change, in a tick
  double forgotten_ = 0.0;        // [J]
  Mat3 turn_ = Mat3::Identity();  // from the task frame to the world
  Six spring_resistance_ = Six::Zero(), conductance_ = Six::Zero(), full_conductance_ = Six::Zero();
  Six inverse_stiffness_ = Six::Zero();
  Six wave_ = Six::Zero();  // of the springs, in the task frame [N, N m]
  Six most_ = Six::Zero();  // extension [m, rad]
};

}  // namespace repel::network
