// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/report/chatter_report.hpp>

#include <cmath>

#include <repel/host/figure.hpp>

namespace repel::runs {
namespace {

using host::figure;
using nlohmann::ordered_json;

bool slides(const ArmResult& arm, std::size_t joint) {
  return arm.joints[joint] == JointType::prismatic;
}

}  // namespace

std::vector<NamedChatter> chatter_list(const ArmResult& arm) {
  std::vector<NamedChatter> list{{"walls, force", "N", arm.chatter.wall_force},
                                 {"walls, torque", "N m", arm.chatter.wall_torque}};
  for (std::size_t i = 0; i < arm.chatter.joints.size(); ++i) {
    list.push_back({arm.joint_names[i], slides(arm, i) ? "N" : "N m", arm.chatter.joints[i]});
  }
  if (arm.chatter.lever) list.push_back({"lever", "N m", *arm.chatter.lever});
  return list;
}

std::string about_chatter() {
  return "root mean square above " + figure(chatter_above_hz, 0) +
         " Hz, and largest jump from one tick to the next";
}

void print_chatter(const RunResult& result, std::FILE* out) {
  for (const ArmResult& arm : result.arms) {
    const std::string title = arm.name.empty() ? "chatter" : "chatter of " + arm.name;
    std::fprintf(out, "  %-22s %s\n", title.c_str(), about_chatter().c_str());
    for (const NamedChatter& each : chatter_list(arm)) {
      std::string rms = "not known";
      if (std::isfinite(each.chatter.rms)) rms = figure(each.chatter.rms, 3) + ' ' + each.unit;
      std::fprintf(out, "    %-20s rms %13s   jump %10s %s\n", each.name.c_str(), rms.c_str(),
                   figure(each.chatter.jump, 3).c_str(), each.unit);
    }
  }
}

ordered_json chatter_to_json(const ArmResult& arm) {
  const ArmChatter& c = arm.chatter;
  ordered_json joints = ordered_json::array();
  for (std::size_t i = 0; i < c.joints.size(); ++i) {
    const std::string unit = slides(arm, i) ? "_n" : "_nm";
    joints.push_back({{"name", arm.joint_names[i]},
                      {"rms" + unit, c.joints[i].rms},
                      {"jump" + unit, c.joints[i].jump}});
  }
  ordered_json lever;
  if (c.lever) lever = {{"rms_nm", c.lever->rms}, {"jump_nm", c.lever->jump}};
  return {{"above_hz", chatter_above_hz},
          {"walls",
           {{"force_rms_n", c.wall_force.rms},
            {"force_jump_n", c.wall_force.jump},
            {"torque_rms_nm", c.wall_torque.rms},
            {"torque_jump_nm", c.wall_torque.jump}}},
          {"joints", joints},
          {"lever", lever}};
}

}  // namespace repel::runs
