/// @file
/// The operators of a cell at work: one tick of everything.
#pragma once

#include <chrono>
#include <deque>
#include <span>
#include <vector>

#include <repel/loop/tick.hpp>
#include <repel/loop/tick_clock.hpp>
#include <repel/schedule/coprocessor.hpp>

#include "cell.hpp"
#include "hands.hpp"
#include "run_options.hpp"

namespace repel::teleop {

/// Drives all arms of a cell, which share its world. All memory is taken at construction.
template <TorqueDrivenArm Arm>
class Crew {
 public:
  using Member = Teleoperator<Arm, Kinematics, Hands>;

  /// @param arms one for each of the cell, in the same order; kept by reference, as is the cell
  /// @param controls, device of the first arm; null: its script drives it
  Crew(const scene::Scene& scene, Cell& cell, std::span<Arm> arms, Coprocessor& coprocessor,
       Controls* controls, devices::DeviceLink* device, const RunOptions& run)
      : cell_(cell),
        coprocessor_(coprocessor),
        period_(std::llround(1e9 / run.rate_hz)),
        clock_(period_, std::chrono::nanoseconds::max()) {
    for (std::size_t i = 0; i < arms.size(); ++i) {
      const scene::Station& station = scene.station(i);
      Manipulator& arm = cell.arms[i];
      operators_.emplace_back(station.script, i == 0 ? controls : nullptr,
                              i == 0 ? device : nullptr);
      members_.emplace_back(arm.robot.arm, arms[i], arm.kinematics, cell.world, arm.tool,
                            coprocessor, operators_.back(),
                            scene::build_network(scene, station, arm.robot.arm, run.rate_hz),
                            period_, arm.links, options_of(scene, run));
      records_.push_back(nullptr);
    }
  }

  /// One tick of the world, due at `now` [ns]: what each arm did, in their order.
  std::span<const TickRecord* const> tick(std::chrono::nanoseconds now) noexcept {
    // What moves by itself went on while ticks were missing.
    (void)clock_.step(now);
    if (ticks_ > 0) periods_ += clock_.elapsed();
    ++ticks_;
    const double time = 1e-9 * static_cast<double>(period_.count()) * static_cast<double>(periods_);
    for (const Shuttle& shuttle : cell_.shuttles) (void)shuttle.place(cell_.world, time);
    for (Member& member : members_) member.sense(now);
    const PairForces& forces = coprocessor_.exchange();
    for (std::size_t i = 0; i < members_.size(); ++i) records_[i] = &members_[i].act(forces);
    return records_;
  }

  /// At the next tick the operator of that arm does what was recorded; `record` must stand.
  void follow(std::size_t arm, const TickRecord& record) noexcept {
    operators_[arm].follow(record);
  }

  /// From the next tick on no operator drives: see Hands::let_go.
  void let_go() noexcept {
    for (Hands& each : operators_) each.let_go();
  }

  /// See Teleoperator::rehearse.
  void rehearse() noexcept {
    for (Member& member : members_) member.rehearse();
  }

  [[nodiscard]] const std::deque<Member>& members() const noexcept { return members_; }

 private:
  static TeleoperatorOptions options_of(const scene::Scene& scene, const RunOptions& run) {
    TeleoperatorOptions options;
    options.tool_speed = scene.tool_speed;
    options.push_out = scene.start_inside == scene::StartInside::push_out;
    options.joints.touches = run.contact;
    return options;
  }

  Cell& cell_;
  Coprocessor& coprocessor_;
  std::chrono::nanoseconds period_;
  TickClock clock_;
  std::deque<Hands> operators_;
  std::deque<Member> members_;
  std::vector<const TickRecord*> records_;
  std::int64_t ticks_ = 0;
  std::int64_t periods_ = 0;  // since the first tick
};

}  // namespace repel::teleop
