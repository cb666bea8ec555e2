#include "run.hpp"

#include <pthread.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>
#include <type_traits>

#include <repel/base/complaint.hpp>
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
#include "contact.hpp"
#include "crew.hpp"
#include "fade_out.hpp"
#include "heap_guard.hpp"
#include "pace.hpp"
#include "replay.hpp"
#include "results.hpp"
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
            if (!box.take()) continue;
            const std::string why = complaint_of([&] { show(box.newest()); });
            if (why.empty()) continue;
            std::fprintf(stderr, "Progress is not shown any more, the run goes on: %s\n",
                         why.c_str());
            return;
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

std::int64_t ticks_of(const RunOptions& options, const Recording* recording) {
  if (recording != nullptr) return static_cast<std::int64_t>(recording->ticks());
  return std::llround(options.seconds * options.rate_hz);
}

/// Half a gigabyte of records, 20 minutes at 400 Hz.
constexpr std::int64_t most_kept = 500000;

/// Of how many ticks the records are kept.
std::int64_t kept_ticks(const RunOptions& options, std::int64_t ticks) {
  return options.keep_records ? std::min<std::int64_t>(ticks, most_kept) : 0;
}

// Each by itself: a copy of an empty recorder has no room.
std::vector<Recorder> recorders_for(const RunOptions& options, std::size_t arms,
                                    std::int64_t ticks) {
  const std::int64_t kept = kept_ticks(options, ticks);
  std::vector<Recorder> recorders;
  for (std::size_t i = 0; i < arms; ++i) recorders.emplace_back(static_cast<std::size_t>(kept));
  return recorders;
}

/// What is kept of a tick, outside of it.
void note_tick(std::span<const TickRecord* const> records, const TickTimes& times,
               RunResult& result, std::vector<Recorder>& recorders) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    result.arms[i].totals.add(*records[i]);
    result.network_time.record(records[i]->network_time);
    if (result.options.keep_records) recorders[i].add(*records[i]);
  }
  result.most_support_pairs =
      std::max(result.most_support_pairs, records.front()->pairs.iterations);
  result.deadline.record(times.late, times.compute);
  result.compute += times.compute;
  result.over_budget += over_budget(result.scene.budget, times.compute) ? 1 : 0;
  if (result.times.size() < result.times.capacity()) result.times.push_back(times);
}

Beating beating_of(const RunOptions& options, const Company& company) {
  if (company.recording != nullptr && company.controls != nullptr) return Beating::shown;
  return options.fast ? Beating::at_once : Beating::by_the_clock;
}

/// Puts what was recorded of the tick in the place of arms and operators.
template <class Arm>
void follow(const Recording& recording, std::size_t tick, std::span<Arm> arms, Crew<Arm>& crew) {
  if constexpr (std::is_same_v<Arm, RecordedArm>) {
    for (std::size_t i = 0; i < arms.size(); ++i) {
      arms[i].follow(recording.arms[i][tick]);
      crew.follow(i, recording.arms[i][tick]);
    }
  }
}

/// All that outlives a tick.
template <TorqueDrivenArm Arm>
struct Shift {
  std::span<Arm> arms;
  Cell& cell;
  RunResult& result;
  const Company& company;
  const std::atomic<bool>& stop;
};

/// What the hand is to feel, faded as the forces on the arm are.
void show_force(devices::DeviceLink* device, const TickRecord& record) {
#ifdef REPEL_TELEOP_DEVICES
  if (device == nullptr) return;
  const Wrench& F = record.virtual_force;
  device->servo_cf(record.gain * record.lever_torque,
                   {record.gain * F.force, record.gain * F.torque});
#else
  (void)device;
  (void)record;
#endif
}

/// Tells those who look on of a tick, outside of it.
void show_tick(const Company& company, const Coprocessor& coprocessor, bool fast,
               std::span<const TickRecord* const> records, const TickTimes& times) {
  if (company.tap == nullptr) return;
  // Not by the clock a log is whole: the run waits for it.
  while (fast && company.tap->has_log() && company.tap->log().full()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  company.tap->note(coprocessor, records, times);
}

/// When a tick was due that begins now, `late` [ns].
nanoseconds due_before(nanoseconds late) noexcept {
  return std::chrono::duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()) - late;
}

/// A simulated arm has a clock of its own: it goes on where no tick is made.
template <TorqueDrivenArm Arm>
void move_on(std::span<Arm> arms, double period, std::int64_t periods) {
  for (std::int64_t i = 0; i < periods; ++i) {
    for (Arm& arm : arms) arm.step(period);
  }
}

/// The ticks, one after the other.
template <TorqueDrivenArm Arm>
void make_ticks(const Shift<Arm>& shift, Crew<Arm>& crew, const Coprocessor& coprocessor,
                std::vector<Recorder>& recorders, Mailbox<Progress>& progress, TickUsage& usage) {
  RunResult& result = shift.result;
  const RunOptions& options = result.options;
  const Recording* recording = shift.company.recording;
  const double period_s = 1.0 / options.rate_hz;
  const nanoseconds period(std::llround(1e9 * period_s));
  Pace pace(beating_of(options, shift.company), period, shift.company.controls);
  const std::int64_t ticks = ticks_of(options, recording);
  std::span<const TickRecord* const> records;
  TickTimes times;
  RegularClock clock(recording, period);
  const auto show_last = [&] {
    if (shift.company.tap != nullptr && !records.empty())
      shift.company.tap->show(coprocessor, records, times);
  };
  FadeOut fade(shift.stop, recording == nullptr ? shift.company.at_once : &shift.stop, period_s);
  for (std::int64_t k = 0; k < ticks && !fade.is_over(records); ++k) {
    if (fade.has_begun()) crew.let_go();
    const auto tick = static_cast<std::size_t>(k);
    const double time = period_s * static_cast<double>(k);
    if (pace.begins_anew(time)) break;
    const nanoseconds late = pace.wait(
        time, shift.stop, [&] { crew.rehearse(); }, show_last);
    const nanoseconds due = due_before(late) - pace.paused_for();
    const std::int64_t lost = pace.catch_up();
    result.skipped_ticks += lost;
    result.deadline.skip(lost);
    move_on(shift.arms, period_s, lost);
    k += lost;
    if (recording != nullptr) follow(*recording, tick, shift.arms, crew);
    usage.begin();
    const auto begin = steady_clock::now();
    {
      const host::HeapGuard heap;
      const SystemCallGuard system_calls;
      records = crew.tick(options.fast ? clock.next(tick) : due + lost * period);
    }
    const auto end = steady_clock::now();
    usage.end();
    times = {late, end - begin};
    const auto arm_begin = steady_clock::now();
    move_on(shift.arms, period_s, 1);
    result.arm_step.record(steady_clock::now() - arm_begin);
    note_tick(records, times, result, recorders);
    if (recording != nullptr) compare(*recording, tick, records, result.replay);
    show_force(shift.company.device, *records.front());
    show_tick(shift.company, coprocessor, options.fast, records,
              recording == nullptr ? times : recording->times[tick]);
    if (pace.has_arrived()) show_last();
    progress.draft() = progress_of(*records.front(), result);
    progress.post();
  }
  if (recording != nullptr) {
    show_last();
    pace.rest(shift.stop);
  }
  result.begins_anew = !shift.stop && pace.begins_anew(options.seconds);
}

template <TorqueDrivenArm Arm>
void run_with(const Shift<Arm>& shift, const std::function<void(const Progress&)>& show) {
  RunResult& result = shift.result;
  const RunOptions& options = result.options;
  const nanoseconds period(std::llround(1e9 / options.rate_hz));
  const std::int64_t ticks = ticks_of(options, shift.company.recording);
  result.deadline = DeadlineMonitor(period);
  std::vector<Recorder> recorders = recorders_for(options, shift.arms.size(), ticks);
  result.times.reserve(static_cast<std::size_t>(kept_ticks(options, ticks)));
  Mailbox<Progress> progress({});
  const ProgressThread printing(progress, show);

  const host::Grant grant = options.fast ? host::Grant{} : host::request_real_time();
  result.machine = host::describe_machine(options.fast ? "not by the clock" : host::to_text(grant));
  Coprocessor coprocessor(shift.cell.world, coprocessor_options(result, period));
  if (shift.company.tap != nullptr) shift.company.tap->watch(shift.cell.world);
  Crew<Arm> crew(result.scene, shift.cell, shift.arms, coprocessor, shift.company.controls,
                 shift.company.device, options);
  SystemCallGuard::arm(options.fast ? Pauses::yields : Pauses::none);
  if (grant.priority > 0) host::clear_own_processor();
  TickUsage usage;
  make_ticks(shift, crew, coprocessor, recorders, progress, usage);
  coprocessor.stop();
  for (std::size_t i = 0; i < shift.arms.size(); ++i) {
    result.arms[i].modules = module_results(crew.members()[i].network());
    result.arms[i].records = recorders[i].records();
    if constexpr (requires { shift.arms[i].contact(); })
      result.arms[i].contact = shift.arms[i].contact();
  }
  note_pairs(shift.cell.world, coprocessor, result);
  result.interrupted = shift.stop;
  result.allocations_in_tick = host::HeapGuard::allocations();
  result.system_calls_in_tick = SystemCallGuard::calls();
  result.page_faults_in_tick = usage.page_faults();
  result.voluntary_switches_in_tick = usage.voluntary_switches();
  result.involuntary_switches_in_tick = usage.involuntary_switches();
}

/// Joints of an arm without dynamics of its own: what the motors and the heaviest pose would weigh.
std::vector<IdealJoint> ideal_joints(const ArmModel& model) {
  std::vector<IdealJoint> joints;
  for (const ArmLink& link : model.links) {
    joints.push_back({std::max(0.1, link.rotor_inertia), std::max(1.0, link.viscous_friction),
                      brake_torque(model, static_cast<int>(joints.size()))});
  }
  return joints;
}

/// Time without torques [s] after which a simulated arm stops; more than a period of a slow tick.
double watchdog_of(const RunOptions& options) {
  return std::max(0.1, 5.0 / options.rate_hz);
}

}  // namespace

double support_pairs_per_period(const RunResult& result) {
  const double seconds = std::chrono::duration<double>(result.compute).count();
  if (!(seconds > 0.0)) return 0.0;
  return static_cast<double>(result.totals().iterations) / (seconds * result.options.rate_hz);
}

scene::Scene as_run(const scene::Scene& scene, const RunOptions& options) {
  scene::Scene result = scene;
  result.budget = budget_of(scene, options.budget, options.rate_hz);
  if (options.tool_alone) {
    result.robot.links.emplace();
    for (scene::Partner& partner : result.partners) partner.robot.links.emplace();
  }
  return result;
}

RunResult run(const scene::Scene& scene, const RunOptions& options, const Company& company,
              const std::atomic<bool>& stop, const std::function<void(const Progress&)>& show) {
  RunResult result;
  result.options = options;
  result.scene = as_run(scene, options);
  const bool ideal = options.backend == "ideal";
  Cell cell(result.scene, !ideal);
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
  if (company.recording == nullptr) cell.require_clear_start(scene);  // one has started already
  for (const std::string& overlap : cell.overlaps()) result.warnings.push_back(overlap);
  result.threads = std::min(options.threads, detail::PairWorker::blocks_of(cell.world));
  for (const Manipulator& arm : cell.arms) {
    const std::size_t before = result.arms.size();
    ArmResult& added = result.arms.emplace_back();
    if (before > 0) added.name = scene.partners[before - 1].name;
    for (const ArmLink& link : arm.robot.arm.links) added.joints.push_back(link.type);
  }
  const auto with = [&](auto make) {
    using Arm = decltype(make(cell.arm().robot.arm, std::vector<ContactPart>{}));
    std::vector<Arm> arms;
    for (std::size_t i = 0; i < cell.arms.size(); ++i) {
      const Manipulator& each = cell.arms[i];
      std::vector<ContactPart> parts;
      if (options.contact) parts = contact_parts(scene, scene.station(i), each.robot);
      arms.push_back(make(each.robot.arm, parts));
      arms.back().reset(each.start);
    }
    run_with(Shift<Arm>{std::span(arms), cell, result, company, stop}, show);
  };
  const double watchdog = watchdog_of(options);
  if (company.recording != nullptr) {
    std::vector<RecordedArm> arms;
    for (const auto& records : company.recording->arms) arms.emplace_back(records.front());
    run_with(Shift<RecordedArm>{std::span(arms), cell, result, company, stop}, show);
  } else if (ideal) {
    with([&](const ArmModel& model, const auto&) {
      return IdealArm(ideal_joints(model), {.watchdog = watchdog});
    });
  } else if (options.backend == "reference") {
    with([&](const ArmModel& model, const auto&) {
      return ReferenceArm(model, {.watchdog = watchdog});
    });
  } else if (options.backend == "ode") {
#ifdef REPEL_TELEOP_ODE
    with([&](const ArmModel& model, const auto& parts) {
      return ode::Arm(model, {.watchdog = watchdog}, parts);
    });
#else
    throw SetupError("backend ode is not built in; to have it: apt-get install libode-dev");
#endif
  } else {
#ifdef REPEL_TELEOP_BULLET
    with([&](const ArmModel& model, const auto& parts) {
      return bullet::Arm(model, {.watchdog = watchdog}, parts);
    });
#else
    throw SetupError("backend bullet is not built in; to have it: apt-get install libbullet-dev");
#endif
  }
  return result;
}

}  // namespace repel::teleop
