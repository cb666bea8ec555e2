// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <algorithm>

#include "../distance/markdown.hpp"
#include "../harness.hpp"

namespace repel::scale {

namespace {

using bench::text;

constexpr double degrees = 180.0 / M_PI;

std::string quoted(const std::string& words) {
  std::string out = "\"";
  for (const char c : words) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// The fields of an object, one per line.
class Object {
 public:
  explicit Object(int indent) : indent_(indent, ' ') {}
  Object& add(const char* name, const std::string& value) {
    fields_ += (fields_.empty() ? "" : ",\n") + indent_ + text("  \"%s\": ", name) + value;
    return *this;
  }
  Object& add(const char* name, double value) { return add(name, text("%.9g", value)); }
  [[nodiscard]] std::string str() const { return "{\n" + fields_ + "\n" + indent_ + "}"; }

 private:
  std::string indent_;
  std::string fields_;
};

void add_build(Object& object) {
  const bench::Build build = bench::this_build();
  object.add("machine", quoted(build.machine));
  object.add("compiler", quoted(build.compiler));
  object.add("flags", quoted(build.flags));
  object.add("simd", quoted(build.simd));
  object.add("commit", quoted(build.commit));
}

void add_run(Object& object, const Scenario& s, const Run& run) {
  object.add("method", quoted(run.way.name)).add("settings", quoted(run.way.settings));
  object.add("pairs", s.setting.pairs).add("near", s.setting.near);
  object.add("ticks", static_cast<double>(run.ns.size()));
  object.add("threads", run.way.threads).add("seed", static_cast<double>(s.setting.seed));
  object.add("mode", quoted(std::string(to_text(run.way.mode))));
  object.add("host_mean_ns", run.mean());
  object.add("mean_ns", run.mean()).add("p50_ns", run.percentile(0.5));
  object.add("p99_ns", run.percentile(0.99)).add("p99_9_ns", run.percentile(0.999));
  object.add("max_ns", run.percentile(1.0));
  object.add("p99_9_undisturbed_ns", run.undisturbed(0.999));
  object.add("max_undisturbed_ns", run.undisturbed(1.0));
  object.add("preempted_ticks", run.preempted()).add("page_faults", run.page_faults());
  object.add("shared_ticks", static_cast<double>(run.workers.shared));
  object.add("late_ticks", static_cast<double>(run.workers.ticks));
  object.add("oldest_answer_ticks", static_cast<double>(run.workers.oldest_age));
  object.add("worker_page_faults", static_cast<double>(run.usage.page_faults));
  object.add("worker_switches", static_cast<double>(run.usage.switches));
  object.add("worker_restarts", static_cast<double>(run.usage.restarts));
  object.add("evaluated_per_tick", run.evaluated).add("near_per_tick", s.near);
  object.add("overlapping_per_tick", s.overlapping);
  object.add("equal_to_brute_force", run.check.equal() ? "true" : "false");
  object.add("brute_force", quoted("spheres of all pairs compared at every tick, those within "
                                   "range asked"));
  object.add("brute_force_ticks", static_cast<double>(run.check.ticks));
  object.add("brute_force_pairs_asked", static_cast<double>(s.asked));
  object.add("wrong_ticks", static_cast<double>(run.check.wrong));
  object.add("bitwise_equal_ticks", static_cast<double>(run.check.bitwise));
  object.add("worst_difference", run.check.worst);
  object.add("every_pair_ticks", static_cast<double>(run.every_pair.ticks));
  object.add("every_pair_wrong_ticks", static_cast<double>(run.every_pair.wrong));
  object.add("every_pair_bitwise_equal_ticks", static_cast<double>(run.every_pair.bitwise));
  object.add("bytes_per_pair", run.bytes / s.setting.pairs);
  object.add("bytes_measured", quoted("growth of the heap by set-up (mallinfo2), without shapes"));
  object.add("shape_bytes", s.shape_bytes).add("setup_s", run.setup);
  object.add("tool_parts", s.tool_parts).add("moving_bodies", s.setting.bodies);
  object.add("mean_speed_m_s", s.speed.mean).add("max_speed_m_s", s.speed.most);
  object.add("max_turn_deg_per_tick", degrees * s.speed.most_turn);
}

std::string small_json(const SmallRun& run) {
  Object object(2);
  object.add("method", quoted("4x8: " + run.who)).add("p50_ns", run.p50).add("p99_ns", run.p99);
  object.add("near_per_tick", run.near).add("evaluated_per_tick", run.evaluated);
  return object.add("wrong", run.wrong).str();
}

/// The run of that method without threads; nullptr if it was not measured.
const Run* find(const Scenario& s, const std::string& method) {
  const auto run = std::find_if(s.runs.begin(), s.runs.end(), [&](const Run& other) {
    return other.way.name == method && other.way.threads == 0;
  });
  return run == s.runs.end() ? nullptr : &*run;
}

/// Why the method of another library takes less than 1.5 times as long as repel; empty if not.
std::string why_near(const Scenario& s, const Run& run, double times) {
  constexpr double wanted = 1.5;
  const Run* known = find(s, "pairs known, with forces");
  const bool is_rival = !run.way.ours && known != nullptr && &run != known;
  if (!is_rival || times >= wanted) return "";
  if (run.way.name.find("forces") == std::string::npos) return "it gives no forces";
  return text(
      "its queries, patches and forces are repel's; those of the pairs within range alone "
      "take %.0f %% of its time",
      100.0 * known->mean() / run.mean());
}

/// The mean time, or the number of wrong answers if there are any: then no time is shown.
std::string line(const Scenario& s, const Run& run) {
  const Check& check = run.check;
  std::string out = text("| %s | %d | %d | %.3g | %.4g |", run.way.name.c_str(), run.way.threads,
                         s.setting.pairs, s.near, run.evaluated);
  if (check.equal()) {
    out += text(" %.0f | %.0f | %.0f | %.0f |", run.mean(), run.percentile(0.5),
                run.percentile(0.99), run.percentile(0.999));
  } else {
    out += text(" wrong at %lld of %lld ticks | | | |", static_cast<long long>(check.wrong),
                static_cast<long long>(check.ticks));
  }
  out += text(" %.0f | %zu |", run.bytes / s.setting.pairs, run.ns.size());
  const Run* alone = find(s, "repel");
  if (!check.equal() || alone == nullptr || !alone->check.equal()) return out + " | |\n";
  const double times = run.mean() / alone->mean();
  return out + text(" %.2f | %s |\n", times, why_near(s, run, times).c_str());
}

std::string small_table(const std::vector<SmallRun>& small) {
  std::string out =
      "\n## 4 x 8, warm\n\n" + bench::heading({"who", "near", "evaluated", "p50 [ns]", "p99 [ns]",
                                               "against every pair near", "wrong"});
  for (const SmallRun& run : small) {
    out += text("| %s | %.2g | %.3g | %.0f | %.0f | %.2f | %d |\n", run.who.c_str(), run.near,
                run.evaluated, run.p50, run.p99, run.p50 / small.front().p50, run.wrong);
  }
  return out;
}

}  // namespace

std::string to_json(const Scenario& scenario, const Run& run) {
  Object object(0);
  add_run(object, scenario, run);
  add_build(object);
  return object.str() + "\n";
}

std::string to_json(const std::vector<Scenario>& scenarios, const std::vector<SmallRun>& small) {
  Object context(0);
  add_build(context);
  std::string runs;
  for (const Scenario& scenario : scenarios) {
    for (const Run& run : scenario.runs) {
      Object object(2);
      add_run(object, scenario, run);
      runs += (runs.empty() ? "\n  " : ",\n  ") + object.str();
    }
  }
  for (const SmallRun& run : small) runs += ",\n  " + small_json(run);
  return "{\n\"context\": " + context.str() + ",\n\"benchmarks\": [" + runs + "\n]\n}\n";
}

std::string to_markdown(const std::vector<Scenario>& scenarios,
                        const std::vector<SmallRun>& small) {
  std::string out = bench::heading({"method", "threads", "pairs", "near", "evaluated", "mean [ns]",
                                    "p50", "p99", "p99.9", "bytes per pair", "ticks",
                                    "mean, times repel without threads", "why a rival is near"});
  for (const Scenario& scenario : scenarios) {
    for (const Run& run : scenario.runs) out += line(scenario, run);
  }
  return small.empty() ? out : out + small_table(small);
}

}  // namespace repel::scale
