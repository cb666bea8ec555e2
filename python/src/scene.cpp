// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/setup_error.hpp>
#include <repel/scene/scene.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <repel/ideal/arm.hpp>
#include <repel/network/operator.hpp>
#include <repel/robots/dynamics.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/scene/build_network.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "own_cell.hpp"

namespace repel::python {
namespace {

using network::Phase;
using network::ScriptedOperator;
using scene::Scene;

template <class Part>
nb::dict dict_of(const Part& part, const char* frame, const Pose& X) {
  nb::dict each;
  each["name"] = part.name;
  each["shape"] = part.shape;
  each["kind"] = part.kind;
  each[frame] = to_array(X);
  return each;
}

nb::list obstacles_of(const Scene& scene) {
  nb::list all;
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    nb::dict each = dict_of(obstacle, "X_WP", obstacle.X_WP);
    each["law"] = obstacle.law;
    each["moves"] = obstacle.motion.has_value();
    all.append(each);
  }
  return all;
}

nb::list tool_of(const Scene& scene) {
  nb::list all;
  for (const scene::Part& part : scene.tool) all.append(dict_of(part, "X_BP", part.X_BP));
  return all;
}

nb::list script_of(const Scene& scene) {
  nb::list all;
  for (const Phase& phase : scene.script) all.append(nb::make_tuple(phase.name, phase.duration));
  return all;
}

nb::list arms_of(const Scene& scene) {
  nb::list all;
  all.append("");
  for (const scene::OtherArm& arm : scene.partners) all.append(arm.name);
  return all;
}

/// A simulated arm in place of a real one.
class SimulatedArm {
 public:
  SimulatedArm(OwnCell& cell, int arm, const std::string& kind) {
    const ArmDescription& description = cell.cell().description().arms[cell.checked_arm(arm)];
    joints_ = description.model.links.size();
    if (kind == "reference") {
      auto made = std::make_unique<ReferenceArm>(description.model);
      made->reset(description.start);
      arm_ = std::move(made);
    } else if (kind == "ideal") {
      arm_ = ideal(description);
    } else {
      throw SetupError("kind is '" + kind + "'; allowed: reference, ideal");
    }
  }

  [[nodiscard]] nb::object read(void (TorqueDrivenArm::*what)(std::span<double>)
                                    const noexcept) const {
    const InUse in_use(is_in_use_);
    std::vector<double> numbers(joints_);
    ((*arm_).*what)(numbers);
    return to_array(numbers.data(), {joints_});
  }

  void apply(const Tick& tick) {
    const InUse in_use(is_in_use_);
    if (tick.record.enable) arm_->enable();
    arm_->set_torques(std::span(tick.record.torques).first(joints_));
    arm_->engage_brakes(tick.record.brakes);
  }

  void step(double period) {
    checked("period", period, 1e-9, 10.0, "s");
    const InUse in_use(is_in_use_);
    const Released others_go_on;
    arm_->step(period);
  }

 private:
  static std::unique_ptr<TorqueDrivenArm> ideal(const ArmDescription& description) {
    std::vector<IdealJoint> joints;
    for (const ArmLink& link : description.model.links) {
      joints.push_back({.inertia = std::max(0.1, link.rotor_inertia),
                        .viscous_friction = std::max(1.0, link.viscous_friction)});
    }
    auto made = std::make_unique<IdealArm>(joints);
    made->reset(description.start);
    return made;
  }

  std::unique_ptr<TorqueDrivenArm> arm_;
  std::size_t joints_ = 0;
  mutable bool is_in_use_ = false;
};

/// Of a file, or of a scene in the package.
std::string path_of(nb::handle scene) {
  return nb::cast<std::string>(nb::module_::import_("repel._scenes").attr("path_of")(scene));
}

/// The cell as `teleop --fast` builds it, but for its threads: with them the bits are the same.
std::unique_ptr<OwnCell> cell_of(nb::handle from, std::optional<double> rate_hz, bool gravity) {
  Scene scene = nb::isinstance<Scene>(from) ? nb::cast<Scene>(from) : scene::load(path_of(from));
  if (!gravity) {  // nothing there has a weight
    scene.robot.payload = {};
    for (scene::OtherArm& partner : scene.partners) partner.robot.payload = {};
  }
  try {
    OwnDescription description;
    description.cell = runs::describe(scene, rate_hz.value_or(scene.rate_hz), gravity).cell;
    Budget& budget = description.cell.coprocessor.budget;
    budget.work_units = scene.budget.work_units;
    budget.max_age = scene.budget.max_age;
    return std::make_unique<OwnCell>(std::move(description),
                                     std::make_shared<std::optional<nb::python_error>>());
  } catch (const SetupError& error) {
    throw scene::located(scene, error);
  }
}

void bind_operator(nb::module_& m) {
  nb::class_<ScriptedOperator>(m, "ScriptedOperator",
                               "Plays the script of a scene, phase after phase.")
      .def(
          "step",
          [](ScriptedOperator& self, nb::handle X_WT, double period) -> network::Command {
            return self.step(rotation(pose_of(X_WT, "X_WT")), period);
          },
          nb::arg("X_WT"), nb::arg("period"),
          "The command of the next `period` [s], for a tool at X_WT (4, 4).")
      .def_prop_ro("over", &ScriptedOperator::over)
      .def_prop_ro("phase", &ScriptedOperator::phase, "Index of the phase being played.");
}

void bind_simulated_arm(nb::module_& m) {
  nb::class_<SimulatedArm>(m, "SimulatedArm", "A simulated arm in place of a real one.")
      .def(
          nb::init<OwnCell&, int, const std::string&>(), nb::arg("cell"), nb::arg("arm") = 0,
          nb::kw_only(), nb::arg("kind") = "reference",
          "The arm of a cell, at its start. kind: reference (rigid links, gravity, friction; no "
          "joint stops) or ideal (free joints without weight, for Cell.from_scene(gravity=False)).")
      .def_prop_ro(
          "q", [](const SimulatedArm& arm) { return arm.read(&TorqueDrivenArm::read_positions); },
          nb::sig("def q(self) -> numpy.ndarray"), "[rad] or [m] (joints,)")
      .def_prop_ro(
          "v", [](const SimulatedArm& arm) { return arm.read(&TorqueDrivenArm::read_velocities); },
          nb::sig("def v(self) -> numpy.ndarray"), "[rad/s] or [m/s] (joints,)")
      .def("apply", &SimulatedArm::apply, nb::arg("tick"),
           "Torques and brakes of a tick, held until the next.")
      .def("step", &SimulatedArm::step, nb::arg("period"), "Moves the arm by a time [s].");
}

}  // namespace

void bind_scenes(nb::module_& m) {
  nb::class_<Scene>(m, "Scene", "A scene file that has been read and checked.")
      .def_ro("name", &Scene::name)
      .def_ro("file", &Scene::file)
      .def_ro("rate_hz", &Scene::rate_hz, "[Hz] of the tick.")
      .def_ro("tool_speed", &Scene::tool_speed, "[m/s] speed limit of a tool.")
      .def_prop_ro("measure", [](const Scene& s) { return to_text(s.measure); })
      .def_prop_ro(
          "robot", [](const Scene& s) { return s.robot.urdf; }, "Path of the URDF file.")
      .def_prop_ro("arms", &arms_of, nb::sig("def arms(self) -> list[str]"),
                   "The names of the arms; that of the first is empty.")
      .def_prop_ro("tool", &tool_of, nb::sig("def tool(self) -> list[dict[str, typing.Any]]"),
                   "Parts of the first tool: dicts with name, shape, kind and X_BP [m] (4, 4).")
      .def_prop_ro("obstacles", &obstacles_of,
                   nb::sig("def obstacles(self) -> list[dict[str, typing.Any]]"),
                   "Dicts with name, shape, kind, X_WP [m] (4, 4), law and moves.")
      .def_prop_ro("script", &script_of, nb::sig("def script(self) -> list[tuple[str, float]]"),
                   "(name, duration [s]) of each phase of the first operator.")
      .def(
          "operator",
          [](const Scene& s, int arm) {
            checked("arm", arm, 0.0, static_cast<double>(s.partners.size()), "");
            return ScriptedOperator(s.arm_setup(static_cast<std::size_t>(arm)).script);
          },
          nb::arg("arm") = 0, "A scripted operator at the beginning of the script.")
      .def("__repr__", [](const Scene& s) { return "<repel.Scene " + s.name + ">"; });
  m.def(
      "load_scene", [](nb::handle path) { return scene::load(path_of(path)); }, nb::arg("path"),
      nb::sig("def load_scene(path: str | os.PathLike[str]) -> Scene"),
      "Reads a scene: a file (scenes/README.md), or the name of one in the package. Raises "
      "SetupError naming file, line and value.");
  nb::borrow<nb::class_<OwnCell>>(nb::type<OwnCell>())
      .def_static("from_scene", &cell_of, nb::arg("scene"), nb::arg("rate_hz") = nb::none(),
                  nb::kw_only(), nb::arg("gravity") = true,
                  nb::sig("def from_scene(scene: Scene | str | os.PathLike[str], rate_hz: float | "
                          "None = None, *, gravity: bool = True) -> Cell"),
                  "The cell of a scene: its arms, obstacles and networks. rate_hz [Hz]; none: that "
                  "of the scene. gravity: false for arms without weight. Cameras see nothing. "
                  "Parts that come and go are those of `loose`. Of the budget of the scene what is "
                  "counted applies, not the time.");
  bind_operator(m);
  bind_simulated_arm(m);
}

}  // namespace repel::python
