// SPDX-License-Identifier: BSD-3-Clause
// Wave reflections on a line after the hand stops, with and without the shunt of KBB2.

#include <algorithm>
#include <cmath>

#include "arm_run.hpp"
#include "part.hpp"

namespace repel::telepresence {

namespace {

constexpr double impedance = 300.0;  // Z of the line [N s/m]
constexpr double moving = 1.0;       // [s] duration of the hand motion

/// Change of the torque at the lever [N m] in each round trip after the hand has stopped.
std::vector<double> echoes(const std::string& coupling, double delay, std::uint64_t seed,
                           ArmEnd& end) {
  ArmScene scene{
      .tool = "{name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}",
      .obstacles = ""};
  scene.network =
      "{module: torque_arm}, {module: multiplex}, {module: line, delay: " + to_text(delay) +
      " s, impedance: " + to_text(impedance) + " N s/m, seed: " + std::to_string(seed) + "}" +
      coupling;
  scene.script = "{name: lead, device: torque_arm, duration: " + to_text(moving) +
                 " s, direction: 0 0 -1, lever: 0.8 rad/s}";
  // The line adds two ticks to the delay.
  const double round = 2.0 * (delay + 2.0 / scene.rate_hz);
  std::vector<double> most(5, -INFINITY);
  std::vector<double> least(5, INFINITY);
  end = run_arm(scene, moving + 5.0 * round, [&](const ArmTick& tick) {
    const auto trip = std::floor((tick.record.time - moving) / round);
    if (trip < 0.0 || trip > 4.0) return;
    const auto i = static_cast<std::size_t>(trip);
    most[i] = std::max(most[i], tick.record.lever_torque);
    least[i] = std::min(least[i], tick.record.lever_torque);
  });
  for (std::size_t i = 0; i < most.size(); ++i) most[i] -= least[i];
  return most;
}

std::string kbb2(double shunt) {
  return ", {module: kbb2, stiffness: 3 N/mm, damping: 300 N s/m, shunt: " + to_text(shunt) +
         " N s/m, force_limit: 120 N, angular_stiffness: 30 N m/rad, angular_damping: 4 N m s/rad, "
         "angular_shunt: 0.5 N m s/rad, torque_limit: 15 N m}";
}

}  // namespace

Result reflection(const Options& options) {
  Result result{.title = "What a line brings back",
                .columns = {"delay [ms]", "coupling", "at the stop [N m]", "1st echo [N m]",
                            "2nd echo [N m]", "3rd echo [N m]", "4th echo [N m]"},
                .notes = {"Change of the torque at the lever in each round trip after the hand, "
                          "which led the arm through free space, stops. Z is 300 N s/m."}};
  std::size_t done = 0;
  for (const double delay : {0.05, 0.1}) {
    for (const auto& [name, coupling] :
         std::vector<std::pair<std::string, std::string>>{{"without KBB2", ""},
                                                          {"B2 = 0", kbb2(0.0)},
                                                          {"B2 = Z/4", kbb2(0.25 * impedance)},
                                                          {"B2 = Z/2", kbb2(0.5 * impedance)},
                                                          {"B2 = Z", kbb2(impedance)}}) {
      ArmEnd end;
      const std::vector<double> changes = echoes(coupling, delay, options.seed, end);
      std::vector<Json> row{1e3 * delay, name};
      row.insert(row.end(), changes.begin(), changes.end());
      result.rows.push_back(row);
      result.fail(to_text(1e3 * delay) + " ms, " + name, end.complaint);
      progress("reflection", ++done, 10);
    }
  }
  return result;
}

}  // namespace repel::telepresence
