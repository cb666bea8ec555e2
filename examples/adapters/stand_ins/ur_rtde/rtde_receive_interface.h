// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <ur_rtde/rtde_receive_interface.h> of ur_rtde, with the published signatures of
/// what the adapter uses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <ur_rtde/simulated_ur.hpp>

namespace ur_rtde {

class RTDEReceiveInterface {
 public:
  explicit RTDEReceiveInterface(std::string hostname, double /*frequency*/ = -1.0,
                                std::vector<std::string> /*variables*/ = {},
                                bool /*verbose*/ = false,
                                bool /*use_upper_range_registers*/ = false, int /*rt_priority*/ = 0)
      : robot_(stand_in::robot_at(hostname)) {}
  virtual ~RTDEReceiveInterface() = default;

  bool isConnected() { return true; }
  double getTimestamp() { return robot_.time; }
  std::vector<double> getActualQ() { return robot_.q; }
  std::vector<double> getActualQd() { return robot_.v; }
  bool isProtectiveStopped() { return robot_.is_stopped; }
  bool isEmergencyStopped() { return false; }

 private:
  stand_in::SimulatedUr& robot_;
};

}  // namespace ur_rtde
