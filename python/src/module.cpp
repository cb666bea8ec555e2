// SPDX-License-Identifier: BSD-3-Clause
#include <exception>

#include <repel/base/setup_error.hpp>

#include "bindings.hpp"

namespace {

/// repel.SetupError of Python, with the file and the line of the one of C++.
void translate(const std::exception_ptr& thrown, void* /*unused*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const repel::SetupError& error) {
    namespace nb = nanobind;
    const nb::object type = nb::module_::import_("repel._errors").attr("SetupError");
    const nb::object value = type(error.what(), error.file(), error.line());
    PyErr_SetObject(type.ptr(), value.ptr());
  }
}

}  // namespace

NB_MODULE(_repel, m) {
  using namespace repel::python;
  m.doc() = "The compiled part of repel.";
  nanobind::register_exception_translator(translate);
  bind_shapes(m);
  bind_separation(m);
  bind_world(m);
  bind_ticks(m);
  bind_kinematics(m);
  bind_cell(m);
  bind_loose(m);
  bind_pictures(m);
  bind_simulations(m);
#ifdef REPEL_PYTHON_ROBOTS
  bind_robots(m);
#endif
#ifdef REPEL_PYTHON_SCENES
  bind_scenes(m);
#endif
#ifdef REPEL_PYTHON_RUNS
  bind_runs(m);
#endif
#ifdef REPEL_PYTHON_RECORDINGS
  bind_recordings(m);
#endif
#ifdef REPEL_PYTHON_VIEWS
  bind_views(m);
#endif
#ifdef REPEL_PYTHON_CAMERAS
  bind_cameras(m);
#endif
#ifdef REPEL_PYTHON_COVERS
  bind_covers(m);
#endif
}
