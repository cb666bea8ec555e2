// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <repel/base/rotation.hpp>
#include <repel/base/setup_error.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "own_cell.hpp"

namespace repel::python {
namespace {

/// Loose parts that are where the arrays of a simulation have them.
class Followed {
 public:
  /// @param positions (N, 3) [m] and rotations (N, 9), which the simulation writes @param rows of
  /// these, one for each of `parts`, names of loose parts
  Followed(OwnCell& cell, Array positions, Array rotations, const std::vector<std::size_t>& rows,
           const std::vector<std::string>& parts)
      : cell_(&cell), positions_(std::move(positions)), rotations_(std::move(rotations)) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const PartId part = cell.loose(parts[i]);
      all_.push_back({part, cell.cell().world().part(part).body, rows.at(i), pose(rows[i])});
    }
  }

  /// Places the parts, with the velocities by which they have come here since the last call.
  /// @param time [s] of the simulation; before the last call: they are at rest
  void update(double time) {
    const InUse in_use = cell_->use();
    World& world = cell_->cell().world();
    const double dt = time - time_;
    time_ = time;
    for (Each& each : all_) {
      const Pose X = pose(each.row);
      if (!world.place(each.body, X, twist(each.X_WP, X, dt))) {
        throw SetupError("'" + world.part(each.part).name +
                         "' has a pose that is not finite, or not rigid");
      }
      each.X_WP = X;
    }
  }

  [[nodiscard]] OwnCell* cell() const noexcept { return cell_; }

 private:
  struct Each {
    PartId part;
    BodyId body;
    std::size_t row;
    Pose X_WP;  ///< [m] at the last update
  };

  [[nodiscard]] Pose pose(std::size_t row) const {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    return posed(Mat3(Eigen::Map<const RowMajor>(rotations_.data() + 9 * row)),
                 Eigen::Map<const Vec3>(positions_.data() + 3 * row));
  }

  /// What jumps, or is faster than parts are moved, counts as at rest where it arrives.
  [[nodiscard]] static Twist twist(const Pose& before, const Pose& X, double dt) {
    const Vec3 way = origin(X) - origin(before);
    if (!(dt > 0.0) || !(way.norm() <= detail::LooseParts::greatest_speed * dt)) return {};
    const Turn turn = turn_of(rotation(X) * transposed(rotation(before)));
    return {way / dt, turn.angle / dt * turn.axis};
  }

  OwnCell* cell_;
  Array positions_, rotations_;
  std::vector<Each> all_;
  double time_ = std::numeric_limits<double>::infinity();  ///< [s] of the last update
};

/// Arrays of a model that must stay as they are.
class Frozen {
 public:
  /// @param arrays by their names
  explicit Frozen(const nb::dict& arrays) {
    for (const auto& [name, array] : arrays) {
      const Array now = nb::cast<Array>(array, false);
      all_.push_back({nb::cast<std::string>(name), now, {now.data(), now.data() + now.size()}});
    }
  }

  /// The name of one that has changed; empty: none has.
  [[nodiscard]] std::string changed() const {
    for (const Each& each : all_) {
      const std::size_t bytes = each.before.size() * sizeof(double);
      if (std::memcmp(each.now.data(), each.before.data(), bytes) != 0) return each.name;
    }
    return {};
  }

 private:
  struct Each {
    std::string name;
    Array now;
    std::vector<double> before;
  };
  std::vector<Each> all_;
};

}  // namespace

void bind_simulations(nb::module_& m) {
  nb::class_<Frozen>(m, "_Frozen", "Arrays that must stay as they are, by their names.")
      .def(nb::init<const nb::dict&>(), nb::arg("arrays"),
           nb::sig("def __init__(self, arrays: dict[str, numpy.ndarray]) -> None"))
      .def("changed", &Frozen::changed);
  nb::class_<Followed>(m, "_Followed", nb::type_slots(companion_slots<Followed>),
                       "Loose parts that are where arrays of a simulation have them.")
      .def(nb::init<OwnCell&, Array, Array, const std::vector<std::size_t>&,
                    const std::vector<std::string>&>(),
           nb::keep_alive<1, 2>(), nb::arg("cell"), nb::arg("positions").noconvert(),
           nb::arg("rotations").noconvert(), nb::arg("rows"), nb::arg("parts"),
           nb::sig("def __init__(self, cell: Cell, positions: numpy.ndarray, rotations: "
                   "numpy.ndarray, rows: collections.abc.Sequence[int], parts: "
                   "collections.abc.Sequence[str]) -> None"))
      .def("update", &Followed::update, nb::arg("time"));
}

}  // namespace repel::python
