// SPDX-License-Identifier: BSD-3-Clause
#include <repel/world/kinematics.hpp>

#include <cstddef>
#include <vector>

#include <nanobind/nanobind.h>

#include <repel/base/setup_error.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "description.hpp"

namespace repel::python {
namespace {

int checked_link(const Kinematics& arm, int link) {
  return static_cast<int>(checked("link", link, -1.0, arm.links() - 1.0, ""));
}

nb::object array_of_rows(const Jacobian& J) {
  const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> rows = J;
  return to_array(rows.data(), {6, static_cast<std::size_t>(J.cols())});
}

nb::object tool_jacobian(const Kinematics& arm) {
  Jacobian J(6, arm.links());
  arm.tool_jacobian(J);
  return array_of_rows(J);
}

nb::object jacobian(const Kinematics& arm, int link, nb::handle p_WQ) {
  Jacobian J(6, arm.links());
  arm.jacobian(checked_link(arm, link), vector_of(p_WQ, "p_WQ"), J);
  return array_of_rows(J);
}

nb::object gravity_torques(Kinematics& arm) {
  std::vector<double> torques(static_cast<std::size_t>(arm.links()));
  arm.gravity_torques(torques);
  return to_array(torques.data(), {torques.size()});
}

nb::object mass_matrix(const Kinematics& arm) {
  Eigen::MatrixXd M;
  (void)arm.mass_matrix(M);  // an arm of links has one
  const auto size = static_cast<std::size_t>(arm.links());
  return to_array(M.data(), {size, size});  // symmetric: rows are columns
}

}  // namespace

void bind_kinematics(nb::module_& m) {
  nb::class_<Kinematics>(m, "ArmKinematics",
                         "Kinematics, gravity and inertia of the links of an Arm, as a Cell "
                         "computes them. All answers belong to the last `update`; before it, the "
                         "joints are at zero. NaN in, NaN out. It is a repel.Kinematics.")
      .def(
          "__init__",
          [](Kinematics* self, nb::handle arm) { new (self) Kinematics(arm_model_of(arm)); },
          nb::arg("arm"), nb::sig("def __init__(self, arm: repel.Arm) -> None"),
          "Of the arm as it is now. Raises SetupError for a link that cannot be used.")
      .def(
          "update",
          [](Kinematics& arm, nb::handle q) {
            arm.update(numbers_of(q, "q", static_cast<std::size_t>(arm.links())));
          },
          nb::arg("q"), nb::sig("def update(self, q: numpy.typing.ArrayLike) -> None"),
          "Joint positions (joints,) [rad] or [m].")
      .def(
          "X_WT", [](const Kinematics& arm) { return to_array(arm.X_WT()); },
          nb::sig("def X_WT(self) -> numpy.ndarray"), "[m] (4, 4) the tool frame.")
      .def(
          "X_WL",
          [](const Kinematics& arm, int link) {
            return to_array(arm.X_WL(checked_link(arm, link)));
          },
          nb::arg("link"), nb::sig("def X_WL(self, link: int) -> numpy.ndarray"),
          "[m] (4, 4) the frame of a link, by its index; -1: of the base.")
      .def("tool_jacobian", &tool_jacobian, nb::sig("def tool_jacobian(self) -> numpy.ndarray"),
           "(6, joints) of the origin of the tool frame: linear rows first, world axes.")
      .def("jacobian", &jacobian, nb::arg("link"), nb::arg("p_WQ"),
           nb::sig("def jacobian(self, link: int, p_WQ: numpy.typing.ArrayLike) -> numpy.ndarray"),
           "(6, joints) of the point of a link that is now at p_WQ (3,) [m].")
      .def("gravity_torques", &gravity_torques,
           nb::sig("def gravity_torques(self) -> numpy.ndarray"),
           "(joints,) [N m] or [N] that hold the arm against gravity.")
      .def("mass_matrix", &mass_matrix, nb::sig("def mass_matrix(self) -> numpy.ndarray"),
           "(joints, joints) [kg m^2] or [kg], rotors included.")
      .def_prop_ro("joints", &Kinematics::links, "How many there are.");
}

}  // namespace repel::python
