// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/separation.hpp>
#include <repel/schedule/separations.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>

#include <repel/base/setup_error.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "interpreter.hpp"

namespace repel::python {

Measure measure_of(const std::string& name) {
  if (const auto measure = measure_named(name)) return *measure;
  std::string allowed;
  for (const Measure measure : all_measures) {
    allowed += (allowed.empty() ? "" : ", ") + to_text(measure);
  }
  throw SetupError("measure is '" + name + "'; allowed: " + allowed);
}

namespace {

constexpr std::array<const char*, 5> end_names{"bad_input", "converged", "touching", "far_apart",
                                               "budget_spent"};

/// One row of the array that `separations` returns, as NumPy lays it out.
struct Row {
  double distance, lower, upper;
  std::array<double, 3> p_WA, p_WB, extraction_W;
  std::int32_t level, iterations;
  std::uint8_t end;
};
static_assert(sizeof(Row) == 112);

std::array<double, 3> to_row(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Row row_of(const Separation& s) {
  return {s.distance,     s.lower,        s.upper,
          to_row(s.p_WA), to_row(s.p_WB), to_row(s.extraction_W),
          s.level,        s.iterations,   static_cast<std::uint8_t>(s.end)};
}

/// The warm starts of many pairs, by their row.
struct WarmStarts {
  std::vector<WarmStart> rows;
};

// With the code for the instruction set in use.
Separation ask(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB,
               const QueryOptions& options, WarmStart& warm) noexcept {
  const PosedShapes pair{{a, X_WA}, {b, X_WB}};
  Separation found;
  separations({&pair, 1}, options, {&warm, 1}, {&found, 1});
  return found;
}

Separation ask_one(const Shape& a, nb::handle X_WA, const Shape& b, nb::handle X_WB,
                   const QueryOptions& options, WarmStart* warm) {
  const Pose of_a = pose_of(X_WA, "X_WA");
  const Pose of_b = pose_of(X_WB, "X_WB");
  WarmStart cold;
  Separation s = ask(a, of_a, b, of_b, options, warm != nullptr ? *warm : cold);
  if (s.end == QueryEnd::bad_input) {
    throw SetupError("X_WA, X_WB: the poses are beyond 1e15 m, where distances lose their meaning");
  }
  return s;
}

using Pairs = nb::ndarray<const std::int64_t, nb::numpy, nb::shape<-1, 2>, nb::c_contig>;
using Bytes = nb::ndarray<std::uint8_t, nb::numpy, nb::ndim<1>, nb::c_contig>;

std::vector<const Shape*> shapes_of(const nb::list& list) {
  std::vector<const Shape*> shapes;
  shapes.reserve(list.size());
  for (nb::handle each : list) {
    const Shape* shape = nullptr;
    if (!nb::try_cast(each, shape) || shape == nullptr) {
      refuse_type(each, "shapes[" + std::to_string(shapes.size()) + "]", "a Shape");
    }
    shapes.push_back(shape);
  }
  return shapes;
}

/// A copy, checked: the array may change meanwhile, by another thread or by the rows written.
std::vector<std::int64_t> indices_of(const Pairs& pairs, std::size_t shapes) {
  std::vector<std::int64_t> indices(pairs.data(), pairs.data() + pairs.size());
  const auto count = static_cast<std::int64_t>(shapes);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::int64_t index = indices[i];
    if (index >= 0 && index < count) continue;
    throw nb::index_error(
        ("pairs[" + std::to_string(i / 2) + "] names shape " + std::to_string(index) +
         "; allowed: " + (count > 0 ? "0 to " + std::to_string(count - 1) : "none, of no shapes"))
            .c_str());
  }
  return indices;
}

/// @param times that all shapes are placed: X_W has the poses of one after the other; none: once
void ask_many(const nb::list& list, nb::handle X_W, std::optional<std::size_t> times,
              const Pairs& pairs, const QueryOptions& options, WarmStarts* warm, const Bytes& out) {
  const std::vector<const Shape*> shapes = shapes_of(list);
  const std::vector<Pose> poses = poses_of(X_W, "X_W", times ? shapes.size() : 0);
  const std::size_t batches = times.value_or(1);
  if (poses.size() != batches * shapes.size()) {
    throw nb::value_error(("X_W: expected a pose for each of " + std::to_string(shapes.size()) +
                           " shapes, got " + std::to_string(poses.size() / batches))
                              .c_str());
  }
  const std::vector<std::int64_t> indices = indices_of(pairs, shapes.size());
  const std::size_t count = batches * pairs.shape(0);
  if (warm != nullptr && warm->rows.size() != count) {
    throw nb::value_error(("warm: expected " + std::to_string(count) +
                           " rows, one for each pair, got " + std::to_string(warm->rows.size()))
                              .c_str());
  }
  if (out.size() != count * sizeof(Row)) {
    throw nb::value_error(("out: expected " + std::to_string(count) + " rows").c_str());
  }
  auto* row = reinterpret_cast<Row*>(out.data());
  WarmStart* kept = warm != nullptr ? warm->rows.data() : nullptr;
  const Released others_go_on;
  for (std::size_t batch = 0; batch < batches; ++batch) {
    const Pose* X = poses.data() + batch * shapes.size();
    for (std::size_t i = 0; i < indices.size(); i += 2) {
      WarmStart cold;
      const auto a = static_cast<std::size_t>(indices[i]);
      const auto b = static_cast<std::size_t>(indices[i + 1]);
      *row++ = row_of(
          ask(*shapes[a], X[a], *shapes[b], X[b], options, kept != nullptr ? *kept++ : cold));
    }
  }
}

void bind_results(nb::module_& m) {
  nb::class_<Separation>(m, "Separation",
                         "The signed distance of two shapes, never more than was proven.")
      .def_ro("distance", &Separation::distance, "[m] above 0 the gap, below 0 minus the depth.")
      .def_ro("lower", &Separation::lower, "[m] proven lower bound.")
      .def_ro("upper", &Separation::upper, "[m] proven upper bound.")
      .def_prop_ro(
          "bracket", [](const Separation& s) { return nb::make_tuple(s.lower, s.upper); },
          nb::sig("def bracket(self) -> tuple[float, float]"), "[m] (lower, upper).")
      .def_prop_ro(
          "p_WA", [](const Separation& s) { return to_array(s.p_WA); },
          nb::sig("def p_WA(self) -> numpy.ndarray"), "[m] (3,) witness point on A.")
      .def_prop_ro(
          "p_WB", [](const Separation& s) { return to_array(s.p_WB); },
          nb::sig("def p_WB(self) -> numpy.ndarray"), "[m] (3,) witness point on B.")
      .def_prop_ro(
          "extraction_W", [](const Separation& s) { return to_array(s.extraction_W); },
          nb::sig("def extraction_W(self) -> numpy.ndarray"),
          "(3,) unit normal: moving A along it separates A from B.")
      .def_ro("level", &Separation::level,
              "0: the shapes themselves; k: k-th step of the reduction.")
      .def_ro("iterations", &Separation::iterations, "Support-map pairs evaluated.")
      .def_prop_ro(
          "end", [](const Separation& s) { return end_names[static_cast<std::size_t>(s.end)]; },
          nb::sig("def end(self) -> str"),
          "Why the query stopped: converged, touching, far_apart or budget_spent.")
      .def("__repr__", [](const Separation& s) {
        return "<repel.Separation, distance " + to_text(s.distance) + " m in [" + to_text(s.lower) +
               ", " + to_text(s.upper) + "]>";
      });
  nb::class_<WarmStart>(m, "WarmStart",
                        "What a query leaves for the next one on the same pair. Any content is "
                        "safe; good content saves time.")
      .def(nb::init<>());
  nb::class_<WarmStarts>(m, "WarmStarts", "The warm starts of many pairs, one for each row.")
      .def(
          "__init__",
          [](WarmStarts* warm, int count) {
            checked("count", count, 0.0, 1e8, "");
            new (warm) WarmStarts{std::vector<WarmStart>(static_cast<std::size_t>(count))};
          },
          nb::arg("count"))
      .def("__len__", [](const WarmStarts& warm) { return warm.rows.size(); });
}

void bind_options(nb::module_& m) {
  static constexpr QueryOptions usual;
  nb::class_<QueryOptions>(m, "QueryOptions", "How a query is answered. Immutable.")
      .def(
          "__init__",
          [](QueryOptions* options, const std::string& measure, double ignore_beyond,
             double relative_width, double tolerance, int iterations) {
            constexpr double most = std::numeric_limits<double>::infinity();
            checked("tolerance", tolerance, 0.0, most, "");
            checked("iterations", iterations, 1.0, std::numeric_limits<int>::max(), "");
            checked("ignore_beyond", ignore_beyond, 0.0, most, "m");
            checked("relative_width", relative_width, 0.0, most, "");
            new (options) QueryOptions{.tolerance = tolerance,
                                       .iterations = iterations,
                                       .ignore_beyond = ignore_beyond,
                                       .relative_width = relative_width,
                                       .measure = measure_of(measure)};
          },
          nb::kw_only(), nb::arg("measure") = "deepest_point",
          nb::arg("ignore_beyond") = usual.ignore_beyond,
          nb::arg("relative_width") = usual.relative_width, nb::arg("tolerance") = usual.tolerance,
          nb::arg("iterations") = usual.iterations,
          "measure of an overlap: deepest_point, reduction or exact (docs/reduction.md). "
          "ignore_beyond [m]: a gap proven to be larger need not be known. relative_width: a "
          "bracket wider than this share of the distance is decided in extended precision. "
          "tolerance: largest relative duality gap. iterations: limit of support-map pairs.")
      .def_prop_ro("measure", [](const QueryOptions& o) { return to_text(o.measure); })
      .def_ro("ignore_beyond", &QueryOptions::ignore_beyond, "[m]")
      .def_ro("relative_width", &QueryOptions::relative_width)
      .def_ro("tolerance", &QueryOptions::tolerance)
      .def_ro("iterations", &QueryOptions::iterations);
}

}  // namespace

void bind_separation(nb::module_& m) {
  bind_options(m);
  bind_results(m);
  nb::list ends;
  for (const char* name : end_names) ends.append(name);
  m.attr("QUERY_ENDS") = nb::tuple(ends);
  m.def("separation", &ask_one, nb::arg("a"), nb::arg("X_WA").none(), nb::arg("b"),
        nb::arg("X_WB").none(), nb::kw_only(), nb::arg("options") = QueryOptions{},
        nb::arg("warm") = nb::none(),
        nb::sig("def separation(a: Shape, X_WA: numpy.typing.ArrayLike | tuple[numpy.typing."
                "ArrayLike, numpy.typing.ArrayLike], b: Shape, X_WB: numpy.typing.ArrayLike | "
                "tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike], *, options: QueryOptions = "
                "..., warm: WarmStart | None = None) -> Separation"),
        "The signed distance of shape `a` at pose X_WA and shape `b` at X_WB.\n\n"
        "A pose [m] is a rigid 4x4 matrix, or (position (3,), unit quaternion w x y z (4,)).\n"
        "Raises SetupError for a pose that is not finite or not rigid.");
  m.def("_fill_separations", &ask_many, nb::arg("shapes"), nb::arg("X_W").none(),
        nb::arg("times").none(), nb::arg("pairs"), nb::arg("options"), nb::arg("warm").none(),
        nb::arg("out"),
        nb::sig("def _fill_separations(shapes: list[Shape], X_W: object, times: int | None, pairs: "
                "numpy.ndarray, options: QueryOptions, warm: WarmStarts | None, out: "
                "numpy.ndarray) -> None"));
}

}  // namespace repel::python
