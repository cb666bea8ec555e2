// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <nanobind/nanobind.h>

#include <repel/base/setup_error.hpp>
#include <repel/cell/layout.hpp>
#include <repel/schedule/world_changes.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "own_cell.hpp"

namespace repel::python {

PartId OwnCell::loose(const std::string& name) const {
  for (const PartId id : cell_->loose()) {
    if (cell_->world().part(id).name == name) return id;
  }
  throw SetupError("no loose part is called '" + name +
                   "'; allowed: the name of one of `loose` of the cell");
}

namespace {

double time_of(double over) {
  return checked("over", over, 0.0, detail::LooseParts::longest_time, "s");
}

void require_queued(bool is_queued) {
  if (!is_queued) throw SetupError("too many changes wait; allowed: 1024 at a time");
}

void add(OwnCell& own, const std::string& name, nb::handle X_WP, double over) {
  const InUse in_use = own.use();
  const PartId id = own.loose(name);
  const Cell& cell = own.cell();
  std::size_t at = 0;
  while (cell.loose()[at] != id) ++at;
  const Pose X = X_WP.is_none() ? cell.description().loose[at].X_WP : pose_of(X_WP, "X_WP");
  require_queued(own.cell().changes().add(id, X, time_of(over)));
}

std::string add_shape(OwnCell& own, const Shape& shape, nb::handle X_WP, double over) {
  const InUse in_use = own.use();
  const PartId id = own.cell().changes().add(shape, pose_of(X_WP, "X_WP"), time_of(over));
  if (!id.valid()) {
    throw SetupError("no loose part is free with room for a shape that reaches " +
                     to_text(shape.reach(), 4) +
                     " m; allowed: to give more of them `room` for it, or to remove one");
  }
  own.tell(id, shape);
  return own.cell().world().part(id).name;
}

void place(OwnCell& own, const std::string& name, nb::handle X_WP, nb::handle V_WP) {
  const InUse in_use = own.use();
  World& world = own.cell().world();
  const Twist V = V_WP.is_none() ? Twist{} : twist_of(V_WP, "V_WP");
  if (!world.place(world.part(own.loose(name)).body, pose_of(X_WP, "X_WP"), V)) {
    throw SetupError("V_WP: an entry is not finite");
  }
}

nb::object holder_of(OwnCell& own, const BodyState& body) {
  for (std::size_t arm = 0; arm < own.cell().arms(); ++arm) {
    if (body.presence.holder == own.cell().layout(arm).tool) return nb::cast(arm);
  }
  return nb::none();
}

nb::dict states(OwnCell& own) {
  const InUse in_use = own.use();
  const World& world = std::as_const(own.cell()).world();
  nb::dict all;
  for (const PartId id : own.cell().loose()) {
    const BodyState& body =
        world.motion().bodies[static_cast<std::size_t>(world.part(id).body.index)];
    nb::dict each;
    each["there"] = body.presence.is_there() ? double{body.presence.there.now} : 0.0;
    each["holder"] = holder_of(own, body);
    each["X_WP"] = to_array(body.X_WB);
    all[world.part(id).name.c_str()] = each;
  }
  return all;
}

nb::dict counts(OwnCell& own) {
  const InUse in_use = own.use();
  const ChangeCounts& counts = own.cell().changes().counts();
  nb::dict all;
  all["applied"] = std::int64_t{counts.applied};
  all["refused"] = std::int64_t{counts.refused};
  all["waited"] = std::int64_t{counts.waited};
  return all;
}

}  // namespace

void bind_loose(nb::module_& /*m*/) {
  constexpr double usual_time = WorldChanges::usual_time;
  nb::borrow<nb::class_<OwnCell>>(nb::type<OwnCell>())
      .def("add", &add, nb::arg("part"), nb::arg("X_WP") = nb::none(), nb::arg("over") = usual_time,
           nb::sig(("def add(self, part: str, X_WP: " + pose_type +
                    " | None = None, over: float = 0.2) -> None")
                       .c_str()),
           "Lets a loose part that is absent come at the pose X_WP [m]; none: that of its Loose. "
           "Its forces grow over the time `over` [s]. This and the four changes below are made at "
           "the beginning of the next ticks, in their order: see `changes`.")
      .def(
          "add", &add_shape, nb::arg("shape"), nb::arg("X_WP"), nb::arg("over") = usual_time,
          nb::sig(("def add(self, shape: Shape, X_WP: " + pose_type + ", over: float = 0.2) -> str")
                      .c_str()),
          "The same with a shape, in a loose part that is free and has `room` for it. Returns the "
          "name of the part.")
      .def(
          "move",
          [](OwnCell& own, const std::string& name, nb::handle X_WP, double speed) {
            const InUse in_use = own.use();
            using Parts = detail::LooseParts;
            checked("speed", speed, Parts::least_speed, Parts::greatest_speed, "m/s");
            require_queued(
                own.cell().changes().move(own.loose(name), pose_of(X_WP, "X_WP"), speed));
          },
          nb::arg("part"), nb::arg("X_WP"), nb::arg("speed") = WorldChanges::usual_speed,
          nb::sig(
              ("def move(self, part: str, X_WP: " + pose_type + ", speed: float = 0.25) -> None")
                  .c_str()),
          "Moves a part that lies free to a pose [m], on a straight line at a speed [m/s].")
      .def(
          "attach",
          [](OwnCell& own, const std::string& name, int arm, double over) {
            const InUse in_use = own.use();
            const BodyId tool = own.cell().layout(own.checked_arm(arm)).tool;
            require_queued(own.cell().changes().attach(own.loose(name), tool, time_of(over)));
          },
          nb::arg("part"), nb::arg("arm") = 0, nb::arg("over") = usual_time,
          "Lets the tool of an arm take a part where it is: over a time [s] it stops being an "
          "obstacle to the tool, and over as long again becomes part of it.")
      .def(
          "release",
          [](OwnCell& own, const std::string& name, double over) {
            const InUse in_use = own.use();
            require_queued(own.cell().changes().release(own.loose(name), time_of(over)));
          },
          nb::arg("part"), nb::arg("over") = usual_time,
          "Lets the tool that holds a part put it down.")
      .def(
          "remove",
          [](OwnCell& own, const std::string& name, double over) {
            const InUse in_use = own.use();
            require_queued(own.cell().changes().remove(own.loose(name), time_of(over)));
          },
          nb::arg("part"), nb::arg("over") = usual_time,
          "Lets a part go, held or not; its place can be used again.")
      .def("place", &place, nb::arg("part"), nb::arg("X_WP"), nb::arg("V_WP") = nb::none(),
           nb::sig(("def place(self, part: str, X_WP: " + pose_type +
                    ", V_WP: numpy.typing.ArrayLike | None = None) -> None")
                       .c_str()),
           "Puts a loose part at a pose [m] at once, as one that a camera or a simulation follows, "
           "before each tick. V_WP (6,): velocity [m/s] of its origin, then angular velocity "
           "[rad/s], world axes, until it is placed again; none: at rest.")
      .def_prop_ro("loose", &states, nb::sig("def loose(self) -> dict[str, dict[str, typing.Any]]"),
                   "The loose parts by name: how far each is `there`, 0 to 1, the `holder`, the "
                   "index of an arm or None, and X_WP [m] (4, 4).")
      .def_prop_ro("changes", &counts, nb::sig("def changes(self) -> dict[str, int]"),
                   "How many changes of loose parts were `applied`, how many `refused` since the "
                   "state of the part did not allow them, and the ticks in which one `waited`.");
}

}  // namespace repel::python
