/// @file
/// Runs a scene, in real time or as fast as possible.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <repel/loop/record.hpp>
#include <repel/scene/scene.hpp>
#include <repel/schedule/deadline.hpp>
#include <repel/world/contact.hpp>

#include "controls.hpp"
#include "device.hpp"
#include "machine.hpp"
#include "prepared_run.hpp"
#include "recording.hpp"
#include "run_options.hpp"

namespace repel::teleop {

/// How the ticks of a replay compare with the recorded ones.
struct ReplayReport {
  std::int64_t ticks = 0;
  std::int64_t same = 0;               ///< forces and torques of all arms are identical
  std::int64_t first_difference = -1;  ///< tick; -1: none
  double force_difference = 0.0;       ///< [N] largest, of the virtual force
};

/// The results of one obstacle.
struct ObstacleResult {
  std::string name;
  PairExtremes extremes{};  ///< of all pairs with it
  std::string part{};       ///< of a tool or arm, in the pair with the largest force
  std::string body{};       ///< the tool or link of that part
};

/// The results of one module of the network.
struct ModuleResult {
  std::string name;
  bool passive = true;  ///< claimed to be passive: its ledger never falls below zero
  network::Ledger ledger;
  network::PassivityReport passivity;  ///< of the controller inside
  double sampling_energy = 0.0;  ///< [J] that holding the torques gave the arm; of puma_joints
};

/// The results of one arm.
struct ArmResult {
  std::string name;  ///< of the partner; empty for the arm of the scene itself
  std::vector<JointType> joints;
  RunTotals totals;                   ///< of this arm; those on pairs are of the whole world
  std::vector<ModuleResult> modules;  ///< of its network, in the same order
  std::vector<TickRecord> records;
  ContactReport contact;  ///< physical contacts, with RunOptions::contact
};

/// The results of a run.
struct RunResult {
  RunOptions options;
  scene::Scene scene;  ///< with the budget that was in force
  int pairs = 0;
  int threads = 0;              ///< coprocessor threads that had work
  std::vector<ArmResult> arms;  ///< the arm of the scene itself, then its partners
  double device_damping = 0.0;  ///< [N s/m] minimum over the arms, at their tools at the start
  std::vector<std::string> warnings;  ///< walls above the clean-stiffness limit, parts that start
                                      ///< in an obstacle, a log that ended early
  DurationHistogram network_time;     ///< of the networks alone, within the tick
  DeadlineMonitor deadline{std::chrono::nanoseconds{2500000}};
  std::int64_t most_support_pairs = 0;  ///< in one tick
  std::chrono::nanoseconds compute{0};  ///< sum over all ticks
  DurationHistogram arm_step;           ///< time of the simulated arm, outside the tick
  std::int64_t over_budget = 0;    ///< ticks that took longer than the scene's wall-clock budget
  std::int64_t skipped_ticks = 0;  ///< due but never run; each counts as a miss
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
  bool begins_anew = false;  ///< the user requested another run
  ReplayReport replay;       ///< of a replay
  host::Machine machine;
  /// Since set-up, of all pairs whose law is not passable, and of those whose law is.
  PairExtremes walls, passables;

  /// Of the arm of the scene itself.
  [[nodiscard]] const RunTotals& totals() const noexcept { return arms.front().totals; }
};

/// Intermediate state of a run.
struct Progress {
  double time = 0.0;  ///< [s]
  std::int32_t phase = 0;
  double nearest = 0.0;  ///< [m] in this tick
  double force = 0.0;    ///< [N]
  Status status = 0;
  std::int64_t misses = 0;
};

/// How many support pairs this machine computes in one period, extrapolated from the support pairs
/// and the computing time of the run, which includes all other work of the ticks. 0 if unknown.
[[nodiscard]] double support_pairs_per_period(const RunResult& result);

/// Optional connections of a run. All may be null.
struct Attachments {
  Tap* tap = nullptr;            ///< receives every tick; of the same scene
  Controls* controls = nullptr;  ///< for the first arm, and for pausing, restarting and seeking
  devices::DeviceLink* device = nullptr;  ///< drives the first arm and feels its forces
  const Recording* recording = nullptr;   ///< to replay, instead of simulated arms and operators
  const std::atomic<bool>* at_once = nullptr;  ///< request to end without fading the forces
};

/// Runs a prepared scene, once. `show` is called from a separate thread, a few times a second. When
/// `stop` becomes true the operators go to rest, and the run ends as soon as the fail-safe has
/// faded the forces, see FadeOut; a replay ends at once. It also ends early when the controls
/// request a restart.
/// @throws SetupError for an arm that cannot be simulated
[[nodiscard]] RunResult run(PreparedRun& prepared, const Attachments& attached,
                            const std::atomic<bool>& stop,
                            const std::function<void(const Progress&)>& show);

}  // namespace repel::teleop
