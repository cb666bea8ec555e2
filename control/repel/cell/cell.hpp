// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The complete control loop: arms, operators and obstacles in one world, from joint readings to
/// torques.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/loop/reciprocating_motion.hpp>
#include <repel/loop/record.hpp>
#include <repel/network/network.hpp>
#include <repel/network/operator.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/world.hpp>

namespace repel {

class Coprocessor;
class Teleoperator;
class WorldChanges;
struct ArmLayout;
namespace detail {
class CellAssembly;
}

/// Everything between the joint readings of the arms and the torques sent to them, with all checks.
/// It contains no driver, no clock and no threads other than those of the coprocessor configured in
/// the description. All memory is allocated at construction.
///
///     Cell cell(std::move(description));
///     for (;;) {                                     // your thread, your clock
///       const TickRecord& record = cell.step({q, v}, hands, now);
///       send(record.torques, record.brakes);
///     }
///
/// Its functions are compiled: link the target `repel::control` (docs/building.md).
class Cell {
 public:
  /// May take long: every pair is evaluated at least once.
  /// @throws SetupError naming the fault and the allowed values, for: an arm without joints,
  /// kinematics or inertia; a start outside the limits or inside an obstacle; a network without the
  /// wall forces of the arm or without its joints at the end; walls too stiff for arm and rate; a
  /// value out of its range
  explicit Cell(CellDescription description);
  ~Cell();
  Cell(const Cell&) = delete;
  Cell& operator=(const Cell&) = delete;

  /// One tick of a cell with one arm.
  /// @param hands the operator's command @param now due time of the tick [ns], strictly increasing
  /// @return the record with the commands to the arm (torques, brakes, enable) and the state of the
  /// loop; valid until the next tick
  const TickRecord& step(const ArmReadings& readings, const network::Command& hands,
                         std::chrono::nanoseconds now) noexcept;

  /// The first half of a tick: updates the poses of all arms and the forces on them. Separate from
  /// `act` for operators whose command depends on the pose of the tool.
  /// @param readings one for each arm; an arm without one counts as unreadable
  void sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now) noexcept;

  /// The second half of a tick: computes the commands to all arms.
  /// @param hands one command for each arm; an arm without one is treated as if its operator input
  /// had timed out
  /// @return a record for each arm, in their order; valid until the next tick
  std::span<const TickRecord* const> act(std::span<const network::Command> hands) noexcept;

  /// Warms the CPU caches with the code and data of the next tick, without other effects. Call it
  /// shortly before the tick is due: a tick with cold caches takes several times as long.
  void rehearse() noexcept;

  /// Joins the threads of the coprocessor, as the destructor does. Not real-time safe.
  void stop();

  /// What it was built from.
  [[nodiscard]] const CellDescription& description() const noexcept;
  /// Between two ticks.
  [[nodiscard]] std::chrono::nanoseconds period() const noexcept;
  /// Bodies, parts and pairs: what was described, and the arms.
  [[nodiscard]] const World& world() const noexcept;
  /// For the thread of the tick, between two ticks: World::add, move, attach, release and remove.
  [[nodiscard]] World& world() noexcept;
  /// For one other thread: the queue of such changes. They are applied at the next `sense`.
  [[nodiscard]] WorldChanges& changes() noexcept;
  /// The loose parts, in the order of the description.
  [[nodiscard]] std::span<const PartId> loose() const noexcept;
  /// Forces and answers of the pairs (schedule/coprocessor.hpp).
  [[nodiscard]] const Coprocessor& coprocessor() const noexcept;
  /// Number of arms.
  [[nodiscard]] std::size_t arms() const noexcept;
  /// The bodies and parts of an arm (cell/layout.hpp).
  [[nodiscard]] const ArmLayout& layout(std::size_t arm) const noexcept;
  /// The network of an arm, with the states and accounts of its modules.
  [[nodiscard]] const network::Network& network(std::size_t arm) const noexcept;
  /// The pose of the tool of an arm in the world [m], as of the last `sense`.
  [[nodiscard]] const Pose& X_WT(std::size_t arm) const noexcept;
  /// Time since the last tick [s], as of the last `sense`; more after missed ticks.
  [[nodiscard]] double elapsed() const noexcept;
  /// The control of an arm (loop/tick.hpp).
  [[nodiscard]] const Teleoperator& control(std::size_t arm) const noexcept;
  /// The leverage of the tools over a pair, 1 to `most_leverage`: divides its force at the parts to
  /// compare it with one at the tool. Not for the tick.
  [[nodiscard]] double leverage(PairId id) const;
  /// [N] The hardest push of any arm that the wall of a hard pair has withstood; 0 for a soft one.
  [[nodiscard]] double withstood(PairId id) const noexcept;
  /// The bodies of the moving obstacles.
  [[nodiscard]] std::span<const MovingBody> moving() const noexcept;
  /// The least viscous damping of any arm at its tool, in its start pose [N s/m].
  [[nodiscard]] double device_damping() const noexcept;
  /// One message for each tolerated finding: walls above the clean-stiffness limit, parts starting
  /// inside an obstacle.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept;

 private:
  std::unique_ptr<detail::CellAssembly> parts_;
};

}  // namespace repel
