// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/station/station.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <repel/host/figure.hpp>
#include <repel/host/heap_guard.hpp>
#include <repel/host/machine.hpp>
#include <repel/host/metronome.hpp>
#include <repel/host/times.hpp>
#include <repel/link/link_thread.hpp>
#include <repel/runs/engine/fade_out.hpp>
#include <repel/runs/engine/progress_thread.hpp>
#include <repel/runs/operator/device.hpp>
#include <repel/runs/report/network_report.hpp>
#include <repel/runs/station/station_side.hpp>
#include <repel/runs/station/station_view.hpp>
#include <repel/runs/watch/system_call_guard.hpp>

namespace repel::runs {
namespace {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

void show_to(devices::DeviceLink* device, const StationSide& station) {
#ifdef REPEL_RUNS_DEVICES
  if (device == nullptr) return;
  const Wrench F = station.has_handle() ? station.grip() : station.site().virtual_force;
  const double gain = station.is_heard() ? station.site().gain : 0.0;
  device->servo_cf(gain * station.felt(), {gain * F.force, gain * F.torque});
#else
  (void)device;
  (void)station;
#endif
}

/// [s] for which a station that was stopped still says so: the robot is then held by a hand at rest
/// instead of by a silence.
constexpr double farewell = 0.1;

/// @param view null: none
void make_ticks(StationSide& station, const network::RemoteLink& link, devices::DeviceLink* device,
                StationView* view, const std::atomic<bool>& stop, StationResult& result,
                Mailbox<Progress>& progress) {
  const double period_s = 1.0 / result.options.rate_hz;
  const nanoseconds period(std::llround(1e9 * period_s));
  host::Metronome metronome(period);
  const std::int64_t ticks = std::llround(result.options.seconds * result.options.rate_hz);
  std::int64_t lost = 0;
  double left = farewell;
  for (std::int64_t k = 0; k < ticks && left > 0.0; ++k) {
    if (stop) {
      station.let_go();
      left -= period_s;
    }
    const nanoseconds late = metronome.wait([] {});
    const nanoseconds due = host::steady_now() - late;
    const auto begin = steady_clock::now();
    {
      const host::HeapGuard heap;
      const SystemCallGuard system_calls;
      station.tick(due, period_s * static_cast<double>(1 + lost));
    }
    const TickTimes times{late, steady_clock::now() - begin};
    result.deadline.record(times.late, times.compute);
    note_round_trips(link, result.link);
    ++result.ticks;
    result.linked += station.is_heard() ? period_s : 0.0;
    const SiteState& site = station.site();
    result.peak_lever_torque = std::max(result.peak_lever_torque, std::abs(station.felt()));
    const network::Vec<6> felt = station.felt_at_handle();
    result.peak_hand_force = std::max(result.peak_hand_force, felt.head<3>().norm());
    result.peak_hand_torque = std::max(result.peak_hand_torque, felt.tail<3>().norm());
    result.peak_virtual_force =
        std::max(result.peak_virtual_force, site.virtual_force.force.norm());
    if (station.is_heard() && site.is_told) result.nearest = std::min(result.nearest, site.nearest);
    show_to(device, station);
    if (view != nullptr) view->note(station, k, times);
    progress.draft() = {
        period_s * static_cast<double>(k), station.phase(),  site.nearest,
        site.virtual_force.force.norm(),   station.status(), result.deadline.misses()};
    progress.post();
    lost = metronome.catch_up(std::chrono::milliseconds(50));
    result.skipped_ticks += lost;
    result.deadline.skip(lost);
    k += lost;
  }
}

}  // namespace

StationResult run_station(const scene::Scene& scene, const RunOptions& options,
                          const SessionOptions& session, const std::atomic<bool>& stop,
                          const std::function<void(const Progress&)>& show) {
  StationResult result;
  result.options = options;
  result.scene = scene;
  const nanoseconds period(std::llround(1e9 / options.rate_hz));
  result.deadline = DeadlineMonitor(period);
  const Device device = open_device(session.device);
  network::RemoteLink link(remote_options(scene));
  StationControls controls(session);
  StationSide station(scene, options, link, device.link.get(), session.view ? &controls : nullptr);
  require_passive_grip(device, station.network());
  // Their threads must not inherit the real-time priority.
  std::unique_ptr<StationView> view;
  if (session.view) {
    view = std::make_unique<StationView>(scene, options, session, device.name, station, controls);
  }
  link::LinkThread thread(link, open_link(session.link, scene));
  Mailbox<Progress> progress({});
  const ProgressThread printing(progress, show);
  const host::Grant grant = host::request_real_time();
  result.machine = host::describe_machine(host::to_text(grant));
  SystemCallGuard::arm(Pauses::none);
  if (grant.priority > 0) host::clear_own_processor();
  make_ticks(station, link, device.link.get(), view.get(), stop, result, progress);
  thread.stop();
  note_link(link, thread, result.link);
  result.has_handle = station.has_handle();
  result.modules = module_results(station.network());
  result.interrupted = stop;
  result.allocations_in_tick = host::HeapGuard::allocations();
  result.system_calls_in_tick = SystemCallGuard::calls();
  return result;
}

void print_station(const StationResult& r, std::FILE* out) {
  std::fprintf(out, "\n%s: station, %lld ticks at %g Hz (%.2f s)%s\n", r.scene.name.c_str(),
               static_cast<long long>(r.ticks), r.options.rate_hz,
               static_cast<double>(r.ticks) / r.options.rate_hz,
               r.interrupted ? ", until it was stopped" : "");
  host::print_times("compute of the tick", r.deadline.compute(), out);
  host::print_times("wake-up lateness", r.deadline.wakeup(), out);
  std::fprintf(out, "  deadline misses        %lld, skipped ticks %lld\n",
               static_cast<long long>(r.deadline.misses()),
               static_cast<long long>(r.skipped_ticks));
  host::print_allocations(r.allocations_in_tick, out);
  print_link(r.link, out);
  std::fprintf(out, "  site heard for         %.2f s\n", r.linked);
  if (r.has_handle) {
    std::fprintf(out, "  felt at the handle     %s N and %s N m at most\n",
                 host::figure(r.peak_hand_force, 2).c_str(),
                 host::figure(r.peak_hand_torque, 3).c_str());
  } else {
    std::fprintf(out, "  lever torque felt      %s N m at most\n",
                 host::figure(r.peak_lever_torque, 3).c_str());
  }
  std::fprintf(out, "  virtual force          %s N on the tool at most, as the site says\n",
               host::figure(r.peak_virtual_force, 2).c_str());
  if (r.nearest < 1e9) {
    std::fprintf(out, "  nearest                %s mm, as the site says\n",
                 host::figure(1e3 * r.nearest, 3).c_str());
  }
}

void write_station_json(const StationResult& r, std::ostream& out) {
  nlohmann::ordered_json report;
  report["scene"] = r.scene.name;
  report["side"] = "station";
  report["rate_hz"] = r.options.rate_hz;
  report["ticks"] = r.ticks;
  report["interrupted"] = r.interrupted;
  report.update(host::to_json(r.deadline, r.skipped_ticks));
  report["link"] = link_to_json(r.link);
  report["site_heard_s"] = r.linked;
  report["peak_lever_torque_n_m"] = r.peak_lever_torque;
  report["peak_hand_force_n"] = r.peak_hand_force;
  report["peak_hand_torque_n_m"] = r.peak_hand_torque;
  report["peak_force_n"] = r.peak_virtual_force;
  report["nearest_m"] = r.nearest < 1e9 ? nlohmann::ordered_json(r.nearest) : nullptr;
  report["modules"] = modules_to_json(r.modules);
  report["allocations_in_tick"] = host::known(r.allocations_in_tick);
  report["system_calls_in_tick"] = host::known(r.system_calls_in_tick);
  report["machine"] = host::to_json(r.machine);
  host::write(report, out);
}

}  // namespace repel::runs
