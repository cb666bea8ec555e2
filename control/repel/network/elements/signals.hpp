// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The inputs of a network in one tick.
#pragma once

#include <cstdint>
#include <limits>

#include <repel/network/elements/port.hpp>

namespace repel::network {

/// Six rows, linear then angular, world axes; a column for each joint. In storage of fixed size.
using Jacobian = Eigen::Matrix<double, 6, any_size, Eigen::ColMajor, 6, most_joints>;

/// The operator's input in one tick.
struct HandInput {
  Twist ball;                 ///< [m/s, rad/s] raw rates of the force ball, world axes
  double lever_rate = 0.0;    ///< [rad/s] rate of the hand at the lever
  Vec3 direction_W{1, 0, 0};  ///< world axes: direction in which the lever drives the tool; unit,
                              ///< or shorter where it turns the tool as well
  Vec3 turning_W{0, 0, 0};    ///< [rad/m] world axes: how far it turns the tool about its origin
                              ///< for what drives it by a metre along a unit direction
  /// Multiplies the scale of a master that is felt, 1e-3 to 1e3: tool motion per hand motion, and
  /// force at the hand per force at the tool. It may change at any time: see ChangingScale.
  double scale = 1.0;
  /// Which fixtures of a GUIDE are on: bit i for the i-th; below 0: as set up.
  std::int32_t guides = -1;
  double guide_strength = 1.0;  ///< share of their force, 0 to 1
  /// In which directions RELIEF is compliant: bits 0 to 5 for x, y, z, rx, ry, rz, and bit 6 for
  /// those of the world, else of the tool; below 0: as set up.
  std::int32_t compliant = -1;

  /// Every number but those that their module settles (HandField::is_settled).
  [[nodiscard]] bool is_finite() const noexcept;
  /// Ball and lever stand still; what was chosen stays.
  void rest() noexcept { ball = {}, lever_rate = 0.0; }
};

/// What is known of a number of a hand besides its value.
struct HandField {
  const char* name;    ///< in C++ and Python; in recordings without the frame, `_W`
  const char* unit;    ///< empty: it has none
  const char* what;    ///< it is
  bool moves = false;  ///< recorded of a first hand in any case; others where they are not as
                       ///< without a hand
  bool is_settled =
      false;  ///< what is no number in it is taken care of by the module that reads it
  /// Greatest length that is believed of another program, in its unit. Speeds and scales are
  /// bounded where they are used.
  double most = std::numeric_limits<double>::infinity();
};

/// Calls visit(HandField, x...) for every number of a hand, with that of each of `hands`: a double,
/// a Vec3, or bits that are below 0 as set up. Whoever records, sends or shows hands goes through
/// them here, so that a new one is entered above and below and nowhere else. They are sent in this
/// order.
template <class Visit, class... Hands>
constexpr void for_each_field(const Visit& visit, Hands&... hands) {
  visit(HandField{"lever_rate", "rad/s", "rate of a lever that is felt", true},
        hands.lever_rate...);
  visit(HandField{"direction_W", "", "in which the lever drives the tool; unit", true},
        hands.direction_W...);
  visit(HandField{.name = "turning_W",
                  .unit = "rad/m",
                  .what = "how far the lever turns the tool",
                  .most = 10.0},
        hands.turning_W...);
  visit(HandField{"linear", "m/s", "rate of the hand", true}, hands.ball.linear...);
  visit(HandField{.name = "angular",
                  .unit = "rad/s",
                  .what = "rate of the hand",
                  .moves = true,
                  .most = 100.0},
        hands.ball.angular...);
  visit(
      HandField{
          .name = "scale", .unit = "", .what = "of a master that is felt", .is_settled = true},
      hands.scale...);
  visit(HandField{"guides", "", "bits of the fixtures that are on"}, hands.guides...);
  visit(HandField{.name = "guide_strength",
                  .unit = "",
                  .what = "share of the fixtures' force, 0 to 1",
                  .is_settled = true},
        hands.guide_strength...);
  visit(HandField{"compliant", "", "bits of the directions of relief"}, hands.compliant...);
}

/// Which of the hands that hold one tool.
enum class Hand { first, second };

/// The state of arm, world and operator at the start of a tick. All numbers are finite: the loop
/// holds the last valid ones where an input fails.
struct Signals {
  Vec<any_size> joints;          ///< q [rad], [m]
  Vec<any_size> rates;           ///< [rad/s], [m/s] the measured flow
  Vec<any_size> mean_rates;      ///< [rad/s], [m/s] (q - last q) / elapsed
  Vec<any_size> sent;            ///< [N m], [N] that the joints got in the last period beyond their
                                 ///< weight; of size 0: what the network returned
  Jacobian jacobian;             ///< of the tool
  Pose X_WT = Pose::Identity();  ///< [m]
  Wrench walls;                ///< [N, N m] of the world model on the tool, about its origin, in W,
                               ///< without that of links of the same arm
  Vec<any_size> arm_torques;   ///< [N m], [N] of the world model on the links, sum of J^T F, and of
                               ///< the links on the tool of the same arm
  double walls_power = 0.0;    ///< [W] supplied to the tool by moving obstacles
  double arm_power = 0.0;      ///< [W] and to the links
  Vec<any_size> foreseen;      ///< [rad/s], [m/s] by which the torques of the last tick were to
                               ///< change the rates; of size 0: not at all
  Mat<any_size> inertia;       ///< [kg m^2] or [kg] of the joints, symmetric, as the modules move
                               ///< them: 1 / (1 + g) of the arm's with a FORCE SENSOR; of size 0:
                               ///< not known
  Mat<any_size> wall_damping;  ///< [N m s/rad] of the world model at the joints; of size 0: none
  Wrench measured;           ///< [N, N m] reading of a sensor at the tool: of all that is beyond it
                             ///< on the tool, about its origin, in axes of the tool
  bool is_measured = false;  ///< there is such a reading
  HandInput hand;            ///< what the operator does
  HandInput second;          ///< of a second hand at the same tool, for the modules that name it
  double period = 0.0025;    ///< [s]
  double elapsed = 0.0;      ///< [s] since the last tick, more after missed ticks; 0: one period
  bool at_rest = false;      ///< no force of the operator: states of the operator side are reset
  bool released = false;     ///< nothing can be trusted: states of the walls are reset, too

  /// What the first or the second hand does.
  [[nodiscard]] const HandInput& of(Hand which) const noexcept;
  /// Time since the last tick [s].
  [[nodiscard]] double since_last() const noexcept { return elapsed > 0.0 ? elapsed : period; }
  /// Twist of the tool, J rates, and that of the last period, J mean_rates.
  [[nodiscard]] Vec<any_size> tool_flow() const noexcept;
  /// [m/s, rad/s] Mean motion of the tool over the last period, by the Jacobian of this tick.
  [[nodiscard]] Vec<any_size> mean_tool_flow() const noexcept;
};

}  // namespace repel::network
