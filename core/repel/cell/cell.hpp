/// @file
/// The complete control loop: arms, operators and obstacles in one world, from joint readings to
/// torques.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/cell/default_network.hpp>
#include <repel/cell/description.hpp>
#include <repel/cell/layout.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/loop/tick.hpp>
#include <repel/loop/tick_clock.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// Everything between the joint readings of the arms and the torques sent to them, with all checks.
/// It contains no driver, no clock and no threads other than those of the coprocessor configured in
/// the description. All memory is allocated at construction.
///
///     Cell cell(std::move(description));
///     for (;;) {                                     // your thread, your clock
///       const TickRecord& record = cell.step({q, v}, hands, now);
///       send(record.torques, record.brakes);
///     }
class Cell {
 public:
  /// May take long: every pair is evaluated at least once.
  /// @throws SetupError naming the fault and the allowed values, for: an arm without joints,
  /// kinematics or inertia; a start outside the limits or inside an obstacle; a network that does
  /// not transmit the wall forces to the arm or does not end in its joints; walls that are too
  /// stiff for arm and rate; a value out of its range
  explicit Cell(CellDescription description)
      : description_(std::move(description)),
        period_(std::llround(1e9 / checked("rate", description_.rate_hz, 1.0, 1e5, "Hz"))),
        clock_(period_, std::chrono::nanoseconds::max()),
        world_(description_.limits) {
    if (description_.arms.empty()) throw SetupError("the cell has no arm; allowed: 1 or more");
    lay_out();
    add_controls();
    check();
    start_coprocessor();
  }
  Cell(const Cell&) = delete;
  Cell& operator=(const Cell&) = delete;

  /// One tick of a cell with one arm.
  /// @param hands the operator's command @param now due time of the tick [ns], strictly increasing
  /// @return the record with the commands to the arm (torques, brakes, enable) and the state of the
  /// loop; valid until the next tick
  const TickRecord& step(const ArmReadings& readings, const network::Command& hands,
                         std::chrono::nanoseconds now) noexcept {
    sense({&readings, 1}, now);
    return *act({&hands, 1}).front();
  }

  /// The first half of a tick: updates the poses of all arms and the forces on them. Separate from
  /// `act` for operators whose command depends on the pose of the tool.
  /// @param readings one for each arm; an arm without one counts as unreadable
  void sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now) noexcept {
    // Moving obstacles follow the clock, so skipped ticks are counted.
    (void)clock_.step(now);
    if (ticks_ > 0) periods_ += clock_.elapsed();
    ++ticks_;
    const double time = 1e-9 * static_cast<double>(period_.count()) * static_cast<double>(periods_);
    for (const MovingBody& moving : moving_) (void)moving.place(world_, time);
    for (std::size_t i = 0; i < controls_.size(); ++i) {
      controls_[i].sense(i < readings.size() ? readings[i] : ArmReadings{}, now);
    }
    forces_ = &coprocessor_->exchange();
    contacts_->collect(*coprocessor_);
  }

  /// The second half of a tick: computes the commands to all arms.
  /// @param hands one command for each arm; an arm without one is treated as if its operator input
  /// had timed out
  /// @return a record for each arm, in their order; valid until the next tick
  std::span<const TickRecord* const> act(std::span<const network::Command> hands) noexcept {
    for (std::size_t i = 0; i < controls_.size(); ++i) {
      records_[i] = &controls_[i].act(*forces_, coprocessor_->workers(), contacts_->all(),
                                      i < hands.size() ? hands[i] : silent_);
    }
    return records_;
  }

  /// Warms the CPU caches with the code and data of the next tick, without other effects. Call it
  /// shortly before the tick is due: a tick with cold caches takes several times as long.
  void rehearse() noexcept {
    for (Teleoperator& control : controls_) control.rehearse();
    coprocessor_->rehearse();
  }

  /// Joins the threads of the coprocessor, as the destructor does. Not real-time safe.
  void stop() { coprocessor_->stop(); }

  [[nodiscard]] const CellDescription& description() const noexcept { return description_; }
  [[nodiscard]] std::chrono::nanoseconds period() const noexcept { return period_; }
  [[nodiscard]] const World& world() const noexcept { return world_; }
  [[nodiscard]] const Coprocessor& coprocessor() const noexcept { return *coprocessor_; }
  [[nodiscard]] std::size_t arms() const noexcept { return controls_.size(); }
  /// The bodies and parts of an arm.
  [[nodiscard]] const ArmLayout& layout(std::size_t arm) const noexcept { return layouts_[arm]; }
  /// The control loop of an arm: network, pose of the tool.
  [[nodiscard]] const Teleoperator& control(std::size_t arm) const noexcept {
    return controls_[arm];
  }
  /// The leverage of the tools over a pair, 1 to `most_leverage`: what its force at the parts is
  /// divided by to compare it with a force at the tool. Not for the tick.
  [[nodiscard]] double leverage(PairId id) const {
    return repel::leverage(world_, layouts_, world_.pair(id).a, world_.pair(id).b);
  }
  /// The bodies of the moving obstacles.
  [[nodiscard]] std::span<const MovingBody> moving() const noexcept { return moving_; }
  /// The least viscous damping of any arm at its tool, in its start pose [N s/m].
  [[nodiscard]] double device_damping() const noexcept { return device_damping_; }
  /// One message for each finding that the description tolerates: walls above the clean-stiffness
  /// limit, parts that start inside an obstacle.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  void lay_out() {
    for (ArmDescription& arm : description_.arms) {
      detail::start(arm);
      layouts_.push_back(detail::add_arm(world_, arm));
    }
    for (const ObstacleDescription& obstacle : description_.obstacles) {
      const auto moving = detail::add_obstacle(world_, obstacle, layouts_);
      if (moving) moving_.push_back(*moving);
    }
    for (std::size_t second = 1; second < layouts_.size(); ++second) {
      for (const PartId b : layouts_[second].parts) {
        for (std::size_t first = 0; first < second; ++first) {
          for (const PartId a : layouts_[first].parts) {
            detail::add_pair(world_, layouts_, a, b, description_.arms[second].law);
          }
        }
      }
    }
    for (std::size_t i = 0; i < layouts_.size(); ++i) {
      detail::add_own_pairs(world_, description_.arms[i], layouts_[i]);
    }
  }

  void add_controls() {
    for (std::size_t i = 0; i < layouts_.size(); ++i) {
      ArmDescription& arm = description_.arms[i];
      require_inertia(arm);
      arm.options.push_out = description_.start_inside == StartInside::push_out;
      controls_.emplace_back(TeleoperatorParts{arm.model, *arm.kinematics, world_, layouts_[i].tool,
                                               layouts_[i].links, built_network(arm)},
                             period_, arm.options);
      records_.push_back(nullptr);
    }
  }

  [[nodiscard]] network::Network built_network(const ArmDescription& arm) const {
    const network::Plan plan = arm.network ? *arm.network : default_network(arm.model);
    try {
      if (!arm.options.prediction) return plan.build(1.0 / description_.rate_hz);
      return plan.build(1.0 / description_.rate_hz,
                        network::PredictionOptions{.drive_delay = arm.options.drive_delay});
    } catch (const SetupError& error) {
      throw SetupError(std::string("network: ") + error.what());
    }
  }

  // Braking and the plausibility check of the readings use the mass of the arm.
  static void require_inertia(const ArmDescription& arm) {
    ArmInertia inertia(arm.model);
    inertia.update(*arm.kinematics);
    if (inertia.missing() < 0) return;
    throw SetupError(
        "joint '" + arm.model.links[static_cast<std::size_t>(inertia.missing())].joint_name +
        "' moves no mass where the arm starts; allowed: links with mass and inertia, a "
        "rotor_inertia, or kinematics with a mass_matrix");
  }

  void check() {
    for (const ArmDescription& arm : description_.arms) {
      Jacobian J(6, static_cast<Eigen::Index>(arm.model.links.size()));
      arm.kinematics->tool_jacobian(J);
      if (!std::all_of(J.data(), J.data() + J.size(), [](double x) { return x - x == 0.0; })) {
        throw SetupError(detail::named(arm) + ": its tool_jacobian is not finite at the start");
      }
      device_damping_ = std::min(device_damping_, repel::device_damping(arm.model, J));
    }
    check_stiffness();
    const std::vector<std::string> inside = detail::overlaps(world_);
    if (description_.start_inside == StartInside::refuse) detail::require_clear_start(inside);
    warnings_.insert(warnings_.end(), inside.begin(), inside.end());
  }

  void check_stiffness() {
    const double period = 1.0 / description_.rate_hz;
    double delay = 0.0;
    for (const ArmDescription& arm : description_.arms) {
      delay = std::max(delay, arm.options.drive_delay);
    }
    const std::string cure = " (to run all the same: 'gain_check: warning' at the obstacle module)";
    try {
      warnings_ = check_gains(world_, period, delay, device_damping_, description_.gain_check);
    } catch (const SetupError& error) {
      throw SetupError(std::string("wall too stiff: ") + error.what() + cure);
    }
    for (std::size_t i = 0; i < controls_.size(); ++i) {
      const auto* limits = controls_[i].network().find<network::Limits>();
      if (limits == nullptr) continue;
      try {
        const std::string text = check_gains(
            *limits, period, description_.arms[i].options.drive_delay, description_.gain_check);
        if (!text.empty()) warnings_.push_back(text);
      } catch (const SetupError& error) {
        throw SetupError(std::string("limits too stiff: ") + error.what() + cure);
      }
    }
  }

  // Limits the number of threads to that of blocks: others would have no work.
  void start_coprocessor() {
    CoprocessorOptions options = description_.coprocessor;
    checked("threads", options.threads, 0, description_.limits.threads, "");
    options.threads = std::min(options.threads, detail::PairPartition::blocks_of(world_));
    options.period = period_;
    coprocessor_.emplace(world_, options);
    std::vector<BodyId> moved;
    for (const ArmLayout& layout : layouts_) {
      moved.push_back(layout.tool);
      for (const LinkBody& link : layout.links) moved.push_back(link.body);
    }
    contacts_.emplace(world_, std::min<std::size_t>(world_.pairs().size(), 4096), moved);
  }

  CellDescription description_;
  std::chrono::nanoseconds period_;
  TickClock clock_;
  World world_;
  std::vector<ArmLayout> layouts_;
  std::vector<MovingBody> moving_;
  std::deque<Teleoperator> controls_;
  std::vector<const TickRecord*> records_;
  std::optional<Coprocessor> coprocessor_;
  std::optional<ActiveContacts> contacts_;
  const PairForces* forces_ = nullptr;
  network::Command silent_{
      .hand = {}, .sound = false, .silent_for = std::numeric_limits<double>::infinity()};
  double device_damping_ = std::numeric_limits<double>::infinity();  // [N s/m]
  std::vector<std::string> warnings_;
  std::int64_t ticks_ = 0;
  std::int64_t periods_ = 0;  // since the first tick
};

}  // namespace repel
