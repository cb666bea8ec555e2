// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <ur_rtde/rtde_control_interface.h> of ur_rtde, with the published signatures of
/// what the adapter uses.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <ur_rtde/simulated_ur.hpp>

namespace ur_rtde {

class RTDEControlInterface {
 public:
  enum Flags { FLAG_UPLOAD_SCRIPT = 0x01, FLAGS_DEFAULT = FLAG_UPLOAD_SCRIPT };

  explicit RTDEControlInterface(std::string hostname, double frequency = -1.0,
                                uint16_t /*flags*/ = FLAGS_DEFAULT, int /*ur_cap_port*/ = 50002,
                                int /*rt_priority*/ = 0)
      : robot_(stand_in::robot_at(hostname)),
        period_(1.0 / (frequency > 0.0 ? frequency : 500.0)) {}
  virtual ~RTDEControlInterface() = default;

  bool isConnected() { return true; }
  bool isProgramRunning() { return !robot_.is_stopped; }
  double getStepTime() { return period_; }
  std::chrono::steady_clock::time_point initPeriod() { return {}; }
  void waitPeriod(const std::chrono::steady_clock::time_point& /*t_cycle_start*/) {
    robot_.move(period_);
  }
  /// Ranges as there: lookahead_time 0.03 to 0.2 s, gain 100 to 2000.
  bool servoJ(const std::vector<double>& q, double /*speed*/, double /*acceleration*/,
              double /*time*/, double lookahead_time, double gain) {
    if (robot_.is_stopped || q.size() != 6) return false;
    if (!(lookahead_time >= 0.03 && lookahead_time <= 0.2 && gain >= 100 && gain <= 2000)) {
      return false;
    }
    robot_.servo(q, lookahead_time);
    return true;
  }
  bool servoStop(double /*a*/ = 10.0) {
    robot_.stop();
    return true;
  }
  void stopScript() { robot_.stop(); }

 private:
  stand_in::SimulatedUr& robot_;
  double period_;  // [s]
};

}  // namespace ur_rtde
