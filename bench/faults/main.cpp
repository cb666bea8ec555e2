// SPDX-License-Identifier: BSD-3-Clause
// How the loop stands faults of readings, kinematics, clock, drive and operator.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

#include <repel/host/command_line.hpp>
#include <repel/host/machine.hpp>

#include "../distance/markdown.hpp"
#include "trial.hpp"

namespace {

using namespace repel;
using namespace repel::faults;
using bench::text;

struct Arguments {
  std::string name, kind, arm, situation, hold;
  double rate = 0.0;
  std::uint64_t seed = 1;
  bool list = false, quick = false, summary = false, short_only = false, no_brakes = false;
};

void describe(CLI::App& app, Arguments& a) {
  app.add_option("--name", a.name, "Only what has TEXT in its name")->type_name("TEXT");
  app.add_option("--class", a.kind, "Only faults of this class; sound: the runs without a fault")
      ->check(CLI::IsMember({"readings", "kinematics", "clock", "drive", "operator", "sound"}));
  app.add_option("--arm", a.arm, "Only this arm")->check(CLI::IsMember({"rails", "puma"}));
  app.add_option("--situation", a.situation, "Only this one")
      ->check(CLI::IsMember({"on the way", "pressing"}));
  app.add_option("--wall", a.hold, "Only this kind")->check(CLI::IsMember({"hard", "soft"}));
  app.add_option("--rate", a.rate, "Only this tick rate [Hz], 100 to 4000; default: 400 and 1000")
      ->check(CLI::Range(100.0, 4000.0));
  app.add_option("--seed", a.seed, "Seed of noise and of the begins of faults, 0 to 1e9")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1000000000}));
  app.add_flag("--list", a.list, "List the faults and the sound runs, and end");
  app.add_flag("--quick", a.quick, "Hard walls at 400 Hz only");
  app.add_flag("--without-brakes", a.no_brakes, "Arms whose motors alone hold them");
  app.add_flag("--summary", a.summary, "One row for a fault and an arm, with the deepest run");
  app.add_flag("--short", a.short_only, "Only rows that fall short");
  app.footer("Exit status: 0 nothing falls short, 1 something does, 2 bad usage.");
}

bool matches(const std::string& wanted, const std::string& is) {
  return wanted.empty() || wanted == is;
}
bool contains(const std::string& all, const std::string& part) {
  const auto alike = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(all.begin(), all.end(), part.begin(), part.end(), alike) != all.end();
}

std::vector<Setting> settings(const Arguments& a) {
  std::vector<Setting> all;
  for (const Arm arm : {Arm::rails, Arm::puma}) {
    for (const Situation situation : {Situation::on_the_way, Situation::pressing}) {
      for (const HoldKind hold : {HoldKind::hard, HoldKind::soft}) {
        for (const double rate : {400.0, 1000.0}) {
          if (a.rate > 0.0 && rate > 400.0) continue;
          if (a.quick && (hold == HoldKind::soft || rate > 400.0)) continue;
          if (!matches(a.arm, to_text(arm)) || !matches(a.hold, to_text(hold)) ||
              !matches(a.situation, to_text(situation))) {
            continue;
          }
          all.push_back({arm, situation, hold, a.rate > 0.0 ? a.rate : rate, a.seed, !a.no_brakes});
        }
      }
    }
  }
  return all;
}

void progress(std::size_t done, std::size_t of) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\r%zu of %zu faults%s", done, of, done < of ? "" : "\n");
}

std::string told(Status bits, int after) {
  return after < 0 ? "nothing" : text("%s, %d", to_text(bits).c_str(), after);
}

/// Some runs of a fault, of which one stands for all.
struct Row {
  Outcome outcome;
  Setting setting;
  Verdict verdict = Verdict::ok;
  int runs = 0, fall_short = 0;

  void add(const Outcome& o, const Setting& s, Verdict v) {
    const bool is_worse = runs == 0 || v > verdict || (v == verdict && o.deepest > outcome.deepest);
    if (is_worse) outcome = o, setting = s, verdict = v;
    ++runs;
    fall_short += v == Verdict::falls_short ? 1 : 0;
  }
};

void print(const Fault& fault, const Row& row) {
  const Outcome& o = row.outcome;
  std::string verdict = to_text(row.verdict);
  if (row.verdict == Verdict::excused && o.told_after < 0) verdict += ", not told";
  if (o.begun < 0) verdict += ", never at the wall";
  if (row.runs > 1) verdict += text(" (%d of %d)", row.fall_short, row.runs);
  std::printf("| %s | %s | %s | %s | %s | %.0f | %s%.2f | %.2f | %.2f | %s | %s | %s |\n",
              to_text(fault.kind), fault.name, to_text(row.setting.arm),
              to_text(row.setting.situation), to_text(row.setting.hold), row.setting.rate,
              o.ran_away ? "> " : "", 1e3 * o.deepest, o.tool_speed, o.joint_speed,
              o.unsound ? "YES" : "no", told(o.told, o.told_after).c_str(), verdict.c_str());
}

int run_faults(const Arguments& a, const std::vector<Setting>& all) {
  std::vector<const Fault*> chosen;
  for (const Fault& fault : all_faults()) {
    if (contains(fault.name, a.name) && matches(a.kind, to_text(fault.kind))) {
      chosen.push_back(&fault);
    }
  }
  if (chosen.empty() || all.empty()) return 0;
  std::printf("## Faults\n\n%s",
              bench::heading({"class", "fault", "arm", "situation", "wall", "rate [Hz]",
                              "deepest [mm]", "tool [m/s]", "joint [rad/s, m/s]", "torque unsound",
                              "told by, after [ticks]", "verdict"})
                  .c_str());
  std::vector<Outcome> without;
  for (const Setting& setting : all) without.push_back(run(setting, nullptr));
  int fall_short = 0;
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    std::map<Arm, Row> rows;
    for (std::size_t s = 0; s < all.size(); ++s) {
      const Outcome outcome = run(all[s], chosen[f]);
      const Verdict verdict = judge(*chosen[f], all[s], outcome, without[s]);
      rows[all[s].arm].add(outcome, all[s], verdict);
      fall_short += verdict == Verdict::falls_short ? 1 : 0;
      if (a.summary || (a.short_only && verdict != Verdict::falls_short)) continue;
      Row single;
      single.add(outcome, all[s], verdict);
      print(*chosen[f], single);
    }
    for (const auto& [arm, row] : rows) {
      if (!a.summary || (a.short_only && row.fall_short == 0)) continue;
      print(*chosen[f], row);
    }
    std::fflush(stdout);
    progress(f + 1, chosen.size());
  }
  std::printf("\n%zu faults, %zu runs, of which %d fall short.\n\n", chosen.size(),
              chosen.size() * all.size(), fall_short);
  return fall_short;
}

int run_sound(const Arguments& a, const std::vector<Setting>& all) {
  int fall_short = 0;
  bool has_heading = false;
  for (const Sound& sound : all_sound()) {
    if (!contains(sound.name, a.name)) continue;
    for (const Setting& setting : all) {
      if (setting.situation != Situation::on_the_way) continue;
      if (setting.hold == HoldKind::soft) continue;
      if (!has_heading) {
        std::printf(
            "## Sound arms\n\n%s",
            bench::heading({"arm that is", "arm", "rate [Hz]", "deepest [mm]",
                            "readings not believed [ticks]", "operator not in command [ticks]",
                            "first told, tick", "verdict"})
                .c_str());
        has_heading = true;
      }
      const Calm calm = run(setting, sound);
      const Verdict verdict = judge(calm);
      fall_short += verdict == Verdict::falls_short ? 1 : 0;
      if (a.short_only && verdict != Verdict::falls_short) continue;
      std::printf("| %s | %s | %.0f | %.2f | %d | %d | %s | %s |\n", sound.name,
                  to_text(setting.arm), setting.rate, 1e3 * calm.deepest, calm.blind, calm.stopped,
                  told(calm.first, calm.first_at).c_str(), to_text(verdict));
      std::fflush(stdout);
    }
  }
  return fall_short;
}

int run_all(const Arguments& a) {
  if (a.list) {
    for (const Fault& fault : all_faults())
      std::printf("%-10s  %s\n", to_text(fault.kind), fault.name);
    for (const Sound& sound : all_sound()) std::printf("%-10s  %s\n", "sound", sound.name);
    return 0;
  }
  const host::Machine machine = host::describe_machine("none");
  std::printf("%s; %s; commit %s; seed %s\n\n", machine.cpu.c_str(), machine.compiler.c_str(),
              machine.commit.c_str(), std::to_string(a.seed).c_str());
  const std::vector<Setting> all = settings(a);
  int fall_short = a.kind == "sound" ? 0 : run_faults(a, all);
  if (a.kind.empty() || a.kind == "sound") fall_short += run_sound(a, all);
  return fall_short > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start<Arguments>(argc, argv, "faults",
                                "How the loop stands faults between an arm and its cell.", 1,
                                describe, run_all);
}
