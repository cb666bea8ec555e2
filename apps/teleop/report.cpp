#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

namespace repel::teleop {
namespace {

using nlohmann::ordered_json;

double per_tick(const RunResult& r, std::int64_t sum) {
  return r.totals.ticks > 0 ? static_cast<double>(sum) / static_cast<double>(r.totals.ticks) : 0.0;
}
double deepest(const RunResult& r) {
  return std::isfinite(r.totals.nearest) ? std::max(0.0, -r.totals.nearest) : 0.0;
}

ordered_json percentiles(const DurationHistogram& h) {
  return {{"p50", h.percentile_us(0.5)},
          {"p99", h.percentile_us(0.99)},
          {"p99_9", h.percentile_us(0.999)},
          {"max", h.max_us()}};
}

ordered_json status_counts(const RunResult& r) {
  ordered_json counts = ordered_json::object();
  for (unsigned bit = 0; bit < 32; ++bit) {
    if (r.totals.status_ticks[bit] > 0) counts[to_text(1U << bit)] = r.totals.status_ticks[bit];
  }
  return counts;
}

void print_times(const char* name, const DurationHistogram& h, std::FILE* out) {
  std::fprintf(out, "  %-22s p50 %8.2f   p99 %8.2f   p99.9 %8.2f   max %9.2f us\n", name,
               h.percentile_us(0.5), h.percentile_us(0.99), h.percentile_us(0.999), h.max_us());
}

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

/// Every obstacle; its nearest is null while its pairs have never been asked.
ordered_json obstacle_list(const RunResult& r) {
  ordered_json list = ordered_json::array();
  for (const ObstacleResult& o : r.obstacles) {
    const ordered_json nearest =
        std::isfinite(o.nearest) ? ordered_json(o.nearest) : ordered_json(nullptr);
    list.push_back({{"name", o.name}, {"nearest_m", nearest}, {"peak_force_n", o.peak_force}});
  }
  return list;
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
               r.options.threads, r.options.fast ? ", not by the clock" : "",
               r.interrupted ? ", interrupted" : "");
  print_times("compute of the tick", r.deadline.compute(), out);
  if (!r.options.fast) print_times("wake-up lateness", r.deadline.wakeup(), out);
  print_times("simulated arm", r.arm_step, out);
  if (!r.options.fast) {
    std::fprintf(out, "  deadline misses        %lld, skipped ticks %lld\n",
                 static_cast<long long>(r.deadline.misses()),
                 static_cast<long long>(r.skipped_ticks));
    std::fprintf(out, "  success rate           %.2f over the last 100 ticks, lowest %.2f%s\n",
                 r.deadline.success_rate(), r.deadline.lowest_success_rate(),
                 r.deadline.lowest_success_rate() < 0.95 ? "  (below 0.95: not a sound host)" : "");
  }
  std::fprintf(out, "  pairs                  %d, near %.2f and evaluated %.2f per tick\n", r.pairs,
               per_tick(r, t.near), per_tick(r, t.evaluated));
  std::fprintf(out, "  stale pairs            most %d in a tick, oldest answer %lld ticks\n",
               t.most_stale, static_cast<long long>(t.oldest_age));
  if (r.options.threads > 0) print_workers(t.workers, out);
  if (r.scene.budget.wall_us > 0.0 && !r.options.fast) {
    std::fprintf(out, "  wall budget            %g us, exceeded by the whole tick %lld times\n",
                 r.scene.budget.wall_us, static_cast<long long>(r.over_budget));
  }
  if (r.scene.budget.work_units > 0) {
    std::fprintf(out, "  work budget            %lld support pairs per tick\n",
                 static_cast<long long>(r.scene.budget.work_units));
  }
  if (!r.nearest_pair.empty()) {
    std::fprintf(out, "  nearest                %.3f mm (%s), deepest intrusion %.3f mm\n",
                 1e3 * t.nearest, r.nearest_pair.c_str(), 1e3 * deepest(r));
  }
  std::fprintf(out, "  peak virtual force     %.2f N\n", t.peak_force);
  print_obstacles(r, out);
  std::fprintf(out, "  allocations in tick    %s\n",
               r.allocations_in_tick < 0 ? "not counted (another allocator is in place)"
                                         : std::to_string(r.allocations_in_tick).c_str());
  for (unsigned bit = 0; bit < 32; ++bit) {
    if (t.status_ticks[bit] == 0) continue;
    std::fprintf(out, "  status %-15s in %lld ticks\n", to_text(1U << bit).c_str(),
                 static_cast<long long>(t.status_ticks[bit]));
  }
  std::fprintf(out, "  machine                %s, %s\n                         %s, %s, commit %s\n",
               r.machine.cpu.c_str(), r.machine.kernel.c_str(), r.machine.scheduler.c_str(),
               r.machine.compiler.c_str(), r.machine.commit.c_str());
}

void write_json(const RunResult& r, std::ostream& file) {
  const auto& t = r.totals;
  ordered_json report = {
      {"scene", r.scene.name},
      {"scene_file", r.scene.file},
      {"backend", r.options.backend},
      {"rate_hz", r.options.rate_hz},
      {"by_the_clock", !r.options.fast},
      {"threads", r.options.threads},
      {"ticks", t.ticks},
      {"interrupted", r.interrupted},
      {"deadline_misses", r.deadline.misses()},
      {"skipped_ticks", r.skipped_ticks},
      {"success_rate_last_100", r.deadline.success_rate()},
      {"success_rate_lowest", r.deadline.lowest_success_rate()},
      {"compute_us", percentiles(r.deadline.compute())},
      {"wakeup_us", percentiles(r.deadline.wakeup())},
      {"simulated_arm_us", percentiles(r.arm_step)},
      {"budget",
       {{"wall_us", r.options.fast ? 0.0 : r.scene.budget.wall_us},
        {"work_units", r.scene.budget.work_units},
        {"ticks_over_wall", r.options.fast ? 0 : r.over_budget}}},
      {"pairs", r.pairs},
      {"pairs_near_per_tick", per_tick(r, t.near)},
      {"pairs_evaluated_per_tick", per_tick(r, t.evaluated)},
      {"support_pairs_per_tick", per_tick(r, t.iterations)},
      {"pairs_stale", t.most_stale},
      {"pairs_stale_per_tick", per_tick(r, t.stale)},
      {"oldest_age_ticks", t.oldest_age},
      {"workers",
       {{"ticks_stood_in_for", t.workers.ticks},
        {"longest_silence_ticks", t.workers.longest_silence},
        {"silent_at_end", t.workers.stood_in}}},
      {"nearest_m", std::isfinite(t.nearest) ? ordered_json(t.nearest) : ordered_json(nullptr)},
      {"nearest_pair", r.nearest_pair},
      {"deepest_m", deepest(r)},
      {"peak_force_n", t.peak_force},
      {"obstacles", obstacle_list(r)},
      {"allocations_in_tick",
       r.allocations_in_tick < 0 ? ordered_json(nullptr) : ordered_json(r.allocations_in_tick)},
      {"status_ticks", status_counts(r)},
      {"machine",
       {{"cpu", r.machine.cpu},
        {"kernel", r.machine.kernel},
        {"scheduler", r.machine.scheduler},
        {"compiler", r.machine.compiler},
        {"commit", r.machine.commit}}}};
  // A byte that is not UTF-8 in a name must not cost the report.
  file << report.dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void write_csv(const RunResult& r, std::ostream& file) {
  file << "tick,time_s,phase,status,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,"
          "virtual_fx_n,virtual_fy_n,virtual_fz_n,virtual_tx_nm,virtual_ty_nm,virtual_tz_nm,"
          "coupling_fx_n,coupling_fy_n,coupling_fz_n,lever_torque_nm,gain,nearest_m,pairs_near,"
          "pairs_evaluated,pairs_stale,oldest_age_ticks\n";
  for (const TickRecord& k : r.records) {
    file << k.tick << ',' << to_text(k.time) << ',' << k.phase << ',' << k.status;
    for (const Vec3& v :
         {k.p_WT, k.v_WT, k.virtual_force.force, k.virtual_force.torque, k.coupling.force}) {
      for (int axis = 0; axis < 3; ++axis) file << ',' << to_text(v[axis]);
    }
    file << ',' << to_text(k.lever_torque) << ',' << to_text(k.gain) << ','
         << to_text(k.pairs.nearest) << ',' << k.pairs.near << ',' << k.pairs.evaluated << ','
         << k.pairs.stale << ',' << k.pairs.oldest_age << '\n';
  }
}

}  // namespace repel::teleop
