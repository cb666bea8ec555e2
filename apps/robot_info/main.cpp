// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Shows the content of a robot description: joints, links, convex parts and tips.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <repel/host/command_line.hpp>
#include <repel/host/times.hpp>
#include <repel/robots/mjcf.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/world/kinematics.hpp>

#ifdef REPEL_ROBOT_INFO_COVERS
#include <repel/scene/part_list.hpp>
#endif

namespace {

using namespace repel;
using Json = nlohmann::ordered_json;

struct Arguments {
  std::string urdf, srdf, json;
  std::vector<std::string> hold;
  bool is_mjcf = false;
  UrdfOptions options;
};

/// A joint to hold from "joint" or "joint=value"; none from other text.
std::optional<Hold> hold_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return Hold(text);
  const std::string name = text.substr(0, equals);
  const char* const end = text.data() + text.size();
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data() + equals + 1, end, value);
  std::string unit(rest, end);
  std::erase(unit, ' ');
  constexpr double degree = std::numbers::pi / 180.0;
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  if (unit.empty()) return Hold(name, value);
  if (unit == "rad") return Hold(name, value, JointType::revolute);
  if (unit == "deg") return Hold(name, value * degree, JointType::revolute);
  if (unit == "m") return Hold(name, value, JointType::prismatic);
  if (unit == "mm") return Hold(name, value / 1000.0, JointType::prismatic);
  return std::nullopt;
}

void describe(CLI::App& app, Arguments& a) {
  app.add_option("urdf", a.urdf, "Robot description, plain URDF")->required()->type_name("FILE");
  app.add_flag("--mjcf", a.is_mjcf, "The file is MJCF, the format of MuJoCo");
  app.add_option("--srdf", a.srdf, "Its semantic description: link pairs that may touch")
      ->type_name("FILE");
  app.add_option("--package-path", a.options.package_paths,
                 "Folder of package://: a package, or a folder with packages; may be repeated")
      ->type_name("DIR")
      ->check(CLI::ExistingDirectory);
  app.add_option("--tip", a.options.tip,
                 "Link with the tool frame, or site of MJCF; the joints leading to it are the arm")
      ->type_name("LINK");
  app.add_option("--hold", a.hold,
                 "Joints to hold, and where: rad, deg, m or mm; without a unit rad or m. Those "
                 "beside the arm are held without being named here")
      ->type_name("JOINT[=VALUE],JOINT")
      ->delimiter(',')
      ->check([](const std::string& text) {
        return hold_of(text) ? std::string()
                             : "'" + text + "'; allowed: JOINT, or JOINT=VALUE with a number and " +
                                   "rad, deg, m, mm or no unit";
      });
  app.add_option("--json", a.json, "Write the output, and more, as JSON to FILE")
      ->type_name("FILE");
  app.footer(std::string("Collision meshes become the convex parts in MESH.parts.yaml beside them "
                         "(written by the\n"
                         "program cover), or else their convex hulls") +
             (reads_meshes() ? "" : "; no hulls here: built without assimp (libassimp-dev)") +
             ".\nExit status: 0 the file was taken whole, 1 it was refused, 2 bad usage.");
}

/// Number of corners; 0 for round parts.
std::size_t vertices_of(const RobotPart& part) {
  return part.kind == PartKind::box ? 8 : part.points.size();
}

/// The kinds of the parts of `link`, with their corners; the parts of a cover are counted together.
void print_parts(const Robot& robot, const std::string& link) {
  std::size_t hulls = 0;
  std::size_t corners = 0;
  for (const RobotPart& part : robot.parts) {
    if (part.in_link != link) continue;
    if (part.is_of_cover) {
      ++hulls;
      corners += part.points.size();
      continue;
    }
    std::printf(" %s", to_text(part.kind));
    if (const auto count = vertices_of(part)) std::printf(" (%zu)", count);
  }
  if (hulls > 0) std::printf(" %zu hulls of covers (%zu)", hulls, corners);
}

const char* type_of(const ArmLink& joint) {
  if (joint.type == JointType::prismatic) return "prismatic";
  return std::isinf(joint.upper) ? "continuous" : "revolute";
}

struct Tip {
  std::string name;
  Pose X_WT;  ///< [m] with every joint at zero
};

std::vector<Tip> tips_at_zero(const Robot& robot) {
  Kinematics kinematics(robot.arm);
  kinematics.update(std::vector<double>(robot.arm.links.size(), 0.0));
  std::vector<Tip> tips;
  for (const RobotLink& link : robot.links) {
    if (std::count(robot.tips.begin(), robot.tips.end(), link.name) == 0) continue;
    tips.push_back({link.name, kinematics.X_WL(link.link) * link.X_LN});
  }
  return tips;
}

bool slides(const HeldJoint& joint) {
  return joint.type == "prismatic";
}

/// The joints that do not move, and the choices that the file leaves open.
void print_choices(const Robot& robot) {
  if (!robot.held.empty()) std::printf("\n%-32s %-10s %10s\n", "held joint", "type", "at");
  for (const HeldJoint& joint : robot.held) {
    const double unit = slides(joint) ? 1000.0 : 180.0 / std::numbers::pi;
    std::printf("%-32s %-10s %10.4g %-3s  %s\n", joint.name.c_str(), joint.type.c_str(),
                unit * joint.position, slides(joint) ? "mm" : "deg", joint.reason.c_str());
  }
  std::printf("\nchain to %s: %s\n", robot.end.c_str(), robot.end_reason.c_str());
  std::printf("tool %s: %s\n", robot.tool.c_str(), robot.tool_reason.c_str());
}

void print(const Robot& robot, const std::vector<Tip>& tips) {
  std::printf("%s: %zu degrees of freedom, %zu links, %zu collision parts\n\n",
              robot.arm.name.c_str(), robot.arm.links.size(), robot.links.size(),
              robot.parts.size());
  std::printf("%-32s %-10s %10s %10s %10s %12s\n", "joint", "type", "lower", "upper", "speed",
              "effort");
  for (const ArmLink& joint : robot.arm.links) {
    const bool slides = joint.type == JointType::prismatic;
    const double unit = slides ? 1000.0 : 180.0 / std::numbers::pi;
    std::printf("%-32s %-10s %10.4g %10.4g %10.4g %12.4g  %s\n", joint.joint_name.c_str(),
                type_of(joint), unit * joint.lower, unit * joint.upper, unit * joint.velocity_limit,
                joint.effort_limit, slides ? "mm, mm/s, N" : "deg, deg/s, N m");
  }
  print_choices(robot);
  std::printf("\n%-32s %10s  %s\n", "link", "mass [kg]", "collision parts (corners)");
  for (const RobotLink& link : robot.links) {
    std::printf("%-32s %10.4g ", link.name.c_str(), link.mass);
    print_parts(robot, link.name);
    std::puts("");
  }
  std::printf("\n%-32s %10s %10s %10s   with every joint at zero\n", "tip", "x [mm]", "y [mm]",
              "z [mm]");
  for (const Tip& tip : tips) {
    const Vec3 p = 1000.0 * tip.X_WT.translation();
    std::printf("%-32s %10.3f %10.3f %10.3f\n", tip.name.c_str(), p.x(), p.y(), p.z());
  }
}

/// The entries of a matrix row by row; null if not finite, which JSON cannot represent.
template <class Matrix>
Json numbers(const Matrix& m) {
  Json list = Json::array();
  for (Eigen::Index row = 0; row < m.rows(); ++row) {
    for (Eigen::Index column = 0; column < m.cols(); ++column) list.push_back(m(row, column));
  }
  return list;
}

Json report_of(const Robot& robot, const std::vector<Tip>& tips,
               const std::vector<DisabledCollision>& disabled) {
  Json report{{"name", robot.arm.name}, {"dof", robot.arm.links.size()}};
  report["chain"] = {{"end", robot.end}, {"reason", robot.end_reason}};
  report["tool"] = {{"link", robot.tool}, {"reason", robot.tool_reason}};
  for (const char* list : {"joints", "held_joints", "links", "tips", "disabled_collisions"}) {
    report[list] = Json::array();
  }
  for (const ArmLink& joint : robot.arm.links) {
    report["joints"].push_back({{"name", joint.joint_name},
                                {"type", type_of(joint)},
                                {"lower", joint.lower},
                                {"upper", joint.upper},
                                {"velocity", joint.velocity_limit},
                                {"effort", joint.effort_limit},
                                {"link", joint.name}});
  }
  for (const HeldJoint& joint : robot.held) {
    report["held_joints"].push_back({{"name", joint.name},
                                     {"type", joint.type},
                                     {"position", joint.position},
                                     {"unit", slides(joint) ? "m" : "rad"},
                                     {"reason", joint.reason}});
  }
  for (const RobotLink& link : robot.links) {
    Json parts = Json::array();
    for (const RobotPart& part : robot.parts) {
      if (part.in_link != link.name) continue;
      parts.push_back({{"name", part.name},
                       {"kind", to_text(part.kind)},
                       {"vertices", vertices_of(part)},
                       {"of_cover", part.is_of_cover}});
    }
    report["links"].push_back({{"name", link.name}, {"mass", link.mass}, {"parts", parts}});
  }
  for (const Tip& tip : tips) {
    report["tips"].push_back({{"name", tip.name},
                              {"position", numbers(tip.X_WT.translation())},
                              {"rotation", numbers(tip.X_WT.linear())}});
  }
  for (const DisabledCollision& pair : disabled) {
    report["disabled_collisions"].push_back(
        {{"link1", pair.first}, {"link2", pair.second}, {"reason", pair.reason}});
  }
  return report;
}

int run(const Arguments& arguments) {
  host::Output json(arguments.json);
  UrdfOptions options = arguments.options;
  for (const std::string& text : arguments.hold) options.hold.push_back(hold_of(text).value());
  std::vector<std::string> part_lists;
#ifdef REPEL_ROBOT_INFO_COVERS
  options.convex_parts = [&part_lists](const std::string& mesh, const Vec3& scale) {
    return scene::parts_beside(mesh, scale, part_lists);
  };
#endif
  const Robot robot = arguments.is_mjcf ? load_mjcf_arm(arguments.urdf, {options.tip, options.hold})
                                        : load_arm(arguments.urdf, options);
  const std::vector<DisabledCollision> disabled =
      arguments.srdf.empty() ? std::vector<DisabledCollision>{}
                             : load_disabled_collisions(arguments.srdf, robot);
  const std::vector<Tip> tips = tips_at_zero(robot);
  print(robot, tips);
  for (const std::string& list : part_lists) std::printf("\nconvex parts from %s", list.c_str());
  if (!part_lists.empty()) std::puts("");
  if (!arguments.srdf.empty()) std::printf("\n%zu link pairs may touch\n", disabled.size());
  host::write(report_of(robot, tips, disabled), json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return repel::host::start(argc, argv, "robot_info",
                            "Shows the content of a URDF or MJCF file, or why it is refused.", 1,
                            describe, run);
}
