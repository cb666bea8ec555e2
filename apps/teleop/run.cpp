#include "run.hpp"

#include <pthread.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include <repel/ideal/arm.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/loop/tick.hpp>
#include <repel/robots/dynamics.hpp>
#ifdef REPEL_TELEOP_BULLET
#include <repel/bullet/arm.hpp>
#endif
#ifdef REPEL_TELEOP_ODE
#include <repel/ode/arm.hpp>
#endif

#include "budget.hpp"
#include "cell.hpp"
#include "heap_guard.hpp"
#include "metronome.hpp"
#include "system_call_guard.hpp"
#include "tick_usage.hpp"

namespace repel::teleop {
namespace {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

/// As `ps -L` and /proc show it, up to 15 characters.
void name_this_thread(const char* name) noexcept {
  (void)pthread_setname_np(pthread_self(), name);
}

/// For coprocessor threads, which do nothing but ticks.
void begin_worker_in_lock_step(int index) noexcept {
  char name[16];
  (void)std::snprintf(name, sizeof name, "repel pairs %d", index);
  name_this_thread(name);
  SystemCallGuard::arm(Pauses::naps);
  host::HeapGuard::watch_this_thread();
  SystemCallGuard::watch_this_thread();
}
void begin_worker(int index) noexcept {
  (void)host::follow_real_time();
  begin_worker_in_lock_step(index);
}

CoprocessorOptions coprocessor_options(const RunResult& run, nanoseconds period) {
  const scene::Budget& budget = run.scene.budget;
  const RunOptions& options = run.options;
  CoprocessorOptions result;
  result.threads = run.threads;
  result.period = period;
  result.patience = period / 4;
  result.lock_step = options.fast;
  result.on_thread_start = options.fast ? &begin_worker_in_lock_step : &begin_worker;
  result.every_pair = options.every_pair;
  result.budget.work_units = budget.work_units;
  result.budget.max_age = budget.max_age;
  // A clock would make two runs differ: without one only the counted budget holds.
  if (!options.fast) {
    result.budget.wall = nanoseconds(std::llround(1e3 * budget.wall_us));
    if (result.budget.wall.count() > 0) result.patience = result.budget.wall + period / 20;
  }
  return result;
}

/// Prints progress from its own thread, so that a slow terminal cannot hold up a tick.
class ProgressThread {
 public:
  ProgressThread(Mailbox<Progress>& box, const std::function<void(const Progress&)>& show)
      : thread_([&box, &show](const std::stop_token& stop) {
          name_this_thread("repel progress");
          while (!stop.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
            if (box.take()) show(box.newest());
          }
        }) {}

 private:
  std::jthread thread_;
};

Progress progress_of(const TickRecord& record, const RunResult& result) noexcept {
  return {record.time,          record.phase,
          record.pairs.nearest, record.virtual_force.force.norm(),
          record.status,        result.deadline.misses()};
}

bool over_budget(const scene::Budget& budget, nanoseconds compute) {
  return budget.wall_us > 0.0 && 1e-3 * static_cast<double>(compute.count()) > budget.wall_us;
}

std::string name_of(const World& world, PairId id) {
  const Pair& pair = world.pair(id);
  return world.part(pair.a).name + " - " + world.part(pair.b).name;
}

/// The nearest of all evaluations, those before the first tick included.
void find_nearest(const World& world, const Coprocessor& coprocessor, RunResult& result) {
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(world.pairs().size()); ++i) {
    const double nearest = coprocessor.extremes_of({i}).nearest;
    if (nearest > result.totals.nearest) continue;
    result.totals.nearest = nearest;
    result.nearest_pair = name_of(world, {i});
  }
}

/// Pairs are laid out obstacle by obstacle, with every part of the tool in turn.
std::vector<ObstacleResult> obstacle_results(const Cell& cell, const Coprocessor& coprocessor) {
  std::vector<ObstacleResult> results;
  PartId last;
  const World& world = cell.world;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(world.pairs().size()); ++i) {
    const PartId obstacle = world.pair({i}).b;
    if (obstacle != last) results.push_back({.name = world.part(obstacle).name});
    last = obstacle;
    const PairExtremes& extremes = coprocessor.extremes_of({i});
    results.back().nearest = std::min(results.back().nearest, extremes.nearest);
    results.back().peak_force = std::max(results.back().peak_force, extremes.peak_force);
  }
  return results;
}

std::vector<ModuleResult> module_results(const network::Network& network) {
  std::vector<ModuleResult> results;
  for (const network::Node& node : network.nodes()) {
    ModuleResult result;
    result.name = node.name;
    result.passive = node.traits.passive && !node.traits.measures_flow;
    result.ledger = node.ledger;
    if (const auto* walls = std::get_if<network::Obstacle>(&node.module)) {
      result.passivity = walls->passivity();
    } else if (const auto* limits = std::get_if<network::Limits>(&node.module)) {
      result.passivity = limits->passivity();
    } else if (const auto* joints = std::get_if<network::PumaJoints>(&node.module)) {
      result.sampling_energy = joints->sampling_energy();
    }
    results.push_back(result);
  }
  return results;
}

template <TorqueDrivenArm Arm>
void run_with(Arm& arm, Cell& cell, RunResult& result, const std::atomic<bool>& stop,
              const std::function<void(const Progress&)>& show) {
  const RunOptions& options = result.options;
  const double period_s = 1.0 / options.rate_hz;
  const nanoseconds period(std::llround(1e9 * period_s));
  result.deadline = DeadlineMonitor(period);
  const auto ticks = static_cast<std::int64_t>(std::llround(options.seconds * options.rate_hz));
  network::Network network = scene::build_network(result.scene, cell.model, options.rate_hz);
  const std::int64_t kept = options.keep_records ? std::min<std::int64_t>(ticks, 4000000) : 0;
  Recorder recorder(static_cast<std::size_t>(kept));
  Mailbox<Progress> progress({});
  const ProgressThread printing(progress, show);

  result.machine = host::describe_machine(options.fast ? "not by the clock"
                                                       : host::to_text(host::request_real_time()));
  Coprocessor coprocessor(cell.world, coprocessor_options(result, period));
  network::ScriptedOperator the_operator(result.scene.script);
  Teleoperator teleoperator(cell.model, arm, cell.kinematics, cell.world, cell.tool, coprocessor,
                            the_operator, std::move(network), period);
  SystemCallGuard::arm(options.fast ? Pauses::yields : Pauses::none);
  TickUsage usage;
  host::Metronome metronome(period);
  for (std::int64_t k = 1; k <= ticks && !stop; ++k) {
    const nanoseconds late =
        options.fast ? nanoseconds(0) : metronome.wait([&] { teleoperator.rehearse(); });
    usage.begin();
    const auto begin = steady_clock::now();
    const TickRecord* record = nullptr;
    {
      const host::HeapGuard heap;
      const SystemCallGuard system_calls;
      record = &teleoperator.tick(options.fast ? k * period : begin.time_since_epoch());
    }
    const auto end = steady_clock::now();
    usage.end();
    const auto arm_begin = steady_clock::now();
    arm.step(period_s);
    result.arm_step.record(steady_clock::now() - arm_begin);
    result.deadline.record(late, end - begin);
    result.totals.add(*record);
    result.network_time.record(record->network_time);
    result.most_support_pairs = std::max(result.most_support_pairs, record->pairs.iterations);
    result.compute += end - begin;
    result.over_budget += over_budget(result.scene.budget, end - begin) ? 1 : 0;
    if (options.keep_records) recorder.add(*record);
    progress.draft() = progress_of(*record, result);
    progress.post();
    if (!options.fast) result.skipped_ticks += metronome.catch_up();
  }
  coprocessor.stop();
  result.modules = module_results(teleoperator.network());
  result.obstacles = obstacle_results(cell, coprocessor);
  find_nearest(cell.world, coprocessor, result);
  result.interrupted = stop;
  result.allocations_in_tick = host::HeapGuard::allocations();
  result.system_calls_in_tick = SystemCallGuard::calls();
  result.page_faults_in_tick = usage.page_faults();
  result.voluntary_switches_in_tick = usage.voluntary_switches();
  result.involuntary_switches_in_tick = usage.involuntary_switches();
  result.records = recorder.records();
  result.records_dropped = options.keep_records ? recorder.dropped() : 0;
}

/// Joints of an arm without dynamics of its own: what the motors and the heaviest pose would weigh.
std::vector<IdealJoint> ideal_joints(const ArmModel& model) {
  std::vector<IdealJoint> joints;
  for (const ArmLink& link : model.links) {
    joints.push_back({std::max(0.1, link.rotor_inertia), std::max(1.0, link.viscous_friction)});
  }
  return joints;
}

}  // namespace

double support_pairs_per_period(const RunResult& result) {
  const double seconds = std::chrono::duration<double>(result.compute).count();
  if (!(seconds > 0.0)) return 0.0;
  return static_cast<double>(result.totals.iterations) / (seconds * result.options.rate_hz);
}

RunResult run(const scene::Scene& scene, const RunOptions& options, const std::atomic<bool>& stop,
              const std::function<void(const Progress&)>& show) {
  RunResult result;
  result.options = options;
  result.scene = scene;
  result.scene.budget = budget_of(scene, options.budget, options.rate_hz);
  const bool ideal = options.backend == "ideal";
  Cell cell(scene, !ideal);
  result.pairs = static_cast<int>(cell.world.pairs().size());
  result.device_damping = cell.device_damping();
  try {
    result.warnings = check_gains(cell.world, 1.0 / options.rate_hz, result.device_damping,
                                  scene.network.gain_check);
  } catch (const SetupError& error) {
    throw SetupError(std::string("wall too stiff: ") + error.what() +
                         " (to run all the same: 'gain_check: warning' at the obstacle module)",
                     scene.file);
  }
  result.threads = std::min(options.threads, detail::PairWorker::blocks_of(cell.world));
  const auto with = [&](auto arm) {
    arm.reset(cell.start);
    run_with(arm, cell, result, stop, show);
  };
  if (ideal) {
    with(IdealArm(ideal_joints(cell.model)));
  } else if (options.backend == "reference") {
    with(ReferenceArm(cell.model));
  } else if (options.backend == "ode") {
#ifdef REPEL_TELEOP_ODE
    with(ode::Arm(cell.model));
#else
    throw SetupError("backend ode is not built in; to have it: apt-get install libode-dev");
#endif
  } else {
#ifdef REPEL_TELEOP_BULLET
    with(bullet::Arm(cell.model));
#else
    throw SetupError("backend bullet is not built in; to have it: apt-get install libbullet-dev");
#endif
  }
  return result;
}

}  // namespace repel::teleop
