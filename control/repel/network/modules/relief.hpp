// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// RELIEF: compliance along chosen degrees of freedom.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <repel/base/field.hpp>
#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/signals.hpp>

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

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Choice{"frame", {"world", "tool"}}, o.frame);
    visit(Field{"stiffness", "N/m", 0.0, 1e7}, o.stiffness);
    visit(Field{"damping", "N s/m", 0.0, 1e6, true}, o.damping);
    visit(Field{"angular_stiffness", "N m/rad", 0.0, 1e6}, o.angular_stiffness);
    visit(Field{"angular_damping", "N m s/rad", 0.0, 1e6, true}, o.angular_damping);
  }
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
/// of a direction made rigid grows until nothing moves. Its spring is forgotten, the energy
/// dissipated, and its extension is held. A direction made compliant begins with a spring without
/// force and a damper shrinking to its own value. In all of this the module is a spring and a
/// positive damper in each tick: passive, and u changes by no more than its share of the time.
class Relief {
 public:
  /// A tool on both sides.
  static constexpr Traits traits{.left = Space::tool, .right = Space::tool};
  /// The words of a scene for the directions, in their order.
  static constexpr std::array<std::string_view, 6> directions{"x", "y", "z", "rx", "ry", "rz"};
  static constexpr double switching_time = 0.2;  ///< [s] of a direction; of a frame twice as long
  /// Of HandInput::compliant: in the axes of the world.
  static constexpr std::int32_t world_bit = 1 << 6;

  /// @throws SetupError for a number out of range, or when a direction would have neither spring
  /// nor damper
  explicit Relief(const ReliefOptions& options = {});

  /// Whether the i-th direction has a spring or a damper, so that it can be made compliant.
  [[nodiscard]] static bool may_give(const ReliefOptions& options, std::size_t i) noexcept;

  /// Chooses the dampings that are `automatic`; those of the defaults for an arm without a known
  /// mass.
  void suit(const RobotEnd& robot) noexcept;
  /// @param period [s] of the network.
  void prepare(double period);
  /// Takes the orientation of the tool, and the switches of the hand.
  void read(const Signals& signals) noexcept;

  /// What is behind, with the compliant directions in series. False where it cannot be formed.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// The same effort; the flow without that of the springs. Advances the springs.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept;

  /// Energy stored in the springs [J].
  [[nodiscard]] double stored() const noexcept;

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
  void switch_over(std::int32_t wanted) noexcept;

  [[nodiscard]] Six in_task(const Vec<any_size>& world) const noexcept;
  [[nodiscard]] Vec<any_size> in_world(const Six& task) const noexcept;
  /// Along, or about, all three axes.
  [[nodiscard]] bool is_rigid(int block) const noexcept;
  /// Row `row` of `turn_`, times the conductances along the axes of the task frame.
  [[nodiscard]] Vec3 times_gains(int row, int block) const noexcept;

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
