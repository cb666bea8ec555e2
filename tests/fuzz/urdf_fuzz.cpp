// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary text as a robot description, as the file of a mesh it names, or as its SRDF file: read,
// or refused by a SetupError that names the file; a robot that was read can be moved. The role of a
// text is chosen by its contents.
#include <console_bridge/console.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <end_to_end/folder.hpp>
#include <fuzz/bytes.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/robots/dynamics.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/robots/visuals.hpp>
#include <repel/world/kinematics.hpp>

namespace repel {
namespace {

using fuzz::require;

bool has(std::string_view text, std::string_view word) {
  return text.find(word) != std::string_view::npos;
}

void check(const Robot& robot) {
  require(!robot.arm.links.empty(), "an arm moves");
  for (const RobotPart& part : robot.parts) {
    require(is_finite(part.X_LP), "a part is somewhere");
    for (const Vec3& p : part.points) require(is_finite(p), "a corner is somewhere");
    if (part.points.size() > 200) continue;  // their reduction is tested by another target
    try {
      (void)shape_of(part);
    } catch (const SetupError&) {
      continue;
    }
  }
  try {
    Kinematics kinematics(robot.arm);
    Dynamics dynamics(robot.arm);
    const std::vector<double> q(robot.arm.links.size(), 0.1);
    std::vector<double> torques(q.size());
    kinematics.update(q);
    dynamics.bias(q, q, torques);
  } catch (const SetupError&) {
    return;
  }
}

/// What a robot looks like never refuses it, and a page can draw it.
void check(const RobotVisuals& visuals) {
  std::size_t triangles = 0;
  for (const RobotVisual& each : visuals.all) {
    require(is_finite(each.X_LV), "a visual is somewhere");
    for (const Vec3& p : each.mesh.vertices) require(is_finite(p), "and so is its corner");
    for (const auto& triangle : each.mesh.triangles) {
      for (const int vertex : triangle) {
        require(vertex >= 0 && static_cast<std::size_t>(vertex) < each.mesh.vertices.size(),
                "a triangle is of vertices");
      }
    }
    triangles += each.mesh.triangles.size();
  }
  require(triangles <= most_visual_triangles, "they are bounded");
}

std::string robot_with_mesh(const std::string& file) {
  return "<robot name='r'><link name='base'/><link name='arm'><collision><geometry>"
         "<mesh filename='" +
         file +
         "'/></geometry></collision></link><joint name='j' type='continuous'><parent link='base'/>"
         "<child link='arm'/><axis xyz='0 0 1'/></joint></robot>";
}

/// The file extension by which assimp recognizes a format, of those used for robots.
std::string ending_of(std::string_view text) {
  if (has(text, "COLLADA")) return "dae";
  if (has(text, "\nf ") || text.substr(0, 2) == "v ") return "obj";
  if (text.substr(0, 3) == "ply") return "ply";
  return "stl";
}

void check_text(const std::string& text) {
  static const test::Folder folder;
  if (has(text, "disable_collisions")) {
    static const Robot robot = load_arm("robots/puma560.urdf");
    (void)load_disabled_collisions(folder.with("robot.srdf", text), robot);
  } else if (has(text, "<robot") || has(text, "<link")) {
    (void)folder.with("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
    const Robot robot = parse_arm(text, {}, folder / "robot.urdf");
    check(robot);
    check(parse_visuals(text, robot, {}, folder / "robot.urdf"));
  } else {
    const std::string mesh = "mesh." + ending_of(text);
    (void)folder.with(mesh, text);
    check(parse_arm(robot_with_mesh(mesh), {}, folder / "robot.urdf"));
  }
}

}  // namespace
}  // namespace repel

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
  try {
    repel::check_text(std::string(data, data + size));
  } catch (const repel::SetupError& error) {
    repel::fuzz::require(error.file().find("robot.") != std::string::npos,
                         "an error names the file");
  }
  return 0;
}
