// SPDX-License-Identifier: BSD-3-Clause
#include "robot_reader.hpp"

#include "grammar.hpp"
#include "pose_reader.hpp"

namespace repel::scene::detail {
namespace {

Pose pose_at(const Map& parent, std::string_view key) {
  const Value* value = parent.find(key);
  return value != nullptr ? pose_of(Map(*value, grammar::frame())) : Pose::Identity();
}

/// One of two formats.
void read_file(const Map& map, RobotChoice& robot) {
  const Value* const mjcf = map.find("mjcf");
  robot.is_mjcf = mjcf != nullptr;
  robot.urdf = (robot.is_mjcf ? *mjcf : map.at("urdf")).path();
  if (!robot.is_mjcf) return;
  for (const char* key : {"urdf", "srdf", "packages", "covers"}) {
    if (const Value* value = map.find(key))
      value->fail("beside 'mjcf'; allowed: with 'urdf' alone");
  }
}

/// Angles, or a list of angles and, for prismatic joints, lengths.
void read_start(const Value& value, RobotChoice& robot) {
  robot.start_line = value.line();
  const auto add = [&](const Value& entry, const Rule& rule, JointType type) {
    for (const double q : entry.numbers(rule, 1, 64)) {
      robot.start.push_back(q);
      robot.start_types.push_back(type);
    }
  };
  if (!value.is_list()) return add(value, angles, JointType::revolute);
  for (const Value& entry : value.list()) {
    if (quantity(entry.text(), unit::length)) {
      add(entry, position, JointType::prismatic);
    } else {
      add(entry, angles, JointType::revolute);
    }
  }
}

void read_payload(const Value& value, RobotChoice& robot) {
  const Map map(value, grammar::payload());
  robot.payload.mass = map.number("mass");
  map.read("position", robot.payload.p_TC);
  map.read("known", robot.payload_known);
}

void read_admittance(const Value& value, AdmittanceOptions& admittance) {
  const Map map(value, grammar::admittance());
  map.read("response", admittance.response);
  map.read("scale", admittance.scale);
  map.read("rest_time", admittance.rest_time);
}

void read_sensor_errors(const Value& value, SensorErrors& errors) {
  const Map map(value, grammar::sensor_errors());
  map.read("force_noise", errors.force_noise);
  map.read("torque_noise", errors.torque_noise);
  map.read("force_bias", errors.bias.force);
  map.read("torque_bias", errors.bias.torque);
  map.read("seed", errors.seed);
}

/// A list of joints, or a map from joints to angles and lengths.
std::vector<JointHold> holds_of(const Value& value) {
  std::vector<JointHold> holds;
  if (value.is_list()) {
    for (const Value& entry : value.list()) holds.push_back({entry.text()});
    return holds;
  }
  const Map map(value);
  for (const auto& [joint, at] : map.entries()) {
    if (quantity(at.text(), unit::length)) {
      holds.push_back({joint, at.number(position), JointType::prismatic});
    } else {
      holds.push_back({joint, at.number(angles), JointType::revolute});
    }
  }
  return holds;
}

}  // namespace

RobotChoice robot_of(const Value& value, const Laws& laws) {
  const Map map(value, grammar::robot());
  RobotChoice robot;
  read_file(map, robot);
  if (const Value* srdf = map.find("srdf")) robot.srdf = srdf->path();
  if (map.find("self_law")) robot.self_law = law_called(laws, map, "self_law");
  map.read("tip_link", robot.tip_link);
  if (const Value* hold = map.find("hold")) robot.hold = holds_of(*hold);
  if (const Value* packages = map.find("packages")) robot.packages = packages->folders();
  map.read("covers", robot.covers);
  read_start(map.at("start"), robot);
  robot.X_WB = pose_at(map, "base");
  robot.X_LT = pose_at(map, "tool_frame");
  if (const Value* payload = map.find("payload")) read_payload(*payload, robot);
  if (const Value* admittance = map.find("admittance")) {
    read_admittance(*admittance, robot.admittance.emplace());
    robot.admittance_line = admittance->line();
  }
  map.read("drive_delay", robot.drive_delay);
  if (const Value* errors = map.find("sensor_errors")) read_sensor_errors(*errors, robot.sensor);
  if (const Value* links = map.find("links")) {
    robot.links.emplace();
    for (const Value& link : links->list()) robot.links->push_back(link.text());
  }
  return robot;
}

}  // namespace repel::scene::detail
