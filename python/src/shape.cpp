// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include <repel/base/setup_error.hpp>
#include <repel/force/law.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/reduction/shape_mesh.hpp>

#include "arrays.hpp"
#include "bindings.hpp"

namespace repel::python {
namespace {

constexpr int usual_levels = ReductionOptions{}.levels;

ReductionOptions reduction(int levels) {
  return {.levels = levels};
}

nb::tuple mesh(const Shape& shape, int level) {
  checked("level", level, 0, shape.levels() - 1, "");
  const TriangleMesh mesh = mesh_of(shape, level);
  nb::list triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.append(nb::make_tuple(a, b, c));
  const nb::module_ numpy = nb::module_::import_("numpy");
  const nb::object rows = numpy.attr("array")(triangles, nb::arg("dtype") = "int32");
  return nb::make_tuple(to_array(mesh.vertices), rows.attr("reshape")(-1, 3));
}

void bind_shape(nb::module_& m) {
  nb::class_<Shape>(m, "Shape",
                    "A convex shape around the origin of its own frame. Immutable. Sizes are in "
                    "metres, 0 to 1e6.\n\n`levels`, 1 to 64: the steps of `measure=\"reduction\"`.")
      .def_static(
          "box",
          [](nb::handle half_extents, int levels) {
            return Shape::box(vector_of(half_extents, "half_extents"), reduction(levels));
          },
          nb::arg("half_extents"), nb::kw_only(), nb::arg("levels") = usual_levels,
          nb::sig("def box(half_extents: numpy.typing.ArrayLike, *, levels: int = 8) -> Shape"),
          "A box with faces at +-half_extents [m] (3,); with zeros a rectangle, a segment or a "
          "point.")
      .def_static(
          "sphere",
          [](double radius, int levels) { return Shape::sphere(radius, reduction(levels)); },
          nb::arg("radius"), nb::kw_only(), nb::arg("levels") = usual_levels,
          "A sphere of `radius` [m]. Exact.")
      .def_static(
          "capsule",
          [](double radius, double half_length, int levels) {
            return Shape::capsule(radius, half_length, reduction(levels));
          },
          nb::arg("radius"), nb::arg("half_length"), nb::kw_only(),
          nb::arg("levels") = usual_levels,
          "All points within `radius` [m] of the segment between +-half_length [m] on the z axis. "
          "Exact.")
      .def_static(
          "cylinder",
          [](double radius, double half_length, int levels) {
            return Shape::cylinder(radius, half_length, reduction(levels));
          },
          nb::arg("radius"), nb::arg("half_length"), nb::kw_only(),
          nb::arg("levels") = usual_levels,
          "A cylinder around the z axis, flat ends at +-half_length [m]. The rim is a circle.")
      .def_static(
          "cone",
          [](double radius, double half_length, int levels) {
            return Shape::cone(radius, half_length, reduction(levels));
          },
          nb::arg("radius"), nb::arg("half_length"), nb::kw_only(),
          nb::arg("levels") = usual_levels,
          "A disc of `radius` [m] at -half_length [m] on the z axis and the apex at +half_length.")
      .def_static(
          "ellipsoid",
          [](nb::handle radii, int levels) {
            return Shape::ellipsoid(vector_of(radii, "radii"), reduction(levels));
          },
          nb::arg("radii"), nb::kw_only(), nb::arg("levels") = usual_levels,
          nb::sig("def ellipsoid(radii: numpy.typing.ArrayLike, *, levels: int = 8) -> Shape"),
          "An ellipsoid with semi-axes `radii` [m] (3,) along x, y and z, each 1e-6 to 1e6 and the "
          "largest at most 1e4 times the least. The surface is exact.")
      .def_static(
          "hull",
          [](nb::handle points, int levels) {
            return Shape::hull(points_of(points, "points"), reduction(levels));
          },
          nb::arg("points"), nb::kw_only(), nb::arg("levels") = usual_levels,
          nb::sig("def hull(points: numpy.typing.ArrayLike, *, levels: int = 8) -> Shape"),
          "The convex hull of 1 to 10 000 points [m] (N, 3); they may coincide or lie in a plane.")
      .def_prop_ro("reach", &Shape::reach, "[m] of the farthest point from the origin.")
      .def_prop_ro("inscribed_radius", &Shape::inscribed_radius,
                   "[m] how deep a point of the shape can be below its surface.")
      .def_prop_ro("levels", &Shape::levels, "The steps in which the shape is reduced.")
      .def_prop_ro("bytes", &Shape::bytes, "[byte] Memory held, shared by all copies.")
      .def("mesh", &mesh, nb::arg("level") = 0,
           nb::sig("def mesh(self, level: int = 0) -> tuple[numpy.ndarray, numpy.ndarray]"),
           "A closed surface for displays: vertices [m] (N, 3) and triangles (M, 3). Polytopes "
           "exactly, curved shapes by chords.")
      .def("__repr__", [](const Shape& shape) {
        return "<repel.Shape, reach " + to_text(shape.reach(), 4) + " m>";
      });
}

GivenAt given_at_of(const std::string& name) {
  if (name == "part") return GivenAt::part;
  if (name == "tool") return GivenAt::tool;
  throw SetupError("given_at is '" + name + "'; allowed: part, tool");
}

ForceLaw law_of(double range, double surface_force, double damping, double ceiling, bool passable,
                const std::string& given_at, double depth, double plateau, double tilt, bool hard,
                double watched) {
  return checked(ForceLaw{.range = range,
                          .surface_force = surface_force,
                          .damping = damping,
                          .ceiling = ceiling,
                          .passable = passable,
                          .given_at = given_at_of(given_at),
                          .depth = depth,
                          .plateau = plateau,
                          .tilt = tilt,
                          .hold = hard ? HoldKind::hard : HoldKind::soft,
                          .watched = watched});
}

void bind_law(nb::module_& m) {
  static constexpr ForceLaw usual;
  nb::class_<ForceLaw>(m, "ForceLaw",
                       "The spring-damper of a pair. Immutable. Numbers out of range are refused.")
      .def(
          "__init__",
          [](ForceLaw* law, double range, double surface_force, double damping, double ceiling,
             bool passable, double depth, double plateau, double tilt, bool hard, double watched,
             const std::string& given_at) {
            new (law) ForceLaw(law_of(range, surface_force, damping, ceiling, passable, given_at,
                                      depth, plateau, tilt, hard, watched));
          },
          nb::kw_only(), nb::arg("range") = usual.range,
          nb::arg("surface_force") = usual.surface_force, nb::arg("damping") = usual.damping,
          nb::arg("ceiling") = usual.ceiling, nb::arg("passable") = usual.passable,
          nb::arg("depth") = usual.depth, nb::arg("plateau") = usual.plateau,
          nb::arg("tilt") = usual.tilt, nb::arg("hard") = false, nb::arg("watched") = usual.watched,
          nb::arg("given_at") = "part",
          "range [m]: where the force begins. surface_force [N]: at distance 0. damping [N s/m]. "
          "ceiling [N]. passable: it may be entered; then depth [m] and plateau (0 to 1) count. "
          "tilt [rad], 0 to 0.05: features parallel within it meet in a patch. hard: who pushes "
          "harder does not go deeper. watched [m]: beyond the range, for hard walls. given_at: "
          "part, "
          "or tool: a cell scales it by the leverage of the tool over the part.")
      .def_ro("range", &ForceLaw::range, "[m]")
      .def_ro("surface_force", &ForceLaw::surface_force, "[N]")
      .def_ro("damping", &ForceLaw::damping, "[N s/m]")
      .def_ro("ceiling", &ForceLaw::ceiling, "[N]")
      .def_ro("passable", &ForceLaw::passable)
      .def_ro("depth", &ForceLaw::depth, "[m]")
      .def_ro("plateau", &ForceLaw::plateau)
      .def_ro("tilt", &ForceLaw::tilt, "[rad]")
      .def_prop_ro("hard", [](const ForceLaw& law) { return law.hold == HoldKind::hard; })
      .def_ro("watched", &ForceLaw::watched, "[m]")
      .def_prop_ro(
          "given_at",
          [](const ForceLaw& law) { return law.given_at == GivenAt::part ? "part" : "tool"; })
      .def_prop_ro("stiffness", &ForceLaw::stiffness, "[N/m] largest slope of the spring.")
      .def("__call__", &ForceLaw::operator(), nb::arg("distance"), nb::arg("rate") = 0.0,
           "The force [N] at a signed distance [m] that changes at a rate [m/s].")
      .def("__repr__", [](const ForceLaw& law) {
        return "<repel.ForceLaw, range " + to_text(law.range) + " m, surface force " +
               to_text(law.surface_force) + " N, damping " + to_text(law.damping) + " N s/m>";
      });
}

}  // namespace

void bind_shapes(nb::module_& m) {
  bind_shape(m);
  bind_law(m);
}

}  // namespace repel::python
