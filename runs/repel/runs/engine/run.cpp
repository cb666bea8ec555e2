// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/engine/run.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include <repel/host/heap_guard.hpp>
#include <repel/host/machine.hpp>
#include <repel/network/modules/six_axes.hpp>
#include <repel/network/modules/torque_arm.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/runs/arms/arm_backend.hpp>
#include <repel/runs/arms/contact.hpp>
#include <repel/runs/arms/loaded_arm.hpp>
#include <repel/runs/arms/servoed_arm.hpp>
#include <repel/runs/cameras/camera_feeds.hpp>
#include <repel/runs/engine/driven_cell.hpp>
#include <repel/runs/engine/fade_out.hpp>
#include <repel/runs/engine/progress_thread.hpp>
#include <repel/runs/operator/pace.hpp>
#include <repel/runs/records/replay.hpp>
#include <repel/runs/report/link_laws.hpp>
#include <repel/runs/watch/chatter.hpp>
#include <repel/runs/watch/system_call_guard.hpp>
#include <repel/runs/watch/tick_usage.hpp>
#include <repel/simulated/changed_arm.hpp>
#include <repel/simulated/delayed_arm.hpp>
#include <repel/simulated/sensed_arm.hpp>

namespace repel::runs {
namespace {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

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

/// 500 MB of records, 20 minutes at 400 Hz.
constexpr std::int64_t most_kept = 500000;

/// The number of ticks whose records are kept.
std::int64_t kept_ticks(const RunOptions& options, std::int64_t ticks) {
  return options.keep_records ? std::min<std::int64_t>(ticks, most_kept) : 0;
}

/// What is measured of every tick of every arm, with memory from set-up on.
struct Observers {
  std::vector<Recorder> recorders;
  std::vector<ArmChatterMeter> chatter;
};

// Constructed one by one: a copy of an empty recorder would lose the reserved capacity.
Observers observers_for(const RunOptions& options, const Cell& cell, std::int64_t ticks) {
  const std::int64_t kept = kept_ticks(options, ticks);
  Observers observers;
  for (std::size_t i = 0; i < cell.arms(); ++i) {
    observers.recorders.emplace_back(static_cast<std::size_t>(kept));
    const bool has_lever = cell.network(i).find<network::TorqueArm>() != nullptr;
    observers.chatter.emplace_back(cell.description().arms[i].model.links.size(), has_lever,
                                   options.rate_hz);
  }
  return observers;
}

/// Records the results of a tick, outside of the measured time.
void note_tick(std::span<const TickRecord* const> records, const TickTimes& times,
               RunResult& result, Observers& observers) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    result.arms[i].totals.add(*records[i]);
    result.network_time.record(records[i]->network_time);
    observers.chatter[i].add(*records[i]);
    if (result.options.keep_records) observers.recorders[i].add(*records[i]);
  }
  result.most_support_pairs =
      std::max(result.most_support_pairs, records.front()->pairs.iterations);
  result.deadline.record(times.late, times.compute);
  result.compute += times.compute;
  result.over_budget += over_budget(result.scene.budget, times.compute) ? 1 : 0;
  if (result.times.size() < result.times.capacity()) result.times.push_back(times);
}

Pacing pacing_of(const RunOptions& options, const Attachments& attached) {
  if (attached.recording != nullptr && attached.controls != nullptr) return Pacing::shown;
  return options.fast ? Pacing::at_once : Pacing::by_the_clock;
}

/// Sends the forces to the device, faded by the same gain as those on the arm.
/// @param has_handle the device is the hand of SIX AXES
void show_force(devices::DeviceLink* device, const TickRecord& record, bool has_handle) {
#ifdef REPEL_RUNS_DEVICES
  if (device == nullptr) return;
  const Wrench& F = has_handle ? record.grip : record.virtual_force;
  device->servo_cf(record.gain * record.lever_torque,
                   {record.gain * F.force, record.gain * F.torque});
#else
  (void)device;
  (void)record;
  (void)has_handle;
#endif
}

/// Passes a tick to the tap, outside of the measured time.
void show_tick(const Attachments& attached, const Coprocessor& coprocessor, bool fast,
               std::span<const TickRecord* const> records, const TickTimes& times) {
  if (attached.tap == nullptr) return;
  // Without real time the log is complete: the run waits for it.
  while (fast && attached.tap->has_log() && attached.tap->log().full()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (attached.beside != nullptr) attached.beside->date(records.front()->tick);
  attached.tap->note(coprocessor, records, times);
}

/// When a tick was due that starts now and is `late` [ns].
nanoseconds due_before(nanoseconds late) noexcept {
  return std::chrono::duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()) - late;
}

/// The cameras of a scene; null without.
std::unique_ptr<CameraFeeds> make_cameras(PreparedRun& prepared, const Attachments& attached) {
  if (prepared.scene.cameras.empty()) return nullptr;
  const bool in_step = prepared.options.fast || attached.recording != nullptr;
  Controls* const controls = attached.controls;
  BesideTicks* const beside = in_step ? attached.beside : nullptr;
  CameraListeners listeners;
  if (controls != nullptr || beside != nullptr) {
    listeners.on_add = [controls, beside](PartId part, const Shape& shape) {
      if (controls != nullptr) controls->shapes.note(part.index, shape);
      if (beside != nullptr) beside->shapes.note({part, shape});
    };
  }
  if (controls != nullptr || beside != nullptr) {
    listeners.on_image = [controls, beside,
                          &cameras = prepared.scene.cameras](const CameraImage& image) {
      DepthPicture picture = depth_picture(image.index, image.time, image.camera.width,
                                           image.camera.height, image.depth);
      if (controls != nullptr) {
        const std::string& name = cameras[image.index].name;
        controls->depths.note(name.empty() ? "camera" : name,
                              {picture.width, picture.height, picture.depth});
      }
      if (beside != nullptr) beside->pictures.note(std::move(picture));
    };
  }
  return std::make_unique<CameraFeeds>(prepared.scene, prepared.robots, prepared.cell, in_step,
                                       listeners);
}

/// Runs the ticks.
/// @param cameras null: none
void make_ticks(DrivenCell& driven, CameraFeeds* cameras, const Attachments& attached,
                const std::atomic<bool>& stop, RunResult& result, Observers& observers,
                Mailbox<Progress>& progress, TickUsage& usage) {
  const RunOptions& options = result.options;
  const Coprocessor& coprocessor = driven.cell().coprocessor();
  const Recording* recording = attached.recording;
  const double period_s = 1.0 / options.rate_hz;
  const nanoseconds period(std::llround(1e9 * period_s));
  Pace pace(pacing_of(options, attached), period, attached.controls);
  const std::int64_t ticks = ticks_of(options, recording);
  std::span<const TickRecord* const> records;
  TickTimes times;
  RegularClock clock(recording, period);
  const auto show_last = [&] {
    if (attached.tap != nullptr && !records.empty())
      attached.tap->show(coprocessor, records, times);
  };
  const bool has_handle = driven.cell().network(0).find<network::SixAxes>() != nullptr;
  FadeOut fade(stop, recording == nullptr ? attached.at_once : &stop, period_s);
  for (std::int64_t k = 0; k < ticks && !fade.is_over(records); ++k) {
    if (fade.has_begun()) driven.let_go();
    const auto tick = static_cast<std::size_t>(k);
    const double time = period_s * static_cast<double>(k);
    if (pace.begins_anew(time)) break;
    const nanoseconds late = pace.wait(
        time, stop, [&] { driven.rehearse(); }, show_last);
    if (recording == nullptr && pace.was_paused()) {
      for (ArmChatterMeter& meter : observers.chatter) meter.gap();
    }
    const nanoseconds due = due_before(late) - pace.paused_for();
    const std::int64_t lost = pace.catch_up();
    result.skipped_ticks += lost;
    result.deadline.skip(lost);
    driven.move_arms(period_s, lost);
    k += lost;
    if (recording != nullptr) driven.replay(*recording, tick);
    if (cameras != nullptr) driven.set_blind_for(cameras->silent_for());
    const nanoseconds now =
        driven.begin_tick(options.fast ? clock.next(tick) : due + lost * period, period_s);
    usage.begin();
    const auto begin = steady_clock::now();
    {
      const host::HeapGuard heap;
      const SystemCallGuard system_calls;
      records = driven.tick(now);
    }
    const auto end = steady_clock::now();
    usage.end();
    times = {late, end - begin};
    const auto arm_begin = steady_clock::now();
    driven.move_arms(period_s, 1);
    result.arm_step.record(steady_clock::now() - arm_begin);
    note_tick(records, times, result, observers);
    if (attached.remote != nullptr) note_round_trips(*attached.remote, *result.link);
    if (cameras != nullptr) cameras->follow(result.scene, records);
    if (recording != nullptr) compare(*recording, tick, records, result.replay);
    show_force(attached.device, *records.front(), has_handle);
    show_tick(attached, coprocessor, options.fast, records,
              recording == nullptr ? times : recording->times[tick]);
    if (attached.on_tick) attached.on_tick(driven.cell(), records);
    if (pace.has_arrived()) show_last();
    progress.draft() = progress_of(*records.front(), result);
    progress.post();
  }
  if (recording != nullptr) {
    show_last();
    pace.rest(stop);
  }
  result.begins_anew = !stop && pace.begins_anew(options.seconds);
}

/// Time without torques [s] after which a simulated arm stops; more than one period even at low
/// rates.
double watchdog_of(const RunOptions& options) {
  return std::max(0.1, 5.0 / options.rate_hz);
}

/// The arm that is simulated: that of the controller, with what the controller does not know. The
/// payload comes first, since a change of the inertia keeps the weight of what there is.
ArmModel simulated_model(const PreparedRun& prepared, std::size_t arm) {
  ArmModel model = prepared.robots[arm].arm;
  const scene::RobotChoice& robot = prepared.scene.arm_setup(arm).robot;
  if (!robot.payload_known) model = with_payload(std::move(model), robot.payload);
  const double factor = prepared.options.plant_inertia;
  return factor == 1.0 ? model : with_inertia(std::move(model), factor);
}

/// What the own controller of an arm that takes positions knows of it.
ArmModel known_model(const PreparedRun& prepared, std::size_t arm) {
  ArmModel model = prepared.robots[arm].arm;
  if (arm_backend(prepared.options.backend).has_gravity) return model;
  for (ArmLink& link : model.links) {
    link.mass = 0.0;
    link.I_C_L.setZero();
    link.rotor_inertia = std::max(least_ideal_inertia, link.rotor_inertia);
    link.coulomb_friction = 0.0;
  }
  return model;
}

/// Creates the arms of the cell, at their start positions.
std::vector<std::unique_ptr<TorqueDrivenArm>> make_arms(const PreparedRun& prepared,
                                                        const Recording* recording) {
  std::vector<std::unique_ptr<TorqueDrivenArm>> arms;
  const ArmBackend& backend = arm_backend(prepared.options.backend);
  for (std::size_t i = 0; i < prepared.cell.arms(); ++i) {
    if (recording != nullptr) {
      arms.push_back(std::make_unique<RecordedArm>(recording->arms[i].front()));
      continue;
    }
    const ArmDescription& arm = prepared.cell.description().arms[i];
    std::vector<ContactPart> parts;
    if (prepared.options.contact) {
      parts = contact_parts(prepared.scene, prepared.scene.arm_setup(i), prepared.robots[i]);
    }
    auto simulated =
        backend.make(simulated_model(prepared, i), arm.start, watchdog_of(prepared.options), parts);
    const SensorErrors& errors = prepared.scene.arm_setup(i).robot.sensor;
    if (!errors.none()) simulated = std::make_unique<SensedArm>(std::move(simulated), errors);
    if (!prepared.scene.loose.empty()) {
      simulated = std::make_unique<LoadedArm>(std::move(simulated), prepared.cell, i);
    }
    if (const auto& admittance = prepared.scene.arm_setup(i).robot.admittance) {
      simulated =
          std::make_unique<ServoedArm>(std::move(simulated), known_model(prepared, i), arm.model,
                                       admittance->response, 1.0 / prepared.options.rate_hz);
    }
    if (prepared.faults && i == 0) simulated = prepared.faults->spoilt(std::move(simulated));
    arms.push_back(std::make_unique<DelayedArm>(std::move(simulated), arm.model.links.size(),
                                                prepared.scene.arm_setup(i).robot.drive_delay));
  }
  return arms;
}

std::vector<OperatorInput> make_operators(const PreparedRun& prepared,
                                          const Attachments& attached) {
  std::vector<OperatorInput> operators;
  for (std::size_t i = 0; i < prepared.cell.arms(); ++i) {
    operators.emplace_back(prepared.scene.arm_setup(i).script, i == 0 ? attached.controls : nullptr,
                           i == 0 ? attached.device : nullptr);
    if (i < attached.tracks.size()) operators.back().follow(attached.tracks[i]);
    if (i < attached.hands.size()) operators.back().obey(attached.hands[i]);
  }
  return operators;
}

/// The part of the results that is known before the first tick.
RunResult result_of(const PreparedRun& prepared) {
  RunResult result;
  const Cell& cell = prepared.cell;
  result.options = prepared.options;
  result.scene = prepared.scene;
  result.pairs = static_cast<int>(cell.world().pairs().size());
  const std::vector<Part>& parts = cell.world().parts();
  const bool has_levels = std::any_of(parts.begin(), parts.end(), [&](const Part& part) {
    return needs_levels(part.shape, prepared.scene.measure);
  });
  if (has_levels) result.levels = prepared.scene.levels;
  result.device_damping = cell.device_damping();
  result.warnings = cell.warnings();
  result.threads = cell.coprocessor().threads();
  result.deadline = DeadlineMonitor(cell.period());
  for (const ArmDescription& arm : cell.description().arms) {
    ArmResult& added = result.arms.emplace_back();
    added.name = arm.name;
    added.stability = stability_budget(cell, result.arms.size() - 1);
    added.held = prepared.robots[result.arms.size() - 1].held;
    for (const ArmLink& link : arm.model.links) {
      added.joints.push_back(link.type);
      added.joint_names.push_back(link.joint_name);
    }
  }
  return result;
}

/// [N] By PairId, the hardest push that its wall withstood.
std::vector<double> withstood_by(const Cell& cell) {
  std::vector<double> pushes;
  pushes.reserve(cell.world().pairs().size());
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(cell.world().pairs().size()); ++i) {
    pushes.push_back(cell.withstood({i}));
  }
  return pushes;
}

}  // namespace

RunResult run(PreparedRun& prepared, const Attachments& attached, const std::atomic<bool>& stop,
              const std::function<void(const Progress&)>& show) {
  RunResult result = result_of(prepared);
  if (attached.remote != nullptr) result.link.emplace();
  const RunOptions& options = result.options;
  Cell& cell = prepared.cell;
  DrivenCell driven(cell, prepared.scene, make_arms(prepared, attached.recording),
                    make_operators(prepared, attached), attached.remote, prepared.faults.get());
  const std::int64_t ticks = ticks_of(options, attached.recording);
  Observers observers = observers_for(options, cell, ticks);
  result.times.reserve(static_cast<std::size_t>(kept_ticks(options, ticks)));
  Mailbox<Progress> progress({});
  const ProgressThread printing(progress, show);
  // Like that one, its thread must not inherit the real-time priority.
  const std::unique_ptr<CameraFeeds> cameras = make_cameras(prepared, attached);

  const host::Grant grant = options.fast ? host::Grant{} : host::request_real_time();
  result.machine = host::describe_machine(options.fast ? "not by the clock" : host::to_text(grant));
  if (attached.tap != nullptr) attached.tap->watch(cell.world());
  SystemCallGuard::arm(options.fast ? Pauses::yields : Pauses::none);
  if (grant.priority > 0) host::clear_own_processor();
  TickUsage usage(options.lock_memory);
  make_ticks(driven, cameras.get(), attached, stop, result, observers, progress, usage);
  result.worker_usage = cell.coprocessor().usage();
  cell.stop();
  if (cameras) result.camera = cameras->finish();
  for (std::size_t i = 0; i < cell.arms(); ++i) {
    result.arms[i].modules = module_results(cell.network(i));
    result.arms[i].records = observers.recorders[i].records();
    result.arms[i].chatter = observers.chatter[i].result();
    result.arms[i].contact = driven.arm(i).contact();
  }
  note_pairs(cell.world(), cell.coprocessor(), result, withstood_by(cell));
  note_steps(driven.steps(), result);
  note_link_laws(cell, result);
  result.interrupted = stop;
  result.allocations_in_tick = host::HeapGuard::allocations();
  result.system_calls_in_tick = SystemCallGuard::calls();
  result.page_faults_in_tick = usage.page_faults();
  result.voluntary_switches_in_tick = usage.voluntary_switches();
  result.involuntary_switches_in_tick = usage.involuntary_switches();
  return result;
}

}  // namespace repel::runs
