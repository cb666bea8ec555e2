// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The results of a run, and how they are collected at its end.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/cell/stability_budget.hpp>
#include <repel/common/deadline.hpp>
#include <repel/host/machine.hpp>
#include <repel/loop/record.hpp>
#include <repel/loop/tap.hpp>
#include <repel/network/modules/kbb2.hpp>
#include <repel/network/network.hpp>
#include <repel/robots/robot.hpp>
#include <repel/runs/cameras/camera_feeds.hpp>
#include <repel/runs/operator/part_steps.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/runs/records/replay.hpp>
#include <repel/runs/watch/chatter.hpp>
#include <repel/runs/wire/link_result.hpp>
#include <repel/runs/wire/station_program.hpp>
#include <repel/scene/scene.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/simulated/contact.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/world.hpp>

namespace repel::runs {

/// The law of an obstacle on a link it pushed, and its effect at the tool.
struct LinkLaw {
  std::string body;  ///< the link
  GivenAt given_at = GivenAt::part;
  bool passable = false;
  double leverage = 1.0;      ///< of the tool over the link, see Cell::leverage
  double at_part = 0.0;       ///< [N] surface force on the link
  double peak_force = 0.0;    ///< [N] on the link
  double peak_at_tool = 0.0;  ///< [N] its force there

  /// The surface force in terms of a push at the tool [N].
  [[nodiscard]] double at_tool() const noexcept { return at_part / leverage; }
};

/// The results of one obstacle.
struct ObstacleResult {
  std::string name;
  PairExtremes extremes{};           ///< of all pairs with it
  bool is_hard = false;              ///< it may not be entered
  double withstood = 0.0;            ///< [N] hardest push withstood, if it is hard
  std::string part{};                ///< of a tool or arm, in the pair with the largest force
  std::string body{};                ///< the tool or link of that part
  std::vector<LinkLaw> link_laws{};  ///< the weakest pair of each link that it pushed
};

/// What a force sensor measured.
struct SensorResult {
  double peak_force = 0.0;           ///< [N] on the tool, after the low pass
  std::int64_t saturated_ticks = 0;  ///< with a reading at its range or beyond
  std::int64_t lost_ticks = 0;       ///< without a sound reading
};

/// What a virtual fixture did.
struct FixtureResult {
  std::string name;
  double stiffness = 0.0;   ///< [N/m] in use
  double damping = 0.0;     ///< [N s/m] in use
  double most_force = 0.0;  ///< [N] largest on the tool
};

/// The results of one module of the network.
struct ModuleResult {
  std::string name;
  bool claims_passive = true;  ///< by its traits: its ledger never falls below zero
  network::Ledger ledger;
  network::PassivityReport passivity;  ///< of the controller inside
  double sampling_energy = 0.0;  ///< [J] given to the arm by holding the torques; of puma_joints
  std::optional<network::Kbb2Options> coupling{};  ///< with the gains in use; of kbb2
  /// [m, rad] how far it gave along and about each axis at most; of relief
  std::optional<Eigen::Matrix<double, 6, 1>> given{};
  std::vector<double> limit_torques{};    ///< [N m, N] the largest on each joint; of limits
  std::optional<SensorResult> sensor{};   ///< of force_sensor
  std::vector<FixtureResult> fixtures{};  ///< of guide

  /// It claims to be passive and was: what its ledger fell below zero is rounding.
  [[nodiscard]] bool passive() const { return claims_passive && ledger.deficit() <= 1e-9; }
};

/// The results of one arm.
struct ArmResult {
  std::string name;  ///< of the partner; empty for the arm of the scene itself
  std::vector<JointType> joints;
  std::vector<std::string> joint_names;
  std::vector<HeldJoint> held;        ///< joints of its robot that do not move
  RunTotals totals;                   ///< of this arm; those on pairs are of the whole world
  std::vector<ModuleResult> modules;  ///< of its network, in the same order
  std::vector<TickRecord> records;
  std::vector<StabilityShare> stability;  ///< at the start
  ContactReport contact;                  ///< physical contacts, with RunOptions::contact
  ArmChatter chatter;
};

/// The results of a run.
struct RunResult {
  RunOptions options;
  scene::Scene scene;  ///< with the budget and the measure in force
  int pairs = 0;
  int levels = 0;   ///< of the reduced shapes; 0: the measure needs none
  int threads = 0;  ///< coprocessor threads with work
  WorkerUsage worker_usage;
  std::vector<ArmResult> arms;  ///< the arm of the scene itself, then its partners
  double device_damping = 0.0;  ///< [N s/m] minimum over the arms, at their tools at the start
  std::vector<std::string> warnings;  ///< walls above the clean-stiffness limit, parts starting in
                                      ///< an obstacle, a log ended early, laws at links weaker than
                                      ///< the operator
  DurationHistogram network_time;     ///< of the networks alone, within the tick
  DeadlineMonitor deadline{std::chrono::nanoseconds{2500000}};
  std::int64_t most_support_pairs = 0;    ///< in one tick
  std::chrono::nanoseconds compute{0};    ///< sum over all ticks
  DurationHistogram arm_step;             ///< time of the simulated arm, outside the tick
  std::int64_t over_budget = 0;           ///< ticks above the scene's wall-clock budget
  std::int64_t skipped_ticks = 0;         ///< due but never run; each counts as a miss
  std::int64_t allocations_in_tick = -1;  ///< -1, here and below: not available
  std::int64_t system_calls_in_tick = -1;
  std::int64_t page_faults_in_tick = -1;  ///< minor and major; of the tick's thread, as below
  std::int64_t voluntary_switches_in_tick = -1;
  std::int64_t involuntary_switches_in_tick = -1;  ///< preemptions, caused by the machine
  std::string nearest_pair;                        ///< "part - obstacle"; empty if nothing was near
  std::vector<ObstacleResult> obstacles;           ///< in the order of the scene
  std::vector<std::string> pair_names;  ///< "part - obstacle" by PairId, if records are kept
  std::vector<TickTimes> times;         ///< of every tick, if records are kept
  std::int64_t log_dropped = 0;         ///< ticks missing in the log
  std::string log_trouble;              ///< other reason why the log is incomplete; empty: none
  bool interrupted = false;
  bool begins_anew = false;              ///< the user requested another run
  std::vector<PartStepResult> steps;     ///< of the loose parts
  std::optional<CameraResult> camera;    ///< if the scene has cameras
  std::optional<LinkResult> link;        ///< if the operator is in another program
  std::optional<StationEnding> station;  ///< if it ran beside this program
  ReplayReport replay;                   ///< of a replay
  host::Machine machine;
  /// Since set-up, of all pairs with an impassable law, and of those with a passable one.
  PairExtremes walls, passables;

  /// Of the arm of the scene itself.
  [[nodiscard]] const RunTotals& totals() const noexcept { return arms.front().totals; }
};

/// True when an arm gained energy from its own control (`status::energy_gain`).
[[nodiscard]] bool gained_energy(const RunResult& result);

/// True when an arm had a fault in more than a tenth of its ticks (`status::unsound`). Ten ticks
/// are excused for each one skipped by the machine: it held up the loop, and the drive stopped.
[[nodiscard]] bool was_often_at_fault(const RunResult& result);
/// Of teleop: 3 a replay came out otherwise, 4 the log is not whole, 5 an arm gained energy or was
/// often at fault; else 0.
[[nodiscard]] int exit_status(const RunResult& result);

/// Support pairs computed by this machine in one period, extrapolated from the support pairs and
/// the computing time of the run, all other work of the ticks included. 0 if unknown.
[[nodiscard]] double support_pairs_per_period(const RunResult& result);

/// Collects the extremes of every obstacle, of the walls and of the passable bodies, and the
/// nearest pair of all. Call once `coprocessor` has stopped.
/// @param withstood [N] by PairId, the hardest push withstood by a hard wall; empty: none is hard
void note_pairs(const World& world, const Coprocessor& coprocessor, RunResult& result,
                std::span<const double> withstood = {});

/// For each pair the place of its obstacle in `RunResult::obstacles`. Obstacles of held parts are
/// those already listed.
[[nodiscard]] std::vector<std::size_t> obstacles_of_pairs(const World& world);

/// Collects the steps made, and warns of those refused.
void note_steps(const PartSteps& steps, RunResult& result);

/// The results of every module, in the order of the network.
[[nodiscard]] std::vector<ModuleResult> module_results(const network::Network& network);

}  // namespace repel::runs
