// SPDX-License-Identifier: BSD-3-Clause
#include "description.hpp"

#include <string>
#include <utility>

#include <nanobind/stl/pair.h>

#include <repel/base/setup_error.hpp>
#include <repel/cell/admittance.hpp>
#include <repel/world/kinematics.hpp>
#ifdef REPEL_PYTHON_SCENES
#include <repel/scene/build_network.hpp>
#endif

#include "arrays.hpp"

namespace repel::python {
namespace {

double number(nb::handle from, const char* name) {
  return value_of<double>(from.attr(name), name, "a number");
}

std::string text(nb::handle from, const char* name) {
  return value_of<std::string>(from.attr(name), name, "a string");
}

bool is_so(nb::handle from, const char* name) {
  return value_of<bool>(from.attr(name), name, "True or False");
}

Shape shape_of(nb::handle from) {
  return *value_of<const Shape*>(from.attr("shape"), "shape", "a Shape");
}

/// None: `law` stays as it is.
template <class Law>
void read_law(nb::handle from, const char* name, Law& law) {
  const nb::object value = from.attr(name);
  if (!value.is_none()) law = *value_of<const ForceLaw*>(value, name, "a ForceLaw");
}

/// @throws nanobind::type_error unless it is of that class of repel/description.py
void require_kind(nb::handle value, const std::string& name, const std::string& kind) {
  const nb::object type = nb::module_::import_("repel.description").attr(kind.c_str());
  if (!nb::isinstance(value, type)) refuse_type(value, name, ("a repel." + kind).c_str());
}

/// What a sequence holds, each of that class.
std::vector<nb::object> all_of(nb::handle values, const std::string& name,
                               const std::string& kind) {
  if (!nb::isinstance<nb::iterable>(values)) {
    refuse_type(values, name, ("a sequence of repel." + kind).c_str());
  }
  std::vector<nb::object> all;
  for (nb::handle each : values) {
    require_kind(each, name + "[" + std::to_string(all.size()) + "]", kind);
    all.push_back(nb::borrow(each));
  }
  return all;
}

Pose optional_pose(nb::handle from, const char* name) {
  const nb::object value = from.attr(name);
  return value.is_none() ? Pose::Identity() : pose_of(value, name);
}

Mat3 inertia_of(nb::handle from) {
  constexpr const char* expected = "three by three numbers (3, 3)";
  const nb::object value = from.attr("I_C_L");
  if (value.is_none()) return Mat3::Zero();
  const Array I = array_of(value, "I_C_L", expected);
  if (I.ndim() != 2 || I.shape(0) != 3 || I.shape(1) != 3) refuse_shape(I, "I_C_L", expected);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(I.data());
}

ArmLink link_of(nb::handle from) {
  const std::string type = text(from, "type");
  if (type != "revolute" && type != "prismatic") {
    throw SetupError("the type of a link is '" + type + "'; allowed: revolute, prismatic");
  }
  ArmLink link;
  link.name = text(from, "name");
  link.joint_name = link.name;
  link.type = type == "revolute" ? JointType::revolute : JointType::prismatic;
  link.X_PJ = optional_pose(from, "X_PJ");
  link.axis_J = vector_of(from.attr("axis_J"), "axis_J");
  link.p_LC = vector_of(from.attr("p_LC"), "p_LC");
  link.I_C_L = inertia_of(from);
  for (const auto& [name, member] : link_numbers) link.*member = number(from, name);
  return link;
}

ArmPart part_of(nb::handle from) {
  const nb::object link = from.attr("link");
  return {
      .name = text(from, "name"),
      .shape = shape_of(from),
      .X_FP = optional_pose(from, "X_FP"),
      .link = link.is_none() ? ArmPart::on_tool : value_of<int>(link, "link", "a whole number")};
}

/// @param own to which kinematics written in Python are added
std::unique_ptr<ArmKinematics> kinematics_of(nb::handle from, const ArmModel& model,
                                             const Trouble& trouble,
                                             std::vector<OwnKinematics*>& own) {
  nb::object kinematics = from.attr("kinematics");
  if (!kinematics.is_none()) {
    auto made = std::make_unique<OwnKinematics>(std::move(kinematics), model.links.size(), trouble);
    own.push_back(made.get());
    return made;
  }
  return std::make_unique<Kinematics>(model);
}

AdmittanceOptions admittance_of(nb::handle from) {
  AdmittanceOptions options;
  options.response = number(from, "response");
  if (const nb::object inertia = from.attr("inertia"); !inertia.is_none()) {
    options.inertia = numbers_of(inertia, "inertia");
  }
  options.scale = number(from, "scale");
  options.rest_time = number(from, "rest_time");
  options.acceleration = number(from, "acceleration");
  return options;
}

/// The network of an arm from the list of its modules, as Python has it.
network::Plan network_of(nb::handle list, const ArmModel& model) {
#ifdef REPEL_PYTHON_SCENES
  const nb::object text = nb::module_::import_("json").attr("dumps")(list, nb::arg("indent") = 1);
  return scene::plan_network(nb::cast<std::string>(text), model);
#else
  (void)list, (void)model;
  throw SetupError("networks of chosen modules need the part of scenes, which this build lacks");
#endif
}

ArmDescription arm_of(nb::handle from, const Trouble& trouble, std::vector<OwnKinematics*>& own) {
  ArmDescription arm;
  arm.model = arm_model_of(from);
  arm.name = arm.model.name;
  for (nb::handle part : from.attr("parts")) arm.parts.push_back(part_of(part));
  if (const nb::object start = from.attr("start"); !start.is_none()) {
    arm.start = numbers_of(start, "start");
  }
  read_law(from, "self_law", arm.self_law);
  arm.options.tool_speed = number(from, "tool_speed");
  arm.options.drive_delay = number(from, "drive_delay");
  arm.options.has_brakes = is_so(from, "has_brakes");
  for (nb::handle pair : from.attr("may_touch")) {
    arm.may_touch.push_back(
        value_of<std::pair<int, int>>(pair, "may_touch", "pairs of indices of parts"));
  }
  if (const nb::object network = from.attr("network"); !network.is_none()) {
    arm.network = network_of(network, arm.model);
  }
  arm.kinematics = kinematics_of(from, arm.model, trouble, own);
  return arm;
}

ObstacleDescription obstacle_of(nb::handle from) {
  ObstacleDescription obstacle{.name = text(from, "name"), .shape = shape_of(from)};
  obstacle.X_WP = optional_pose(from, "X_WP");
  read_law(from, "law", obstacle.law);
  const nb::object along = from.attr("along_W");
  if (!along.is_none()) {
    const double duration = number(from, "duration");
    obstacle.motion = ReciprocatingMotion{vector_of(along, "along_W"), duration};
  }
  return obstacle;
}

LooseDescription loose_of(nb::handle from) {
  LooseDescription loose{.name = text(from, "name"), .shape = shape_of(from)};
  loose.X_WP = optional_pose(from, "X_WP");
  read_law(from, "law", loose.law);
  loose.at_start = is_so(from, "at_start");
  loose.room = number(from, "room");
  loose.mass = number(from, "mass");
  loose.is_mass_known = is_so(from, "is_mass_known");
  loose.can_be_held = is_so(from, "can_be_held");
  return loose;
}

}  // namespace

ArmModel arm_model_of(nb::handle from) {
  require_kind(from, "arm", "Arm");
  ArmModel model;
  model.name = text(from, "name");
  model.X_WB = optional_pose(from, "X_WB");
  model.X_LT = optional_pose(from, "X_LT");
  model.gravity_W = vector_of(from.attr("gravity_W"), "gravity_W");
  for (nb::handle link : from.attr("links")) model.links.push_back(link_of(link));
  return model;
}

Capacities capacities_of(nb::handle from) {
  Capacities limits;
  if (from.is_none()) return limits;
  require_kind(from, "limits", "Capacities");
  const auto read = [&](const char* name, int& value, int most) {
    value = value_of<int>(from.attr(name), name, "a whole number");
    checked(name, value, 1.0, most, "");
  };
  read("bodies", limits.bodies, 1'000'000);
  read("loose", limits.loose, 1'000'000);
  read("parts", limits.parts, 10'000'000);
  read("pairs", limits.pairs, 100'000'000);
  read("candidates", limits.candidates, 1'000'000);
  return limits;
}

OwnDescription described(double rate_hz, nb::handle arms, nb::handle obstacles, nb::handle loose,
                         const Trouble& trouble) {
  OwnDescription own;
  own.cell.rate_hz = rate_hz;
  for (nb::handle arm : all_of(arms, "arms", "Arm")) {
    ArmDescription& made = own.cell.arms.emplace_back(arm_of(arm, trouble, own.kinematics));
    if (const nb::object admittance = arm.attr("admittance"); !admittance.is_none()) {
      const double period = 1.0 / checked("rate_hz", rate_hz, 1.0, 1e5, "Hz");
      try {
        made = admitted(std::move(made), admittance_of(admittance), period);
      } catch (const SetupError&) {
        raise(trouble);  // which is why
        throw;
      }
    }
  }
  for (nb::handle each : all_of(obstacles, "obstacles", "Obstacle")) {
    own.cell.obstacles.push_back(obstacle_of(each));
  }
  for (nb::handle each : all_of(loose, "loose", "Loose")) {
    own.cell.loose.push_back(loose_of(each));
  }
  return own;
}

}  // namespace repel::python
