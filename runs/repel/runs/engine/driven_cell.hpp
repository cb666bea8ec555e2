// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A cell together with the arms and operators of a run.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <span>
#include <vector>

#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/runs/faults/injected_faults.hpp>
#include <repel/runs/operator/operator_input.hpp>
#include <repel/runs/operator/part_steps.hpp>
#include <repel/runs/records/recording.hpp>
#include <repel/runs/wire/remote_values.hpp>

namespace repel::runs {

/// Allocates only at construction.
class DrivenCell {
 public:
  /// @param cell must outlive this object
  /// @param arms one for each arm of the cell, in the same order
  /// @param operators likewise
  /// @param scene of the cell
  /// @param remote link to the first operator; null: that operator is here
  /// @param faults of the first arm, which outlive this object; null: none
  DrivenCell(Cell& cell, const scene::Scene& scene,
             std::vector<std::unique_ptr<TorqueDrivenArm>> arms,
             std::vector<OperatorInput> operators, network::RemoteLink* remote = nullptr,
             faults::InjectedFaults* faults = nullptr)
      : cell_(cell),
        remote_(remote),
        faults_(faults),
        scripted_parts_(scene.loose.size()),
        steps_(scene, cell),
        arms_(std::move(arms)),
        operators_(std::move(operators)),
        readings_(arms_.size()),
        commands_(arms_.size()) {
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      ports_.emplace_back(*arms_[i], cell.description().arms[i].model.links.size());
    }
  }

  /// To be called before each tick, due at `now` [ns]: begins the faults whose time has come.
  /// Returns the time that the tick is to be told. @param period [s]
  std::chrono::nanoseconds begin_tick(std::chrono::nanoseconds now, double period) {
    if (faults_ == nullptr) return now;
    faults_->begin_tick(cell_, last_);
    const auto told = faults_->tell(now);
    move_arms(period, told.missed);
    return told.now;
  }

  /// Runs one tick, due at `now` [ns]. Returns the record of each arm, in their order.
  std::span<const TickRecord* const> tick(std::chrono::nanoseconds now) noexcept {
    if (remote_ != nullptr) remote_->receive(now);
    for (std::size_t i = 0; i < ports_.size(); ++i) readings_[i] = ports_[i].read();
    if (faults_ != nullptr) faults_->spoil(readings_.front());
    cell_.sense(readings_, now);
    for (std::size_t i = 0; i < operators_.size(); ++i) {
      commands_[i] = operators_[i].step(cell_.X_WT(i).linear(), cell_.elapsed());
      if (i == 0 && remote_ != nullptr && !has_let_go_) commands_[i] = heard_command(*remote_);
      if (i == 0 && faults_ != nullptr && !has_let_go_) faults_->spoil(commands_[i]);
      if (!commands_[i].is_silent(blind_for_)) commands_[i].silent_for = blind_for_;
    }
    const auto records = cell_.act(commands_);
    last_ = records.front();
    if (remote_ != nullptr) {
      tell(*records.front(), cell_.X_WT(0), next_part(records.front()->tick), *remote_);
    }
    for (std::size_t i = 0; i < commands_.size(); ++i) steps_.follow(i, commands_[i].phase);
    for (std::size_t i = 0; i < ports_.size(); ++i) ports_[i].apply(*records[i]);
    return records;
  }

  /// Advances the simulated arms, which keep moving during skipped ticks too.
  ///
  /// @param period [s]
  void move_arms(double period, std::int64_t periods) {
    for (std::int64_t i = 0; i < periods; ++i) {
      for (const auto& arm : arms_) arm->step(period);
    }
  }

  /// The next tick repeats tick `tick` of the recording: operators repeat their commands, and every
  /// RecordedArm reports its recorded state.
  void replay(const Recording& recording, std::size_t tick) noexcept {
    for (std::size_t i = 0; i < operators_.size(); ++i) {
      const TickRecord& then = recording.arms[i][tick];
      operators_[i].follow(then);
      if (auto* arm = dynamic_cast<RecordedArm*>(arms_[i].get())) arm->follow(then);
    }
  }

  /// From the next tick on all operators are at rest: see OperatorInput::let_go.
  void let_go() noexcept {
    has_let_go_ = true;
    for (OperatorInput& each : operators_) each.let_go();
  }

  /// In the next ticks, what operators see has been silent for so long [s]: as if they were.
  void set_blind_for(double blind_for) noexcept { blind_for_ = blind_for; }

  /// See Cell::rehearse.
  void rehearse() noexcept { cell_.rehearse(); }

  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }
  [[nodiscard]] const PartSteps& steps() const noexcept { return steps_; }
  [[nodiscard]] const TorqueDrivenArm& arm(std::size_t i) const noexcept { return *arms_[i]; }

 private:
  /// The state of one loose part, of each in turn: the station has no world.
  [[nodiscard]] PartState next_part(std::int64_t tick) const noexcept {
    PartState told;
    if (scripted_parts_ == 0) return told;
    const auto i = static_cast<std::size_t>(tick) % scripted_parts_;
    const World& world = cell_.world();
    const BodyId id = world.part(cell_.loose()[i]).body;
    const BodyState& body = world.motion().bodies[static_cast<std::size_t>(id.index)];
    told.part = static_cast<std::int32_t>(i);
    if (!body.presence.is_there()) return told;
    const bool is_held = body.arm.valid();
    told.where = is_held ? PartState::Where::is_held : PartState::Where::lies_free;
    told.X = is_held ? cell_.X_WT(0).inverse() * body.X_WB : body.X_WB;
    return told;
  }

  Cell& cell_;
  network::RemoteLink* remote_;
  faults::InjectedFaults* faults_;
  const TickRecord* last_ = nullptr;  // of the first arm
  std::size_t scripted_parts_;
  bool has_let_go_ = false;
  PartSteps steps_;
  std::vector<std::unique_ptr<TorqueDrivenArm>> arms_;
  std::vector<ArmPort> ports_;
  std::vector<OperatorInput> operators_;
  std::vector<ArmReadings> readings_;
  std::vector<network::Command> commands_;
  double blind_for_ = 0.0;  // [s]
};

}  // namespace repel::runs
