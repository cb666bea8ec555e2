// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cover/cover.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <repel/base/setup_error.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "interpreter.hpp"

namespace repel::python {
namespace {

using cover::Cover;
using cover::CoverOptions;
using cover::Engine;

constexpr const char* engine_names[] = {"automatic", "planes", "coacd", "hacd", "hull"};

Engine engine_of(const std::string& name) {
  const auto* found = std::find(std::begin(engine_names), std::end(engine_names), name);
  if (found == std::end(engine_names)) {
    throw SetupError("engine is '" + name + "'; allowed: automatic, planes, coacd, hacd, hull");
  }
  return static_cast<Engine>(found - std::begin(engine_names));
}

TriangleMesh mesh_from(nb::handle vertices, nb::handle triangles) {
  TriangleMesh mesh;
  mesh.vertices = points_of(vertices, "vertices");
  constexpr const char* expected = "indices of vertices (M, 3)";
  const Array rows = array_of(triangles, "triangles", expected);
  if (rows.ndim() != 2 || rows.shape(1) != 3) refuse_shape(rows, "triangles", expected);
  const auto count = static_cast<double>(mesh.vertices.size());
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double index = rows.data()[3 * i + k];
      checked("triangles[" + std::to_string(i) + "]", index, 0.0, count - 1.0, "");
      corners[k] = static_cast<int>(index);
    }
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

Cover covered(nb::handle vertices, nb::handle triangles, int parts, double error, double overlap,
              const std::string& engine) {
  const TriangleMesh mesh = mesh_from(vertices, triangles);
  CoverOptions options;
  options.parts = parts;
  options.error = error;
  options.overlap = overlap;
  options.engine = engine_of(engine);
  const Released others_go_on;
  return cover::cover_of(mesh, options);
}

}  // namespace

void bind_covers(nb::module_& m) {
  nb::class_<Cover>(m, "Cover", "Convex parts of a mesh, and what is proven of them.")
      .def_prop_ro(
          "parts",
          [](const Cover& c) {
            nb::list parts;
            for (const auto& corners : c.parts) parts.append(to_array(corners));
            return parts;
          },
          nb::sig("def parts(self) -> list[numpy.ndarray]"),
          "[m] (N, 3) the corners of each, a convex hull: for Shape.hull.")
      .def_ro("uncovered_m", &Cover::uncovered_m,
              "[m] no point of the surface is farther from the parts.")
      .def_ro("excess_m", &Cover::excess_m, "[m] no point of a part is farther from the solid.")
      .def_ro("excess_reached_m", &Cover::excess_reached_m, "[m] a point of a part is this far.")
      .def_ro("seam_m", &Cover::seam_m,
              "[m] depth of the seams, found by search, not proven; None: there is none.")
      .def_ro("faults", &Cover::faults, "Of the mesh, a sentence for each.")
      .def_ro("is_closed", &Cover::is_closed, "The mesh is.")
      .def_ro("engine", &Cover::engine, "That divided it.");
  m.def("cover", &covered, nb::arg("vertices"), nb::arg("triangles"), nb::kw_only(),
        nb::arg("parts") = CoverOptions{}.parts, nb::arg("error") = CoverOptions{}.error,
        nb::arg("overlap") = CoverOptions{}.overlap, nb::arg("engine") = "automatic",
        nb::sig("def cover(vertices: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike, *, "
                "parts: int = 32, error: float = 0.002, overlap: float = 0.005, engine: str = "
                "'automatic') -> Cover"),
        "Covers a mesh, vertices [m] (N, 3) and triangles (M, 3), by at most `parts` convex parts "
        "that reach at most `error` [m] out of it and `overlap` [m] into their neighbours. Takes "
        "seconds to minutes. engine: automatic, planes, coacd, hacd or hull (docs/covers.md).");
}

}  // namespace repel::python
