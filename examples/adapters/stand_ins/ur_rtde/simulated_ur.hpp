// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The robot behind the stand-in for ur_rtde: six joints that follow the commands of servoJ after a
/// dead time, with a lag. Time is simulated: `waitPeriod` moves it on.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace ur_rtde::stand_in {

struct SimulatedUr {
  std::vector<double> q{0.0, -M_PI / 2, M_PI / 2, -M_PI / 2, -M_PI / 2, 0.0};  // [rad]
  std::vector<double> v = std::vector<double>(6);                              // [rad/s]
  double time = 100.0;      // [s] since it was switched on
  std::size_t dead = 4;     // [periods] from a command to its effect
  double lookahead = 0.03;  // [s] of the last servoJ: here its lag
  bool is_servoing = false;
  bool is_stopped = false;  // by its protective stop
  bool is_blocked = false;  // something holds it
  double fastest = 0.0;     // [rad/s] so far
  std::vector<std::vector<double>> under_way{};

  void servo(const std::vector<double>& wanted, double over) {
    is_servoing = true;
    lookahead = over;
    under_way.push_back(wanted);
  }
  void stop() {
    is_servoing = false;
    under_way.clear();
    v.assign(6, 0.0);
  }
  void move(double period) {
    time += period;
    if (is_stopped) stop();
    if (under_way.size() <= dead) return;
    while (under_way.size() > dead + 1) under_way.erase(under_way.begin());
    const double share = is_blocked ? 0.0 : 1.0 - std::exp(-period / lookahead);
    for (std::size_t i = 0; i < 6; ++i) {
      const double way = share * (under_way.front()[i] - q[i]);
      q[i] += way;
      v[i] = way / period;
      fastest = std::fmax(fastest, std::abs(v[i]));
    }
  }
};

/// The robot at an address.
inline SimulatedUr& robot_at(const std::string& address) {
  static std::map<std::string, SimulatedUr> robots;
  return robots[address];
}

}  // namespace ur_rtde::stand_in
