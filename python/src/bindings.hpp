// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of the module, each defined by a file of its own.
#pragma once

#include <cstdint>
#include <string>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <repel/base/status.hpp>
#include <repel/distance/query.hpp>
#include <repel/reduction/separation_result.hpp>

namespace repel::python {

namespace nb = nanobind;

void bind_shapes(nb::module_& m);
void bind_separation(nb::module_& m);
void bind_world(nb::module_& m);
void bind_ticks(nb::module_& m);
void bind_kinematics(nb::module_& m);
void bind_cell(nb::module_& m);
void bind_loose(nb::module_& m);
void bind_pictures(nb::module_& m);
void bind_simulations(nb::module_& m);
void bind_views(nb::module_& m);
void bind_cameras(nb::module_& m);
void bind_robots(nb::module_& m);
void bind_scenes(nb::module_& m);
void bind_runs(nb::module_& m);
void bind_recordings(nb::module_& m);
void bind_covers(nb::module_& m);

/// The measure of that name. @throws SetupError naming those there are
[[nodiscard]] Measure measure_of(const std::string& name);
/// The names of the bits that are set, a tuple.
[[nodiscard]] nb::tuple names_of(Status bits);

}  // namespace repel::python
