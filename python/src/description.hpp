// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The description of a cell from the plain classes of Python (repel/description.py).
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>

#include <repel/cell/description.hpp>

#include "own_kinematics.hpp"

namespace repel::python {

/// A description, and what of Python it refers to.
struct OwnDescription {
  CellDescription cell;
  std::vector<OwnKinematics*> kinematics;  ///< those of the arms that are written in Python
};

/// The members of a repel.Link that are one number.
inline constexpr std::pair<const char*, double ArmLink::*> link_numbers[] = {
    {"lower", &ArmLink::lower},
    {"upper", &ArmLink::upper},
    {"velocity_limit", &ArmLink::velocity_limit},
    {"effort_limit", &ArmLink::effort_limit},
    {"mass", &ArmLink::mass},
    {"viscous_friction", &ArmLink::viscous_friction},
    {"coulomb_friction", &ArmLink::coulomb_friction},
    {"rotor_inertia", &ArmLink::rotor_inertia},
    {"brake_torque", &ArmLink::brake_torque}};

/// The links of a repel.Arm, its base, its tool frame and its gravity.
/// @throws SetupError or the errors of Python, naming what is wrong
[[nodiscard]] ArmModel arm_model_of(nb::handle from);

/// Those of a repel.Capacities; none: as many as C++ has. @throws SetupError
[[nodiscard]] Capacities capacities_of(nb::handle from);

/// @param arms,obstacles,loose sequences of repel.Arm, repel.Obstacle and repel.Loose
/// @param trouble to which the kinematics report
/// @throws SetupError or the errors of Python, naming what is wrong
[[nodiscard]] OwnDescription described(double rate_hz, nb::handle arms, nb::handle obstacles,
                                       nb::handle loose, const Trouble& trouble);

}  // namespace repel::python
