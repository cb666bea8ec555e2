// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How a cell is assembled from its description, and checked.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/cell/layout.hpp>
#include <repel/loop/tick.hpp>
#include <repel/loop/tick_clock.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/schedule/world_changes.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// The parts of a cell, and the only place where they are put together and checked. The functions
/// are those of `Cell` (cell/cell.hpp), which documents them.
class CellAssembly {
 public:
  explicit CellAssembly(CellDescription description);
  CellAssembly(const CellAssembly&) = delete;
  CellAssembly& operator=(const CellAssembly&) = delete;

  void sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now) noexcept;

  std::span<const TickRecord* const> act(std::span<const network::Command> hands) noexcept;

  void rehearse() noexcept;

  void stop() { coprocessor_->stop(); }

  [[nodiscard]] const CellDescription& description() const noexcept { return description_; }
  [[nodiscard]] std::chrono::nanoseconds period() const noexcept { return period_; }
  [[nodiscard]] const World& world() const noexcept { return world_; }
  [[nodiscard]] World& world() noexcept { return world_; }
  [[nodiscard]] WorldChanges& changes() noexcept { return *changes_; }
  [[nodiscard]] std::span<const PartId> loose() const noexcept { return loose_; }
  [[nodiscard]] const Coprocessor& coprocessor() const noexcept { return *coprocessor_; }
  [[nodiscard]] std::size_t arms() const noexcept { return controls_.size(); }
  [[nodiscard]] const ArmLayout& layout(std::size_t arm) const noexcept { return layouts_[arm]; }
  [[nodiscard]] const Teleoperator& control(std::size_t arm) const noexcept;
  [[nodiscard]] double leverage(PairId id) const;
  [[nodiscard]] double withstood(PairId id) const noexcept;
  [[nodiscard]] std::span<const MovingBody> moving() const noexcept { return moving_; }
  [[nodiscard]] double device_damping() const noexcept { return device_damping_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  static constexpr std::size_t most_changes = 1024;  // that wait

  /// One for each 400 us of the period: a change costs some 50 us of the tick, with the first
  /// evaluations of its pairs, so all of them an eighth.
  [[nodiscard]] int changes_per_tick() const noexcept;

  /// [s] How early the barrier before hard walls must know a closing gap.
  [[nodiscard]] double reaction() const noexcept;

  void lay_out();

  void reduce_shapes();

  void add_controls();

  [[nodiscard]] network::Network built_network(const ArmDescription& arm) const;

  // Braking and the plausibility check of the readings use the mass of the arm.
  static void require_inertia(const ArmDescription& arm);

  void check();

  void check_stiffness();

  void start_coprocessor();

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
  std::optional<HardContacts> hard_;
  std::optional<WorldChanges> changes_;
  std::vector<PartId> loose_;  // in the order of the description
  const PairForces* forces_ = nullptr;
  network::Command silent_{
      .hand = {}, .sound = false, .silent_for = std::numeric_limits<double>::infinity()};
  double device_damping_ = std::numeric_limits<double>::infinity();  // [N s/m]
  std::vector<std::string> warnings_;
  std::vector<std::string> raised_;  // of these, about laws whose damping was raised
  std::int64_t ticks_ = 0;
  std::int64_t periods_ = 0;  // since the first tick
};

}  // namespace repel::detail
