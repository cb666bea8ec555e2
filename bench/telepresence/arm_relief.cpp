// SPDX-License-Identifier: BSD-3-Clause
// Compliance along chosen directions: the stiffness between the command and a wall.

#include <cmath>

#include "arm_run.hpp"
#include "part.hpp"

namespace repel::telepresence {

namespace {

constexpr double relief_speed = 0.005;  // [m/s] of the command
constexpr double coupling = 3000.0;     // K of KBB2 [N/m]

struct ReliefCase {
  const char* compliant;
  double stiffness;  // of RELIEF [N/m]
  const char* into;
  Vec3 direction;
  bool gives_way;  // RELIEF is compliant in that direction
};
const ReliefCase relief_cases[] = {
    {"none", 500.0, "table", {0, 0, -1}, false}, {"z", 500.0, "table", {0, 0, -1}, true},
    {"z", 2000.0, "table", {0, 0, -1}, true},    {"y", 500.0, "table", {0, 0, -1}, false},
    {"none", 500.0, "side", {0, 1, 0}, false},   {"z", 500.0, "side", {0, 1, 0}, false},
    {"y", 500.0, "side", {0, 1, 0}, true},
};

/// Series connection of the spring of RELIEF and the spring K of KBB2 [N/m].
double expected(const ReliefCase& each) {
  return 1.0 / (1.0 / coupling + (each.gives_way ? 1.0 / each.stiffness : 0.0));
}

/// Force of the coupling on the tool, and lag of the tool behind the command.
struct Mark {
  double force = NAN;  // [N]
  double lag = NAN;    // [m]
};

/// Slope of that force over the lag while the wall force rises from 10 to 40 N [N/m].
double measured(const ReliefCase& each, double rate_hz, std::string& complaint) {
  ArmScene scene{
      .tool = "{name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}",
      .obstacles =
          "{name: table, shape: box, size: 0.8 0.8 0.05 m, position: 0.5 -0.15 0.40 m, "
          "law: wall}, {name: side, shape: box, size: 0.8 0.05 0.4 m, position: 0.5 "
          "-0.085 0.65 m, law: wall}",
      .rate_hz = rate_hz};
  const std::string relief = std::string("{module: relief, frame: world, compliant: [") +
                             (each.compliant == std::string("none") ? "" : each.compliant) +
                             "], stiffness: " + to_text(each.stiffness) +
                             " N/m, damping: 50 N s/m}, ";
  scene.network.insert(scene.network.find("{module: kbb2"), relief);
  scene.network.insert(scene.network.find("spaceball") + 9, ", dead_band: 0 m/s");
  scene.script = std::string("{name: press, device: spaceball, duration: 40 s, linear: 0 ") +
                 to_text(relief_speed * each.direction.y()) + " " +
                 to_text(relief_speed * each.direction.z()) + " m/s}";
  Mark first;
  Mark last;
  const ArmEnd end = run_arm(scene, 40.0, [&](const ArmTick& tick) {
    const double wall = tick.record.virtual_force.force.norm();
    const Mark now{tick.record.coupling.force.dot(each.direction),
                   relief_speed * tick.record.time - tick.record.p_WT.dot(each.direction)};
    if (std::isnan(first.force) && wall > 10.0) first = now;
    if (std::isnan(last.force) && wall > 40.0) last = now;
  });
  complaint = end.complaint;
  return (last.force - first.force) / (last.lag - first.lag);
}

}  // namespace

Result relief(const Options& options) {
  Result result{
      .title = "Compliance through RELIEF",
      .columns = {"compliant", "its stiffness [N/m]", "pressed into", "rate [Hz]", "measured [N/m]",
                  "expected [N/m]", "off"},
      .notes = {
          "Slope of the operator's force on the tool against its lag behind the command, which "
          "moves at 5 mm/s, while the force of the wall rises from 10 to 40 N. Expected: RELIEF "
          "and KBB2 as springs in series; a row fails if it is off by more than a tenth."}};
  std::size_t done = 0;
  const std::vector<double> rates = options.quick ? std::vector{400.0} : std::vector{400.0, 4000.0};
  for (const ReliefCase& each : relief_cases) {
    for (const double rate_hz : rates) {
      std::string complaint;
      const double found = measured(each, rate_hz, complaint);
      const double off = found / expected(each) - 1.0;
      const std::string row = std::string(each.compliant) + " into " + each.into;
      result.fail(row, complaint);
      if (!(std::abs(off) < 0.1)) result.fail(row, to_text(found) + " N/m");
      result.rows.push_back(
          {each.compliant, each.stiffness, each.into, rate_hz, found, expected(each), off});
      progress("relief", ++done, std::size(relief_cases) * rates.size());
    }
  }
  return result;
}

}  // namespace repel::telepresence
