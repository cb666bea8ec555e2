// SPDX-License-Identifier: BSD-3-Clause
#include "arm_chatter.hpp"

#include <algorithm>
#include <cmath>

namespace repel::telepresence {

namespace {

/// The largest of some traces by `measure`.
double worst(std::span<const Trace> traces, double (Trace::*measure)() const) {
  double most = 0.0;
  for (const Trace& trace : traces) most = std::max(most, (trace.*measure)());
  return most;
}

}  // namespace

ArmChatter::ArmChatter(double rate_hz) : rate_hz_(rate_hz), lever_{.rate_hz = rate_hz} {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    force_[axis].rate_hz = torque_[axis].rate_hz = rate_hz;
  }
}

void ArmChatter::add(const ArmTick& tick) {
  const TickRecord& record = tick.record;
  joints_.resize(tick.q.size(), {.rate_hz = rate_hz_});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto row = static_cast<Eigen::Index>(axis);
    force_[axis].samples.push_back(record.virtual_force.force[row]);
    torque_[axis].samples.push_back(record.virtual_force.torque[row]);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].samples.push_back(record.torques[i]);
  }
  lever_.samples.push_back(record.lever_torque);
  torques_.push_back(record.virtual_force.torque);
}

std::vector<std::string> ArmChatter::columns() {
  return {"jump of the force [N]",          "torque chatter above 30 Hz [N m]",
          "jump of the torque [N m]",       "joint chatter above 30 Hz [N m]",
          "jump of the joint torque [N m]", "lever chatter above 30 Hz [N m]",
          "jump of the lever torque [N m]"};
}

std::vector<Json> ArmChatter::row() const {
  return {worst(force_, &Trace::jump),
          worst(torque_, &Trace::chatter),
          worst(torque_, &Trace::jump),
          worst(joints_, &Trace::chatter),
          worst(joints_, &Trace::jump),
          lever_.chatter(),
          lever_.jump()};
}

Json ArmChatter::joints() const {
  Json list = Json::array();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    list.push_back({{"joint", i + 1},
                    {"chatter above 30 Hz [N m]", joints_[i].chatter()},
                    {"jump [N m]", joints_[i].jump()}});
  }
  return list;
}

Json ArmChatter::curves() const {
  const auto stride = static_cast<std::size_t>(std::llround(0.05 * rate_hz_));
  Json times = Json::array();
  Json torque = Json::array();
  Json jump = Json::array();
  for (std::size_t first = 1; first + stride <= torques_.size(); first += stride) {
    double most = 0.0;
    double widest = 0.0;
    for (std::size_t i = first; i < first + stride; ++i) {
      most = std::max(most, torques_[i].norm());
      widest = std::max(widest, (torques_[i] - torques_[i - 1]).norm());
    }
    times.push_back(static_cast<double>(first) / rate_hz_);
    torque.push_back(most);
    jump.push_back(widest);
  }
  return {{"time [s]", times}, {"torque [N m]", torque}, {"jump [N m]", jump}};
}

}  // namespace repel::telepresence
