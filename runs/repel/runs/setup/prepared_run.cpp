// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/setup/prepared_run.hpp>

#include <pthread.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include <repel/host/heap_guard.hpp>
#include <repel/host/machine.hpp>
#include <repel/runs/arms/arm_backend.hpp>
#include <repel/runs/options/budget.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/runs/watch/system_call_guard.hpp>
#include <repel/scene/build_network.hpp>

namespace repel::runs {
namespace {

using std::chrono::nanoseconds;

/// Start of a coprocessor thread, which only runs ticks.
void begin_worker_in_lock_step(int index) noexcept {
  char name[16];  // as shown by `ps -L` and /proc, up to 15 characters
  (void)std::snprintf(name, sizeof name, "repel pairs %d", index);
  (void)pthread_setname_np(pthread_self(), name);
  SystemCallGuard::arm(Pauses::naps);
  host::HeapGuard::watch_this_thread();
  SystemCallGuard::watch_this_thread();
}
void begin_worker(int index) noexcept {
  (void)host::follow_real_time();
  begin_worker_in_lock_step(index);
}

CoprocessorOptions coprocessor_options(const scene::Budget& budget, const RunOptions& options) {
  const nanoseconds period(std::llround(1e9 / options.rate_hz));
  CoprocessorOptions result;
  result.threads = options.threads;
  result.mode = options.coprocessor;
  result.patience = period / 4;
  result.lock_step = options.fast;
  result.on_thread_start = options.fast ? &begin_worker_in_lock_step : &begin_worker;
  result.every_pair = options.every_pair;
  result.budget.work_units = budget.work_units;
  result.budget.max_age = budget.max_age;
  // A wall-clock budget would make runs differ, so without real time only the counted budget
  // applies.
  if (!options.fast) {
    result.budget.wall = nanoseconds(std::llround(1e3 * budget.wall_us));
    if (result.budget.wall.count() > 0) result.patience = result.budget.wall + period / 20;
  }
  return result;
}

/// The scene with the changes made by the options.
scene::Scene as_run(const scene::Scene& scene, const RunOptions& options) {
  scene::Scene result = scene;
  result.budget = budget_of(scene, options.budget, options.rate_hz);
  result.measure = measure_named(options.measure).value_or(scene.measure);
  if (options.levels > 0) result.levels = options.levels;
  if (options.tool_alone) {
    result.robot.links.emplace();
    for (scene::OtherArm& partner : result.partners) partner.robot.links.emplace();
  }
  if (!arm_backend(options.backend).has_gravity) {  // nothing there has a weight
    result.robot.payload = {};
    for (scene::OtherArm& partner : result.partners) partner.robot.payload = {};
  }
  return result;
}

/// All walls of the cell hold as the option says.
void set_hold(CellDescription& cell, const std::string& word) {
  if (word.empty()) return;
  const HoldKind kind = word == "hard" ? HoldKind::hard : HoldKind::soft;
  const auto set = [kind](ForceLaw& law) {
    if (!law.passable) law.hold = kind;
  };
  for (ObstacleDescription& obstacle : cell.obstacles) set(obstacle.law);
  for (LooseDescription& loose : cell.loose) set(loose.law);
  for (ArmDescription& arm : cell.arms) {
    set(arm.law);
    if (arm.self_law) set(*arm.self_law);
  }
}

/// The faults of the first arm, in its kinematics by now; null: none. What they did to readings,
/// command, clock and drive stands in a recording already.
std::unique_ptr<faults::InjectedFaults> inject(const RunOptions& options, bool is_replay,
                                               CellDescription& cell) {
  std::vector<faults::Choice> chosen = options.faults;
  if (is_replay) {
    std::erase_if(chosen, [](const faults::Choice& each) {
      return faults::fault_named(each.name).kind != faults::Kind::kinematics;
    });
  }
  if (chosen.empty()) return nullptr;
  ArmDescription& arm = cell.arms.front();
  auto injected = std::make_unique<faults::InjectedFaults>(chosen, arm, options.rate_hz);
  arm.kinematics = injected->spoilt(std::move(arm.kinematics));
  return injected;
}

}  // namespace

RunOptions options_of(const scene::Scene& scene) {
  RunOptions options;
  options.rate_hz = scene.rate_hz;
  options.threads = scene.budget.threads;
  options.coprocessor = scene.coprocessor;
  return options;
}

std::unique_ptr<PreparedRun> prepare(const scene::Scene& scene, const RunOptions& options,
                                     const Recording* recording, network::RemoteLink* remote) {
  scene::Scene changed = as_run(scene, options);
  DescribedScene described =
      describe(changed, options.rate_hz, arm_backend(options.backend).has_gravity, remote);
  if (recording != nullptr) require_recorded_lists(*recording, described.part_lists);
  changed.part_lists.insert(changed.part_lists.end(), described.part_lists.begin(),
                            described.part_lists.end());
  changed.obstacles.insert(changed.obstacles.end(), described.model_obstacles.begin(),
                           described.model_obstacles.end());
  set_hold(described.cell, options.hold);
  described.cell.coprocessor = coprocessor_options(changed.budget, options);
  for (ArmDescription& arm : described.cell.arms) {
    arm.options.joints.touches = arm.options.joints.touches || options.contact;
    arm.options.prediction = options.prediction;
  }
  const bool refuses = described.cell.start_inside == StartInside::refuse;
  // A recorded run was allowed to start.
  if (recording != nullptr && refuses) described.cell.start_inside = StartInside::allow;
  auto injected = inject(options, recording != nullptr, described.cell);
  try {
    return std::make_unique<PreparedRun>(std::move(changed), options, std::move(described),
                                         std::move(injected));
  } catch (const SetupError& error) {
    throw scene::located(scene, error);
  }
}

}  // namespace repel::runs
