// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/report/report.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <utility>

#include <repel/host/figure.hpp>
#include <repel/host/times.hpp>
#include <repel/runs/faults/exchange.hpp>
#include <repel/runs/report/chatter_report.hpp>
#include <repel/runs/report/link_laws.hpp>
#include <repel/runs/report/network_report.hpp>
#include <repel/runs/report/unused.hpp>

namespace repel::runs {
namespace {

using host::figure;
using nlohmann::ordered_json;

/// The obstacles that exerted a force, largest first.
void print_obstacles(const RunResult& r, std::FILE* out) {
  constexpr std::size_t most = 10;
  std::vector<ObstacleResult> touched;
  for (const ObstacleResult& o : r.obstacles) {
    if (o.extremes.peak_force > 0.0) touched.push_back(o);
  }
  std::sort(touched.begin(), touched.end(), [](const ObstacleResult& a, const ObstacleResult& b) {
    return a.extremes.peak_force > b.extremes.peak_force;
  });
  for (std::size_t i = 0; i < std::min(most, touched.size()); ++i) {
    std::fprintf(out, "    %-20s peak %8s N   nearest %9s mm   hardest on %s (%s)\n",
                 touched[i].name.c_str(), figure(touched[i].extremes.peak_force, 2).c_str(),
                 figure(1e3 * touched[i].extremes.nearest, 3).c_str(), touched[i].part.c_str(),
                 touched[i].body.c_str());
    print_link_laws(touched[i], out);
  }
  if (touched.size() > most) std::fprintf(out, "    and %zu more\n", touched.size() - most);
}

void print_line(const char* name, const std::string& text, std::FILE* out) {
  std::fprintf(out, "  %-22s %s\n", name, text.c_str());
}

/// Operations that a tick must not make, and how often it was interrupted.
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

/// Contacts were simulated: with --contact, and not in a replay.
bool has_contacts(const RunResult& r) {
  return r.options.contact && r.replay.ticks == 0;
}

/// Physical contacts of an arm; null if they were not simulated.
ordered_json contact_to_json(const RunResult& r, const ArmResult& arm) {
  if (!has_contacts(r)) return nullptr;
  return {{"steps", arm.contact.steps}, {"deepest_m", arm.contact.deepest}};
}

void print_contact(const RunResult& r, std::FILE* out) {
  if (!has_contacts(r)) return;
  for (const ArmResult& arm : r.arms) {
    const std::string whose = arm.name.empty() ? "" : " of " + arm.name;
    std::fprintf(out, "  physical contact       ");
    if (arm.contact.steps == 0) {
      std::fprintf(out, "none%s\n", whose.c_str());
    } else {
      std::fprintf(out, "in %lld steps%s, deepest %s mm\n",
                   static_cast<long long>(arm.contact.steps), whose.c_str(),
                   figure(1e3 * arm.contact.deepest, 3).c_str());
    }
  }
}

/// Adds what the tool of an arm carries; whether it is known is null if that is nothing.
void add_payload(const scene::RobotChoice& robot, ordered_json& report) {
  const bool none = robot.payload.mass == 0.0;
  report["payload_kg"] = robot.payload.mass;
  report["payload_known"] = none ? ordered_json(nullptr) : ordered_json(robot.payload_known);
}

/// How the simulated arms differ from the robot files and from what their controllers know.
void print_plant(const RunResult& r, std::FILE* out) {
  if (r.options.plant_inertia != 1.0) {
    print_line("plant inertia", to_text(r.options.plant_inertia) + " times that of the model", out);
  }
  for (std::size_t i = 0; i < r.arms.size(); ++i) {
    const scene::RobotChoice& robot = r.scene.arm_setup(i).robot;
    if (robot.payload.mass == 0.0) continue;
    const std::string whose = r.arms[i].name.empty() ? "" : " of " + r.arms[i].name;
    print_line("payload",
               to_text(robot.payload.mass) + " kg" + whose +
                   (robot.payload_known ? "" : ", unknown to the controller"),
               out);
  }
}

/// The values that are not those of the scene file, in the order of the command line.
ordered_json changes_of_the_scene(const RunResult& r) {
  ordered_json list = ordered_json::array();
  for (const scene::Change& each : r.scene.changes) {
    list.push_back({{"path", each.path}, {"value", each.value}});
  }
  return list;
}

void print_changes_of_the_scene(const RunResult& r, std::FILE* out) {
  for (const scene::Change& each : r.scene.changes) {
    print_line("changed in the scene", each.path + ": " + each.value, out);
  }
}

/// The faults that were injected, in the order of the command line.
ordered_json injected_faults(const RunResult& r) {
  ordered_json list = ordered_json::array();
  for (const faults::Choice& each : r.options.faults) {
    list.push_back({{"name", each.name},
                    {"kind", faults::to_text(faults::fault_named(each.name).kind)},
                    {"begin_s", each.begin}});
  }
  return list;
}

void print_injected_faults(const RunResult& r, std::FILE* out) {
  for (const faults::Choice& each : r.options.faults) {
    const faults::Kind kind = faults::fault_named(each.name).kind;
    print_line(
        "injected fault",
        each.name + " (" + faults::to_text(kind) + "), from " + to_text(each.begin) + " s on", out);
  }
}

/// How overlaps were measured, if not in the default way.
std::string measure_text(const RunResult& r) {
  if (r.scene.measure == QueryOptions{}.measure) return {};
  std::string text = to_text(r.scene.measure);
  if (r.levels > 0) text += ", " + std::to_string(r.levels) + " levels";
  return text;
}

/// Number of ticks in each stop state.
ordered_json stop_ticks(const RunTotals& totals) {
  ordered_json ticks;
  for (const Stop stop : {Stop::running, Stop::holding, Stop::braking, Stop::released}) {
    ticks[to_text(stop)] = totals.stop_ticks[static_cast<std::size_t>(stop)];
  }
  return ticks;
}

/// The joints of an arm's robot that are held, and where.
ordered_json held_list(const ArmResult& arm) {
  ordered_json list = ordered_json::array();
  for (const HeldJoint& joint : arm.held) {
    list.push_back({{"name", joint.name},
                    {"type", joint.type},
                    {"position", joint.position},
                    {"unit", joint.type == "prismatic" ? "m" : "rad"},
                    {"reason", joint.reason}});
  }
  return list;
}

void print_held(const RunResult& r, std::FILE* out) {
  for (const ArmResult& arm : r.arms) {
    std::string text;
    for (const HeldJoint& joint : arm.held) {
      const bool slides = joint.type == "prismatic";
      text += (text.empty() ? "" : ", ") + joint.name + " at ";
      text += figure((slides ? 1e3 : 180.0 / std::numbers::pi) * joint.position, 2);
      text += slides ? " mm" : " deg";
    }
    if (text.empty()) continue;
    if (!arm.name.empty()) text += " (of " + arm.name + ")";
    print_line("held joints", text, out);
  }
}

/// Results of the partners; those of the arm of the scene itself are top-level keys of the report.
ordered_json partner_list(const RunResult& r) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 1; i < r.arms.size(); ++i) {
    const ArmResult& arm = r.arms[i];
    ordered_json partner = {{"name", arm.name},
                            {"peak_force_n", arm.totals.peak_force},
                            {"hold_margin_m", arm.totals.hold_margin},
                            {"hold_gaps_left_out", arm.totals.gaps_left_out},
                            {"chatter", chatter_to_json(arm)},
                            {"status_ticks", host::status_ticks(arm.totals)},
                            {"stop", stop_ticks(arm.totals)},
                            {"physical_contact", contact_to_json(r, arm)},
                            {"held_joints", held_list(arm)},
                            {"modules", modules_to_json(arm.modules)},
                            {"stability", stability_to_json(arm)}};
    add_payload(r.scene.arm_setup(i).robot, partner);
    add_measured(arm, partner);
    list.push_back(std::move(partner));
  }
  return list;
}

/// The stop states that an arm was in, if any.
void print_stops(const ArmResult& arm, std::FILE* out) {
  const std::string whose = arm.name.empty() ? "" : " of " + arm.name;
  for (const Stop stop : {Stop::holding, Stop::braking, Stop::released}) {
    const std::int64_t ticks = arm.totals.stop_ticks[static_cast<std::size_t>(stop)];
    if (ticks == 0) continue;
    std::fprintf(out, "  stop   %-15s in %lld ticks%s\n", to_text(stop).c_str(),
                 static_cast<long long>(ticks), whose.c_str());
  }
}

/// The status bits that were set for an arm, and the number of ticks.
void print_status(const ArmResult& arm, std::FILE* out) {
  const std::string whose = arm.name.empty() ? "" : " of " + arm.name;
  for (unsigned bit = 0; bit < 32; ++bit) {
    const std::int64_t ticks = arm.totals.status_ticks[bit];
    if (ticks == 0) continue;
    std::fprintf(out, "  status %-15s in %lld ticks%s\n", to_text(1U << bit).c_str(),
                 static_cast<long long>(ticks), whose.c_str());
  }
}

/// The least that was proven of hard walls, if there are any.
void print_hold(const ArmResult& arm, std::FILE* out) {
  const std::string whose = arm.name.empty() ? "" : " of " + arm.name;
  if (!std::isfinite(arm.totals.hold_margin)) return;
  print_line("hard walls",
             "stopping proven " + figure(1e3 * arm.totals.hold_margin, 3) + " mm before" + whose,
             out);
  if (arm.totals.gaps_left_out == 0) return;
  print_line("", std::to_string(arm.totals.gaps_left_out) + " gaps had no room and are left out",
             out);
}

/// What to do where an arm gained energy from its own control.
void print_gain(const RunResult& r, std::FILE* out) {
  if (!gained_energy(r)) return;
  std::fputs(
      "  The arm gained energy from its own control, more than braking could take back: the mass "
      "of\n"
      "  the model is not that of the arm, its drive is late ('robot: drive_delay'), or its "
      "readings\n"
      "  are. The run ends with exit code 5.\n",
      out);
}

/// Where an arm had a fault most of the time, or nearly.
void print_faults(const RunResult& r, std::FILE* out) {
  if (!was_often_at_fault(r)) return;
  std::fputs(
      "  An arm had a fault in more than a tenth of its ticks, and its operator did not drive it.\n"
      "  The run ends with exit code 5.\n",
      out);
}

/// Every obstacle; its nearest distance is null if none of its pairs was ever evaluated.
ordered_json obstacle_list(const RunResult& r) {
  ordered_json list = ordered_json::array();
  for (const ObstacleResult& o : r.obstacles) {
    list.push_back({{"name", o.name},
                    {"nearest_m", o.extremes.nearest},
                    {"deepest_m", o.extremes.deepest},
                    {"peak_force_n", o.extremes.peak_force},
                    {"hold", o.is_hard ? "hard" : "soft"},
                    {"withstood_n", o.is_hard ? ordered_json(o.withstood) : ordered_json()},
                    {"part", o.part},
                    {"body", o.body},
                    {"link_laws", link_laws_to_json(o)}});
  }
  return list;
}

/// An intrusion into a passable body is intended, one into a wall is not.
void print_walls_and_passables(const RunResult& r, std::FILE* out) {
  if (!std::isfinite(r.passables.nearest)) return;
  const auto print = [out](const char* name, const PairExtremes& of) {
    const std::string nearest =
        std::isfinite(of.nearest) ? figure(1e3 * of.nearest, 3) + " mm" : "none";
    std::fprintf(out, "    %-20s nearest %s, deepest intrusion %s mm\n", name, nearest.c_str(),
                 figure(1e3 * of.deepest, 3).c_str());
  };
  print("walls", r.walls);
  print("passable bodies", r.passables);
}

/// The counted budget, and how many support pairs this machine computes.
void print_work(const RunResult& r, std::FILE* out) {
  std::fprintf(out, "  support pairs          %.2f per tick, most %lld in one\n",
               host::per_tick(r.totals(), r.totals().iterations),
               static_cast<long long>(r.most_support_pairs));
  const auto units = static_cast<long long>(r.scene.budget.work_units);
  if (units == 0) return;
  std::fprintf(out,
               "  work budget            %lld support pairs per tick%s, %.0f %% used at most\n",
               units, r.options.budget == "i860" ? ", that of the i860 at this rate" : "",
               1e2 * static_cast<double>(r.most_support_pairs) / static_cast<double>(units));
  const double here = support_pairs_per_period(r);
  if (here == 0.0) return;
  std::fprintf(out,
               "  this machine           %.3g support pairs in a period of %g ms, %.3g times the "
               "budget;\n                         by the time of its ticks, all else in them "
               "included\n",
               here, 1e3 / r.options.rate_hz, here / static_cast<double>(units));
}

/// Parts that come and go: null if the scene has none.
ordered_json steps_to_json(const RunResult& r) {
  if (r.scene.loose.empty()) return nullptr;
  ordered_json list = ordered_json::array();
  for (const PartStepResult& each : r.steps) {
    const bool is_grip = each.step.what == scene::PartStep::What::grip;
    list.push_back(
        {{"phase", r.scene.arm_setup(each.arm).script[each.step.phase].name},
         {"step", std::string(word_for(each.step.what))},
         {"part", r.scene.loose[each.step.part].name},
         {"made", each.was_made},
         {"refused", each.was_refused},
         {"distance_m", is_grip && std::isfinite(each.distance) ? ordered_json(each.distance)
                                                                : ordered_json(nullptr)}});
  }
  return list;
}

void print_steps(const RunResult& r, std::FILE* out) {
  if (r.scene.loose.empty()) return;
  const auto made = std::count_if(r.steps.begin(), r.steps.end(),
                                  [](const PartStepResult& each) { return each.was_made; });
  const auto refused = std::count_if(r.steps.begin(), r.steps.end(),
                                     [](const PartStepResult& each) { return each.was_refused; });
  std::fprintf(out, "  parts that come and go %zu; %d of %zu steps made, %d refused\n",
               r.scene.loose.size(), static_cast<int>(made), r.steps.size(),
               static_cast<int>(refused));
}

ordered_json images_to_json(const ImageResult& c) {
  return {{"images", c.images},
          {"images_lost", c.lost},
          {"most_cells", c.most_cells},
          {"largest_cube_m", c.largest_cube > 0.0 ? ordered_json(c.largest_cube) : ordered_json()},
          {"parts_made", c.made},
          {"cells_left_out", c.left_out},
          {"silent_s", c.silent},
          {"compute_p50_us", c.compute.percentile_us(0.5)},
          {"compute_p99_us", c.compute.percentile_us(0.99)}};
}

/// All cameras together and what they saw: null if the scene has none.
ordered_json camera_to_json(const RunResult& r) {
  if (!r.camera) return nullptr;
  ordered_json object = images_to_json(r.camera->all);
  const Clearance& c = r.camera->clearance;
  object["least_clearance_m"] = std::isfinite(c.least) ? ordered_json(c.least) : ordered_json();
  object["least_clearance_pair"] = c.pair;
  return object;
}

/// One entry for each camera.
ordered_json cameras_to_json(const RunResult& r) {
  ordered_json list = ordered_json::array();
  if (!r.camera) return list;
  for (const ImageResult& each : r.camera->each) {
    ordered_json object = {{"name", each.name}};
    object.update(images_to_json(each));
    list.push_back(std::move(object));
  }
  return list;
}

void print_camera(const RunResult& r, std::FILE* out) {
  if (!r.camera) return;
  for (const ImageResult& c : r.camera->each) {
    std::fprintf(out,
                 "  %-22s %lld images, up to %d cells; p99 %.1f ms an image; silent for %.1f s%s\n",
                 c.name.c_str(), static_cast<long long>(c.images), c.most_cells,
                 1e-3 * c.compute.percentile_us(0.99), c.silent,
                 c.left_out > 0 ? "; NOT ALL of it found a part" : "");
  }
  const Clearance& clearance = r.camera->clearance;
  if (clearance.pair.empty()) return;
  std::fprintf(out, "  clearance to what it saw %.1f mm at least (%s)\n", 1e3 * clearance.least,
               clearance.pair.c_str());
}

/// What the run did not evaluate or use, in one paragraph.
void print_skipped(const RunResult& r, std::FILE* out) {
  std::fprintf(out, "  skipped                %.2f of %d pairs per tick",
               r.pairs - host::per_tick(r.totals(), r.totals().near), r.pairs);
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

/// Whether the rate was held. Without the clock nobody watched a deadline: then the share of the
/// period that the slowest tick computed.
void print_verdict(const RunResult& r, std::FILE* out) {
  if (r.deadline.ticks() == 0) return;
  const double period_us = 1e6 / r.options.rate_hz;
  if (r.options.fast) {
    std::fprintf(out,
                 "%g Hz: not by the clock; the slowest tick computed for %.1f %% of a period\n",
                 r.options.rate_hz, 1e2 * r.deadline.compute().max_us() / period_us);
    return;
  }
  const double response_us = 1e-3 * static_cast<double>(r.deadline.longest_response().count());
  std::fprintf(out, "%g Hz: met in %lld of %lld ticks, worst %.1f %% of the period\n",
               r.options.rate_hz, static_cast<long long>(r.deadline.ticks() - r.deadline.misses()),
               static_cast<long long>(r.deadline.ticks()), 1e2 * response_us / period_us);
}

ordered_json workers_to_json(const RunResult& r) {
  return {{"mode", to_text(r.options.coprocessor)},
          {"ticks_with_work", r.totals().workers.shared},
          {"oldest_answer_ticks", r.totals().workers.oldest_age},
          {"ticks_stood_in_for", r.totals().workers.ticks},
          {"longest_silence_ticks", r.totals().workers.longest_silence},
          {"silent_at_end", r.totals().workers.stood_in},
          {"restarts", r.worker_usage.restarts},
          {"page_faults", r.worker_usage.page_faults},
          {"switches", r.worker_usage.switches}};
}

void print_workers(const RunResult& r, std::FILE* out) {
  const WorkerReport& w = r.totals().workers;
  const WorkerUsage& usage = r.worker_usage;
  const auto count = [](std::int64_t n) { return static_cast<long long>(n); };
  std::fprintf(out,
               "  coprocessor threads    %d %s, at work in %lld ticks; oldest answer used %lld "
               "ticks\n",
               r.threads, std::string(to_text(r.options.coprocessor)).c_str(), count(w.shared),
               count(w.oldest_age));
  std::fprintf(out,
               "  workers stood in for   in %lld ticks, longest %lld in a row, %d at the end; %lld "
               "restarts\n",
               count(w.ticks), count(w.longest_silence), w.stood_in, count(usage.restarts));
  std::fprintf(out, "  workers disturbed      %lld page faults, %lld times off their processor\n",
               count(usage.page_faults), count(usage.switches));
}

/// Null if there was none beside this program, or if it wrote no report.
ordered_json station_to_json(const RunResult& r) {
  if (!r.station) return nullptr;
  ordered_json report = ordered_json::parse(r.station->report, nullptr, false);
  return report.is_discarded() ? ordered_json(nullptr) : report;
}

}  // namespace

void print_report(const RunResult& r, std::FILE* out) {
  const auto& t = r.totals();
  std::fprintf(out, "\n%s: %lld ticks at %g Hz (%.2f s), back end %s, coprocessor threads %d%s%s\n",
               r.scene.name.c_str(), static_cast<long long>(t.ticks), r.options.rate_hz,
               static_cast<double>(t.ticks) / r.options.rate_hz, r.options.backend.c_str(),
               r.threads, r.options.fast ? ", not by the clock" : "",
               r.interrupted ? ", interrupted" : "");
  // The most important facts first.
  if (!r.log_trouble.empty()) print_line("log is not whole", r.log_trouble, out);
  for (const std::string& warning : r.warnings) print_line("warning", warning, out);
  print_changes_of_the_scene(r, out);
  print_plant(r, out);
  print_injected_faults(r, out);
  if (!measure_text(r).empty()) print_line("measure of overlaps", measure_text(r), out);
  host::print_times("compute of the tick", r.deadline.compute(), out);
  if (!r.options.fast) host::print_times("wake-up lateness", r.deadline.wakeup(), out);
  host::print_times("simulated arm", r.arm_step, out);
  if (r.options.fast) {
    print_line("deadline misses", "not by the clock", out);
  } else {
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
  if (r.threads > 0) print_workers(r, out);
  if (r.scene.budget.wall_us > 0.0 && !r.options.fast) {
    std::fprintf(out, "  wall budget            %g µs, exceeded by the whole tick %lld times\n",
                 r.scene.budget.wall_us, static_cast<long long>(r.over_budget));
  }
  print_work(r, out);
  print_steps(r, out);
  print_camera(r, out);
  if (r.link) print_link(*r.link, out);
  print_skipped(r, out);
  if (r.nearest_pair.empty()) {
    print_line("nearest", "none", out);
  } else {
    std::fprintf(out, "  nearest                %s mm (%s), deepest intrusion %s mm\n",
                 figure(1e3 * t.nearest, 3).c_str(), r.nearest_pair.c_str(),
                 figure(1e3 * t.deepest, 3).c_str());
    print_walls_and_passables(r, out);
  }
  print_line("peak virtual force", figure(t.peak_force, 2) + " N", out);
  print_obstacles(r, out);
  print_chatter(r, out);
  print_held(r, out);
  print_contact(r, out);
  print_network(r, out);
  print_counts(r, out);
  if (!r.options.log.empty()) {
    std::fprintf(out, "  log                    %lld ticks dropped\n",
                 static_cast<long long>(r.log_dropped));
  }
  for (const ArmResult& arm : r.arms) {
    print_hold(arm, out);
    print_stops(arm, out);
    print_status(arm, out);
  }
  print_gain(r, out);
  print_faults(r, out);
  host::print_machine(r.machine, out);
  print_verdict(r, out);
}

void print_replay(const Recording& recording, const RunResult& result, std::FILE* out) {
  const ReplayReport& r = result.replay;
  std::fprintf(out, "\n%s: %zu ticks recorded", recording.file.c_str(), recording.ticks());
  if (recording.missing > 0) {
    std::fprintf(out, ", then %lld dropped; later ticks are left out",
                 static_cast<long long>(recording.missing));
  }
  std::fprintf(out, "\n");
  if (!recording.not_whole.empty()) {
    std::fprintf(out, "  ends early: %s\n", recording.not_whole.c_str());
  }
  std::fprintf(out, "  the same forces        in %lld of %lld ticks, bit for bit\n",
               static_cast<long long>(r.same), static_cast<long long>(r.ticks));
  if (r.first_difference < 0) return;
  std::fprintf(
      out,
      "  first difference       in tick %lld; virtual forces by at most %.3g N. A run with\n"
      "                         a wall budget or a late worker is not repeatable\n",
      static_cast<long long>(r.first_difference), r.force_difference);
}

void write_json(const RunResult& r, std::ostream& file) {
  ordered_json report = {{"scene", r.scene.name},           {"scene_file", r.scene.file},
                         {"backend", r.options.backend},    {"rate_hz", r.options.rate_hz},
                         {"by_the_clock", !r.options.fast}, {"threads", r.threads},
                         {"ticks", r.totals().ticks},       {"interrupted", r.interrupted}};
  report["changes"] = changes_of_the_scene(r);
  report["warnings"] = r.warnings;
  report.update(host::to_json(r.deadline, r.skipped_ticks));
  if (r.options.fast) {  // lateness is undefined without real time
    for (const char* key :
         {"deadline_misses", "success_rate_last_100", "success_rate_lowest", "response_us_max"}) {
      report[key] = nullptr;
    }
    for (auto& share : report["wakeup_us"]) share = nullptr;
  }
  report["simulated_arm_us"] = host::percentiles(r.arm_step);
  report["measure"] = to_text(r.scene.measure);
  report["levels"] = r.levels > 0 ? ordered_json(r.levels) : ordered_json(nullptr);
  report["every_pair"] = r.options.every_pair;
  report["plant_inertia"] = r.options.plant_inertia;
  report["prediction"] = r.options.prediction;
  report["faults"] = injected_faults(r);
  report["drive_delay_ticks"] = r.scene.robot.drive_delay;
  report["admittance_response_s"] =
      r.scene.robot.admittance ? ordered_json(r.scene.robot.admittance->response) : nullptr;
  add_payload(r.scene.robot, report);
  report["budget"] = budget_list(r);
  report.update(host::to_json(r.totals(), r.pairs));
  report["chatter"] = chatter_to_json(r.arms.front());
  report["support_pairs_most"] = r.most_support_pairs;
  report["pairs_skipped_per_tick"] = r.pairs - host::per_tick(r.totals(), r.totals().near);
  report["skipped"] = unused_parts(r);
  report["workers"] = workers_to_json(r);
  report["network_us"] = host::percentiles(r.network_time);
  report["device_damping_n_s_per_m"] = r.device_damping;
  report["stop"] = stop_ticks(r.totals());
  report["brake_ticks"] = r.totals().brake_ticks;
  report["hold_margin_m"] = r.totals().hold_margin;
  report["hold_gaps_left_out"] = r.totals().gaps_left_out;
  report["held_joints"] = held_list(r.arms.front());
  report["modules"] = modules_to_json(r.arms.front().modules);
  report["stability"] = stability_to_json(r.arms.front());
  report["partners"] = partner_list(r);
  report["nearest_pair"] = r.nearest_pair;
  report["nearest_wall_m"] = r.walls.nearest;
  report["deepest_wall_m"] = r.walls.deepest;
  report["nearest_passable_m"] = r.passables.nearest;
  report["deepest_passable_m"] = r.passables.deepest;
  report["obstacles"] = obstacle_list(r);
  report["steps"] = steps_to_json(r);
  report["camera"] = camera_to_json(r);
  report["cameras"] = cameras_to_json(r);
  report["link"] = r.link ? link_to_json(*r.link) : ordered_json(nullptr);
  report["station"] = station_to_json(r);
  report["physical_contact"] = contact_to_json(r, r.arms.front());
  add_measured(r.arms.front(), report);
  report["allocations_in_tick"] = host::known(r.allocations_in_tick);
  report["system_calls_in_tick"] = host::known(r.system_calls_in_tick);
  report["page_faults_in_tick"] = host::known(r.page_faults_in_tick);
  report["voluntary_context_switches_in_tick"] = host::known(r.voluntary_switches_in_tick);
  report["involuntary_context_switches_in_tick"] = host::known(r.involuntary_switches_in_tick);
  if (!r.options.log.empty()) {
    report["log_ticks_dropped"] = r.log_dropped;
    report["log_trouble"] = nullptr;
    if (!r.log_trouble.empty()) report["log_trouble"] = r.log_trouble;
  }
  if (r.replay.ticks > 0) {
    report["replay"] = {{"ticks", r.replay.ticks},
                        {"same", r.replay.same},
                        {"first_difference", r.replay.first_difference},
                        {"force_difference_n", r.replay.force_difference}};
  }
  report["machine"] = host::to_json(r.machine);
  host::write(report, file);
}

}  // namespace repel::runs
