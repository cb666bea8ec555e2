/// @file
/// Runs a scene, by the clock or as fast as it goes.
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
#include "recording.hpp"
#include "run_options.hpp"

namespace repel::teleop {

/// How the ticks of a replay compare with those that were recorded.
struct ReplayReport {
  std::int64_t ticks = 0;
  std::int64_t same = 0;               ///< forces and torques of all arms, bit for bit
  std::int64_t first_difference = -1;  ///< tick; -1: none
  double force_difference = 0.0;       ///< [N] greatest, of the virtual force
};

/// What one obstacle did in a run.
struct ObstacleResult {
  std::string name;
  PairExtremes extremes{};  ///< of all pairs with it
  std::string part{};       ///< of the tool or arm, in the pair that pushed hardest
  std::string body{};       ///< the tool or link it is of
};

/// What one module of the network did in a run.
struct ModuleResult {
  std::string name;
  bool passive = true;  ///< within the claim of passivity: its ledger never falls below zero
  network::Ledger ledger;
  network::PassivityReport passivity;  ///< of a controller inside
  double sampling_energy = 0.0;  ///< [J] that holding the torques gave the arm; of puma_joints
};

/// What one arm did in a run.
struct ArmResult {
  std::string name;  ///< of the partner; empty for the arm of the scene itself
  std::vector<JointType> joints;
  RunTotals totals;                   ///< its own; what they say of pairs is of the whole world
  std::vector<ModuleResult> modules;  ///< of its network, in its order
  std::vector<TickRecord> records;
  ContactReport contact;  ///< what it touched physically, where the options have contact
};

/// Everything there is to say about a run.
struct RunResult {
  RunOptions options;
  scene::Scene scene;  ///< with the budget that was in force
  int pairs = 0;
  int threads = 0;                    ///< of the coprocessor that there was work for
  std::vector<ArmResult> arms;        ///< that of the scene itself, then its partners
  double device_damping = 0.0;        ///< [N s/m] least, of the arms at their tools at the start
  std::vector<std::string> warnings;  ///< walls above the clean-stiffness limit, parts that start
                                      ///< in an obstacle, a log that ended early
  DurationHistogram network_time;     ///< of the networks alone, within the tick
  DeadlineMonitor deadline{std::chrono::nanoseconds{2500000}};
  std::int64_t most_support_pairs = 0;  ///< in one tick
  std::chrono::nanoseconds compute{0};  ///< of all ticks together
  DurationHistogram arm_step;           ///< time of the simulated arm, outside the tick
  std::int64_t over_budget = 0;         ///< ticks that computed longer than the scene's wall budget
  std::int64_t skipped_ticks = 0;       ///< due, and never made: each a miss
  std::int64_t allocations_in_tick = -1;  ///< -1, here and below: could not be counted
  std::int64_t system_calls_in_tick = -1;
  std::int64_t page_faults_in_tick = -1;  ///< minor and major; of the thread of the tick, as below
  std::int64_t voluntary_switches_in_tick = -1;
  std::int64_t involuntary_switches_in_tick = -1;  ///< the machine's doing
  std::string nearest_pair;               ///< "part - obstacle"; empty where nothing was near
  std::vector<ObstacleResult> obstacles;  ///< in the order of the scene
  std::vector<std::string> pair_names;    ///< "part - obstacle" by PairId, where records are kept
  std::vector<TickTimes> times;           ///< of every tick, where records are kept
  std::int64_t log_dropped = 0;           ///< ticks that the log lacks
  std::string log_trouble;                ///< why the log is not whole otherwise; empty: it is
  bool interrupted = false;
  bool begins_anew = false;  ///< those at the controls want another run
  ReplayReport replay;       ///< of a recording
  host::Machine machine;

  /// Of the arm of the scene itself.
  [[nodiscard]] const RunTotals& totals() const noexcept { return arms.front().totals; }
};

/// What a run shows of itself while it lasts.
struct Progress {
  double time = 0.0;  ///< [s]
  std::int32_t phase = 0;
  double nearest = 0.0;  ///< [m] in this tick
  double force = 0.0;    ///< [N]
  Status status = 0;
  std::int64_t misses = 0;
};

/// How many support pairs this machine makes in one period: those of the run, by the time of its
/// ticks, with all else they did. 0 where there are none.
[[nodiscard]] double support_pairs_per_period(const RunResult& result);

/// Who has to do with a run beside the loop. All of them may be missing.
struct Company {
  Tap* tap = nullptr;                     ///< told of every tick; of the same scene
  Controls* controls = nullptr;           ///< of the first arm, and of the time
  devices::DeviceLink* device = nullptr;  ///< drives the first arm and feels its forces
  const Recording* recording = nullptr;   ///< is gone through again, in place of arms and operators
  const std::atomic<bool>* at_once = nullptr;  ///< end without fading the forces
};

/// The scene with the changes that the options make to it.
[[nodiscard]] scene::Scene as_run(const scene::Scene& scene, const RunOptions& options);

/// Builds the scene and runs it. `show` is called from a thread of its own, a few times a second.
/// When `stop` becomes true the operators let go, and it ends as soon as the fail-safe has faded
/// the forces, see FadeOut; at once where nothing moves an arm. It ends early as well when those at
/// the controls want to begin anew.
/// @throws SetupError for a scene that cannot be built
[[nodiscard]] RunResult run(const scene::Scene& scene, const RunOptions& options,
                            const Company& company, const std::atomic<bool>& stop,
                            const std::function<void(const Progress&)>& show);

}  // namespace repel::teleop
