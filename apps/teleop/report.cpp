#include "report.hpp"

#include <algorithm>
#include <ostream>

#include "network_report.hpp"
#include "times.hpp"
#include "unused.hpp"

namespace repel::teleop {
namespace {

using nlohmann::ordered_json;

/// The obstacles that pushed, hardest first.
void print_obstacles(const RunResult& r, std::FILE* out) {
  constexpr std::size_t most = 10;
  std::vector<ObstacleResult> touched;
  for (const ObstacleResult& o : r.obstacles) {
    if (o.peak_force > 0.0) touched.push_back(o);
  }
  std::sort(touched.begin(), touched.end(), [](const ObstacleResult& a, const ObstacleResult& b) {
    return a.peak_force > b.peak_force;
  });
  for (std::size_t i = 0; i < std::min(most, touched.size()); ++i) {
    std::fprintf(out, "    %-20s peak %8.2f N   nearest %9.3f mm\n", touched[i].name.c_str(),
                 touched[i].peak_force, 1e3 * touched[i].nearest);
  }
  if (touched.size() > most) std::fprintf(out, "    and %zu more\n", touched.size() - most);
}

/// What a tick must not do, and how often it was interrupted.
void print_counts(const RunResult& r, std::FILE* out) {
  const auto print = [out](const char* name, std::int64_t count, const char* instead) {
    std::fprintf(out, "  %-22s %s\n", name, count < 0 ? instead : std::to_string(count).c_str());
  };
  host::print_allocations(r.allocations_in_tick, out);
  print("system calls in tick", r.system_calls_in_tick, "not counted (no Syscall User Dispatch)");
  print("page faults in tick", r.page_faults_in_tick, "not counted (memory is not locked)");
  std::fprintf(out, "  switches in tick       %lld voluntary, %lld by the machine\n",
               static_cast<long long>(r.voluntary_switches_in_tick),
               static_cast<long long>(r.involuntary_switches_in_tick));
}

/// Every obstacle; its nearest is null while its pairs have never been asked.
ordered_json obstacle_list(const RunResult& r) {
  ordered_json list = ordered_json::array();
  for (const ObstacleResult& o : r.obstacles) {
    list.push_back({{"name", o.name}, {"nearest_m", o.nearest}, {"peak_force_n", o.peak_force}});
  }
  return list;
}

/// The counted budget, and how much of such work this machine does.
void print_work(const RunResult& r, std::FILE* out) {
  std::fprintf(out, "  support pairs          %.2f per tick, most %lld in one\n",
               host::per_tick(r.totals, r.totals.iterations),
               static_cast<long long>(r.most_support_pairs));
  const auto units = static_cast<long long>(r.scene.budget.work_units);
  if (units == 0) return;
  std::fprintf(out, "  work budget            %lld support pairs per tick%s\n", units,
               r.options.budget == "i860" ? ", that of the i860 at this rate" : "");
  const double here = support_pairs_per_period(r);
  if (here == 0.0) return;
  std::fprintf(out,
               "  this machine           %.3g support pairs in a period of %g ms, %.3g times the "
               "budget;\n                         by the time of its ticks, all else in them "
               "included\n",
               here, 1e3 / r.options.rate_hz, here / static_cast<double>(units));
}

/// What the run did without, in one paragraph.
void print_skipped(const RunResult& r, std::FILE* out) {
  std::fprintf(out, "  skipped                %.2f of %d pairs per tick",
               r.pairs - host::per_tick(r.totals, r.totals.near), r.pairs);
  for (const std::string& part : unused_parts(r)) std::fprintf(out, ", %s", part.c_str());
  std::fprintf(out, "\n");
}

/// The budget in force.
ordered_json budget_list(const RunResult& r) {
  const scene::Budget& budget = r.scene.budget;
  const double here = support_pairs_per_period(r);
  const bool comparable = budget.work_units > 0 && here > 0.0;
  ordered_json times;
  if (comparable) times = here / static_cast<double>(budget.work_units);
  return {{"name", r.options.budget.empty() ? "scene" : r.options.budget},
          {"wall_us", r.options.fast ? 0.0 : budget.wall_us},
          {"work_units", budget.work_units},
          {"max_age_ticks", budget.max_age},
          {"ticks_over_wall", r.options.fast ? 0 : r.over_budget},
          {"machine_units_per_period", here},
          {"machine_times_budget", times}};
}

void print_workers(const WorkerReport& w, std::FILE* out) {
  std::fprintf(
      out, "  workers stood in for   in %lld ticks, longest %lld in a row, %d at the end\n",
      static_cast<long long>(w.ticks), static_cast<long long>(w.longest_silence), w.stood_in);
}

}  // namespace

void print_report(const RunResult& r, std::FILE* out) {
  const auto& t = r.totals;
  std::fprintf(out, "\n%s: %lld ticks at %g Hz (%.2f s), back end %s, coprocessor threads %d%s%s\n",
               r.scene.name.c_str(), static_cast<long long>(t.ticks), r.options.rate_hz,
               static_cast<double>(t.ticks) / r.options.rate_hz, r.options.backend.c_str(),
               r.threads, r.options.fast ? ", not by the clock" : "",
               r.interrupted ? ", interrupted" : "");
  host::print_times("compute of the tick", r.deadline.compute(), out);
  if (!r.options.fast) host::print_times("wake-up lateness", r.deadline.wakeup(), out);
  host::print_times("simulated arm", r.arm_step, out);
  if (!r.options.fast) {
    std::fprintf(out, "  deadline misses        %lld, skipped ticks %lld\n",
                 static_cast<long long>(r.deadline.misses()),
                 static_cast<long long>(r.skipped_ticks));
    std::fprintf(out, "  success rate           %.2f over the last 100 ticks, lowest %.2f%s\n",
                 r.deadline.success_rate(), r.deadline.lowest_success_rate(),
                 r.deadline.lowest_success_rate() < 0.95 ? "  (below 0.95: not a sound host)" : "");
  }
  host::print_pairs(t, r.pairs, out);
  std::fprintf(
      out,
      "  stale pairs            most %d in a tick, oldest answer %lld ticks, given too much "
      "%.3g J\n",
      t.most_stale, static_cast<long long>(t.oldest_age), t.refresh_energy);
  if (r.threads > 0) print_workers(t.workers, out);
  if (r.scene.budget.wall_us > 0.0 && !r.options.fast) {
    std::fprintf(out, "  wall budget            %g us, exceeded by the whole tick %lld times\n",
                 r.scene.budget.wall_us, static_cast<long long>(r.over_budget));
  }
  print_work(r, out);
  print_skipped(r, out);
  if (!r.nearest_pair.empty()) {
    std::fprintf(out, "  nearest                %.3f mm (%s), deepest intrusion %.3f mm\n",
                 1e3 * t.nearest, r.nearest_pair.c_str(), 1e3 * host::deepest(t));
  }
  std::fprintf(out, "  peak virtual force     %.2f N\n", t.peak_force);
  print_obstacles(r, out);
  print_network(r, out);
  print_counts(r, out);
  for (unsigned bit = 0; bit < 32; ++bit) {
    if (t.status_ticks[bit] == 0) continue;
    std::fprintf(out, "  status %-15s in %lld ticks\n", to_text(1U << bit).c_str(),
                 static_cast<long long>(t.status_ticks[bit]));
  }
  host::print_machine(r.machine, out);
}

void write_json(const RunResult& r, std::ostream& file) {
  ordered_json report = {{"scene", r.scene.name},           {"scene_file", r.scene.file},
                         {"backend", r.options.backend},    {"rate_hz", r.options.rate_hz},
                         {"by_the_clock", !r.options.fast}, {"threads", r.threads},
                         {"ticks", r.totals.ticks},         {"interrupted", r.interrupted}};
  report.update(host::to_json(r.deadline, r.skipped_ticks));
  report["simulated_arm_us"] = host::percentiles(r.arm_step);
  report["every_pair"] = r.options.every_pair;
  report["budget"] = budget_list(r);
  report.update(host::to_json(r.totals, r.pairs));
  report["support_pairs_most"] = r.most_support_pairs;
  report["pairs_skipped_per_tick"] = r.pairs - host::per_tick(r.totals, r.totals.near);
  report["skipped"] = unused_parts(r);
  report["workers"] = {{"ticks_stood_in_for", r.totals.workers.ticks},
                       {"longest_silence_ticks", r.totals.workers.longest_silence},
                       {"silent_at_end", r.totals.workers.stood_in}};
  report.update(network_to_json(r));
  report["nearest_pair"] = r.nearest_pair;
  report["obstacles"] = obstacle_list(r);
  report["allocations_in_tick"] = host::known(r.allocations_in_tick);
  report["system_calls_in_tick"] = host::known(r.system_calls_in_tick);
  report["page_faults_in_tick"] = host::known(r.page_faults_in_tick);
  report["voluntary_context_switches_in_tick"] = host::known(r.voluntary_switches_in_tick);
  report["involuntary_context_switches_in_tick"] = host::known(r.involuntary_switches_in_tick);
  report["machine"] = host::to_json(r.machine);
  host::write(report, file);
}

void write_csv(const RunResult& r, std::ostream& file) {
  file << "tick,time_s,phase,status,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,"
          "virtual_fx_n,virtual_fy_n,virtual_fz_n,virtual_tx_nm,virtual_ty_nm,virtual_tz_nm,"
          "coupling_fx_n,coupling_fy_n,coupling_fz_n,lever_torque_nm,gain,nearest_m,pairs_near,"
          "pairs_evaluated,pairs_stale,oldest_age_ticks";
  for (const ModuleResult& module : r.modules) file << ",energy_" << module.name << "_j";
  file << '\n';
  for (const TickRecord& k : r.records) {
    file << k.tick << ',' << to_text(k.time) << ',' << k.phase << ',' << k.status;
    for (const Vec3& v :
         {k.p_WT, k.v_WT, k.virtual_force.force, k.virtual_force.torque, k.coupling.force}) {
      for (int axis = 0; axis < 3; ++axis) file << ',' << to_text(v[axis]);
    }
    file << ',' << to_text(k.lever_torque) << ',' << to_text(k.gain) << ','
         << to_text(k.pairs.nearest) << ',' << k.pairs.near << ',' << k.pairs.evaluated << ','
         << k.pairs.stale << ',' << k.pairs.oldest_age;
    for (std::size_t i = 0; i < r.modules.size(); ++i) file << ',' << to_text(double{k.energy[i]});
    file << '\n';
  }
}

}  // namespace repel::teleop
