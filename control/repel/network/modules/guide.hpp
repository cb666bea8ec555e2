// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// GUIDE: virtual fixtures attracting the tool.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/base/field.hpp>
#include <repel/network/elements/entry_energy.hpp>
#include <repel/network/elements/fixture.hpp>
#include <repel/network/elements/series_source.hpp>

namespace repel::network {

/// The fixtures, and how they come and go.
struct GuideOptions {
  std::vector<FixtureOptions> fixtures{};  ///< in the order of HandInput::guides
  double ramp = 0.25;                      ///< [s] of a fixture being switched on or off
  double entry_energy = 1.0;  ///< [J] supplied by the module itself for switching on: EntryEnergy
  PassivityOptions passivity{.keeps_energy = true};  ///< over all of them

  /// Calls visit(Field, x) for each number.
  template <class Visit, class Options>
  static constexpr void for_each_field(const Visit& visit, Options& o) {
    visit(Field{"ramp", "s", 1e-3, 100.0}, o.ramp);
    visit(Field{"entry_energy", "J", 1e-3, 1e3}, o.entry_energy);
    PassivityOptions::for_each_field(visit, o.passivity);
  }
};

/// A series source of effort: f_left = f_right - F at the same flow, F the sum over the fixtures of
///
///     - a grad U(x) - a B across v
///
/// with a gain a, 0 to 1, for the position and one for the orientation. At a constant gain it is
/// conservative but for its damper. A falling gain releases a U. A rising one is limited by the
/// available energy: first that taken by damper and falling gains, then `entry_energy`, counted as
/// supplied. With the tool at the fixture U is zero and so is the cost. A passivity controller
/// watches the port.
class Guide : public ToolSource {
 public:
  /// For the planner.
  static constexpr Traits traits{
      .left = Space::tool, .right = Space::tool, .needs_flow = true, .keeps_flow = true};
  static constexpr std::size_t most_fixtures = 30;  ///< one bit of HandInput::guides each
  static constexpr double turning_time = 0.02;      ///< [s] of the damper behind a bend or corner

  /// One fixture as of the last tick.
  struct Held {
    FixtureOptions options;        ///< with the gains in use
    FixtureGeometry geometry{};    ///< where it attracts
    Attraction along{};            ///< the law of its force
    Attraction about{};            ///< and of its torque
    double damping = 0.0;          ///< [N s/m] in use
    double angular_damping = 0.0;  ///< [N m s/rad] in use
    FixtureView view{};            ///< while it acts
    double clear = 0.0;            ///< [m] no place of the fixture is nearer
    Mat3 across = Mat3::Zero();    ///< of the damper
    double gain = 0.0;             ///< of the force, 0 to 1
    double angular_gain = 0.0;     ///< of the torque, 0 to 1
    double most_force = 0.0;       ///< [N] exerted since set-up
    /// It exerts something.
    [[nodiscard]] bool acts() const noexcept { return gain > 0.0 || angular_gain > 0.0; }
    /// Where it holds the orientation, too.
    [[nodiscard]] bool is_near() const noexcept { return view.distance < options.range; }
    /// Energy in its springs [J].
    [[nodiscard]] double stored() const noexcept;
  };
  /// @throws SetupError, naming the fixture, for a number out of range
  explicit Guide(const GuideOptions& options = {});
  /// Chooses the gains that are `automatic`.
  void suit(const RobotEnd& robot) noexcept { robot_ = robot; }
  /// @throws SetupError for a damping that does not keep its spring stable at this period
  void prepare(double period);
  /// Takes pose and motion of the tool, and the switches of the hand.
  void read(const Signals& signals) noexcept;
  /// The fixtures, in the order of the options.
  [[nodiscard]] std::span<const Held> fixtures() const noexcept {
    return {held_.data(), held_.size()};
  }
  /// Energy in the springs [J].
  [[nodiscard]] double stored() const noexcept;
  /// Adds J' D J, D the damping of fixtures and passivity controller.
  void add_wall_damping(const Jacobian& jacobian, Mat<any_size>& damping) const noexcept;

 private:
  // The energy of the springs must fit into the account beside that of the damper.
  static PassivityOptions with_room(const GuideOptions& options);
  // As of a wall: B >= wall_ticks T K.
  [[nodiscard]] Gains settled(const FixtureOptions& fixture, const Gains& asked, const Gains& usual,
                              double mass, double least) const;
  void release() noexcept;
  [[nodiscard]] static double wanted(const HandInput& hand, const Held& held,
                                     std::size_t index) noexcept;
  void settle_gains(const Signals& signals) noexcept;
  // A place without force may be left for a nearer one; if that attracts, as if switched on. It is
  // searched if the tool may have come within range of it.
  static void search(Held& held, const Pose& X_WT) noexcept;
  void look(Held& held, const Pose& X_WT, double motion) noexcept;
  void push(Held& held, const Vec<any_size>& flow) noexcept;

  std::vector<Held> held_;
  RobotEnd robot_;
  double ramp_;
  EntryEnergy entry_;
  double turn_share_ = 1.0;
  bool has_position_ = false;
  Vec3 x_{0, 0, 0};  // of the tool in the last tick
  Mat3 linear_damping_ = Mat3::Zero(), angular_damping_ = Mat3::Zero();
};

}  // namespace repel::network
