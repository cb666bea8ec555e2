// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/urdf.hpp>

#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <repel/base/setup_error.hpp>
#include <repel/geometry/facets.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/visuals.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "description.hpp"
#include "interpreter.hpp"

namespace repel::python {
namespace {

/// The arguments of a repel.Link.
nb::dict link_dict(const ArmLink& link) {
  nb::dict each;
  each["name"] = link.joint_name;
  each["type"] = link.type == JointType::revolute ? "revolute" : "prismatic";
  each["X_PJ"] = to_array(link.X_PJ);
  each["axis_J"] = to_array(link.axis_J);
  each["p_LC"] = to_array(link.p_LC);
  const Mat3 rows = link.I_C_L.transpose();  // symmetric but for rounding
  each["I_C_L"] = to_array(rows.data(), {3, 3});
  for (const auto& [name, member] : link_numbers) each[name] = link.*member;
  return each;
}

/// The arguments of a repel.Part.
nb::dict part_dict(const std::string& name, const Shape& shape, const Pose& X_LP, int link) {
  nb::dict each;
  each["name"] = name;
  each["shape"] = shape;
  each["X_FP"] = to_array(X_LP);
  each["link"] = link;
  return each;
}

/// What is seen in one link has names of its own.
std::string visual_name(const RobotVisual& visual, std::size_t index) {
  return visual.collision.empty() ? visual.in_link + "/visual " + std::to_string(index)
                                  : visual.collision;
}

Shape hull_of(const RobotVisual& visual) {
  const std::vector<Facet> facets = hull_facets(visual.mesh.vertices);
  return Shape::hull(
      facets.empty() ? visual.mesh.vertices : hull_corners(visual.mesh.vertices, facets),
      {.levels = 1});
}

/// Those of moving links: the base is fixed, as obstacles are.
nb::list visual_parts(const RobotVisuals& visuals) {
  nb::list all;
  for (std::size_t i = 0; i < visuals.all.size(); ++i) {
    const RobotVisual& visual = visuals.all[i];
    if (visual.link < 0) continue;
    all.append(part_dict(visual_name(visual, i), hull_of(visual), visual.X_LV, visual.link));
  }
  return all;
}

nb::list collision_parts(const Robot& robot) {
  nb::list all;
  for (const RobotPart& part : robot.parts) {
    if (part.link < 0) continue;
    all.append(part_dict(part.name, shape_of(part, {.levels = 1}), part.X_LP, part.link));
  }
  return all;
}

/// @param kind of parts: collision, visual or none @return the arguments of a repel.Arm
nb::dict read_urdf(const std::string& path, const std::string& tip,
                   std::vector<std::string> packages, const std::string& kind) {
  if (kind != "collision" && kind != "visual" && kind != "none") {
    throw SetupError("parts is '" + kind + "'; allowed: collision, visual, None");
  }
  const UrdfOptions options{.tip = tip, .package_paths = std::move(packages)};
  Robot robot;
  RobotVisuals visuals;
  {
    const Released others_go_on;
    robot = load_arm(path, options);
    if (kind == "visual") visuals = load_visuals(path, robot, options);
  }
  nb::list links;
  for (const ArmLink& link : robot.arm.links) links.append(link_dict(link));
  nb::dict arm;
  arm["links"] = links;
  arm["parts"] = kind == "collision" ? collision_parts(robot) : visual_parts(visuals);
  arm["X_WB"] = to_array(robot.arm.X_WB);
  arm["X_LT"] = to_array(robot.arm.X_LT);
  arm["gravity_W"] = to_array(robot.arm.gravity_W);
  arm["warnings"] = visuals.warnings;
  return arm;
}

}  // namespace

void bind_robots(nb::module_& m) {
  m.def("_read_urdf", &read_urdf, nb::arg("path"), nb::arg("tip"), nb::arg("packages"),
        nb::arg("parts"),
        nb::sig("def _read_urdf(path: str, tip: str, packages: list[str], parts: str) -> "
                "dict[str, typing.Any]"));
}

}  // namespace repel::python
