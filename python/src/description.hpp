// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The description of a cell from the plain classes of Python (repel/description.py).
#pragma once

#include <memory>
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

/// Those of a repel.Capacities; none: as many as C++ has. @throws SetupError
[[nodiscard]] Capacities capacities_of(nb::handle from);

/// @param arms,obstacles sequences of repel.Arm and repel.Obstacle
/// @param trouble to which the kinematics report
/// @throws SetupError or the errors of Python, naming what is wrong
[[nodiscard]] OwnDescription described(double rate_hz, nb::handle arms, nb::handle obstacles,
                                       const Trouble& trouble);

}  // namespace repel::python
