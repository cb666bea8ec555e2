/// @file
/// OBSTACLE: the virtual forces of the world model, as an element of the network.
#pragma once

#include <cmath>

#include <repel/network/passivity.hpp>
#include <repel/network/two_port.hpp>

namespace repel::network {

struct ObstacleOptions {
  PassivityOptions passivity;
};

/// A series source of effort: f_left = f_right - F_walls on the same flow. The walls are nonlinear
/// and depend on the measured pose, so their flow must be known before the network is solved:
/// nothing compliant may stand between this module and the robot.
///
/// Between two ticks the force is held while the tool moves on, a pair that was not asked in time
/// is answered later, the fail-safe fades forces in: all that could give more energy than went in.
/// A passivity controller (passivity.hpp) keeps the account of the port from falling below zero and
/// counters the energy of sampling. What is stored where the run begins does not count: a tool that
/// starts inside a wall is held and not thrown out. A wall that moves by itself gives what it does
/// by its motion: that is supplied, and may be passed on.
class Obstacle {
 public:
  static constexpr Traits traits{.left = Space::tool,
                                 .right = Space::tool,
                                 .needs_flow = true,
                                 .keeps_flow = true,
                                 .walls = Walls::tool};

  explicit Obstacle(const ObstacleOptions& options = {})
      : controller_(options.passivity, weight_of(options.passivity)) {
    const PassivityOptions& p = options.passivity;
    checked("most energy", p.most_energy, 0.0, 1e6, "J");
    checked("most damping", p.most_damping, 0.0, 1e6, "N s/m");
    checked("lever", p.lever, 1e-6, 100.0, "m");
  }

  void read(const Signals& signals) noexcept {
    const Vec<any_size> flow = signals.tool_flow();
    effort_ = -to_vec(signals.walls);
    if (signals.released) {
      controller_.reset();
      effort_.setZero(6);
      supplied_ = 0.0;
      return;
    }
    const Six mean = signals.mean_tool_flow();
    supplied_ = signals.walls_power;
    const double damping =
        controller_.step(effort_, flow, mean, signals.period, supplied_, signals.since_last());
    if (damping > 0.0) effort_ += damping * controller_.weight().cwiseProduct(flow);
  }

  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    return series::shown(behind, effort_, shown);
  }
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) const noexcept {
    series::pass(at_root, effort_, at_leaf);
  }

  /// What the walls do to the tool after the controller [N, N m].
  [[nodiscard]] Wrench on_tool() const noexcept { return to_wrench(-effort_); }
  /// The same on the joints.
  void add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept {
    const Wrench F = on_tool();
    for (Eigen::Index i = 0; i < torques.size(); ++i) {
      const auto column = jacobian.col(i);
      torques(i) += column.head<3>().dot(F.force) + column.tail<3>().dot(F.torque);
    }
  }
  [[nodiscard]] const PassivityReport& passivity() const noexcept { return controller_.report(); }
  [[nodiscard]] double supplied() const noexcept { return supplied_; }  ///< [W] by what moves

 private:
  using Six = Eigen::Matrix<double, 6, 1>;
  static Six weight_of(const PassivityOptions& options) {
    const double square = options.lever * options.lever;
    Six weight;
    weight << 1.0, 1.0, 1.0, square, square, square;
    return weight;
  }

  PassivityController<6> controller_;
  Vec<any_size> effort_ = Vec<any_size>::Zero(6);  // into the module
  double supplied_ = 0.0;
};

}  // namespace repel::network
