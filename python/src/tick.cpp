// SPDX-License-Identifier: BSD-3-Clause
#include "tick.hpp"

#include <array>
#include <cstdint>

#include <nanobind/nanobind.h>

#include <repel/base/status.hpp>
#include <repel/network/operator.hpp>

#include "arrays.hpp"
#include "bindings.hpp"

namespace repel::python {

nb::tuple names_of(Status bits) {
  nb::list names;
  for (unsigned i = 0; i < 32; ++i) {
    const Status bit = bits & 1U << i;
    if (bit != 0U) names.append(to_text(bit));
  }
  return nb::tuple(names);
}

std::vector<std::shared_ptr<const TickNames>> names_of(const Cell& cell) {
  std::vector<std::shared_ptr<const TickNames>> all;
  const World& world = cell.world();
  for (std::size_t arm = 0; arm < cell.arms(); ++arm) {
    auto names = std::make_shared<TickNames>();
    for (const Pair& pair : world.pairs()) {
      names->pairs.push_back(world.part(pair.a).name + " - " + world.part(pair.b).name);
    }
    for (const network::Node& node : cell.network(arm).nodes()) {
      names->modules.push_back(node.name);
    }
    names->joints = cell.description().arms[arm].model.links.size();
    all.push_back(std::move(names));
  }
  return all;
}

namespace {

using JointNumbers = std::array<double, network::most_joints>;

nb::object joints_of(const Tick& tick, const JointNumbers& values) {
  return to_array(values.data(), {tick.names->joints});
}

nb::object name_of(const Tick& tick, PairId pair) {
  if (!pair.valid()) return nb::none();
  return nb::cast(tick.names->pairs[static_cast<std::size_t>(pair.index)]);
}

nb::dict energy_of(const Tick& tick) {
  nb::dict energy;
  for (std::size_t i = 0; i < tick.names->modules.size(); ++i) {
    energy[tick.names->modules[i].c_str()] = double{tick.record.energy[i]};
  }
  return energy;
}

/// Binds the properties; `as_dict` returns them all.
class TickBinding {
 public:
  explicit TickBinding(nb::module_& m)
      : class_(m, "Tick",
               "The record of one tick: the commands to the arm, and the state of the loop.") {}

  template <class Get>
  void add(const char* name, const char* type, const char* doc, Get get) {
    const std::string signature = std::string("def ") + name + "(self) -> " + type;
    class_.def_prop_ro(name, get, nb::sig(signature.c_str()), doc);
    names_.append(name);
  }

  void finish() {
    class_.attr("FIELDS") = nb::tuple(names_);
    class_.def(
        "as_dict",
        [](nb::handle self) {
          nb::dict all;
          for (nb::handle name : self.attr("FIELDS")) all[name] = nb::getattr(self, name);
          return all;
        },
        nb::sig("def as_dict(self) -> dict[str, typing.Any]"),
        "All of it, by the names of the attributes.");
    class_.def("__repr__", [](const Tick& t) {
      return "<repel.Tick " + std::to_string(t.record.tick) + ", " + to_text(t.record.stop) +
             ", status " + to_text(t.record.status) + ">";
    });
  }

 private:
  nb::class_<Tick> class_;
  nb::list names_;
};

void add_loop(TickBinding& binding) {
  binding.add("tick", "int", "Its number, from 0.", [](const Tick& t) { return t.record.tick; });
  binding.add("time", "float", "[s] since the first tick.",
              [](const Tick& t) { return t.record.time; });
  binding.add("phase", "int", "Of the operator's script.",
              [](const Tick& t) { return t.record.phase; });
  binding.add("status", "tuple[str, ...]",
              "Faults and limits that were noticed, by their names; empty: none.",
              [](const Tick& t) { return names_of(t.record.status); });
  binding.add("stop", "str", "What was done about faults: running, holding, braking or released.",
              [](const Tick& t) { return to_text(t.record.stop); });
  binding.add("brakes", "bool", "Engage the brakes of the arm.",
              [](const Tick& t) { return t.record.brakes; });
  binding.add("enable", "bool", "Enable the stopped drive of the arm again.",
              [](const Tick& t) { return t.record.enable; });
  binding.add("elapsed", "int", "[periods] since the last tick; more after missed ticks.",
              [](const Tick& t) { return t.record.elapsed; });
}

void add_arm(TickBinding& binding) {
  binding.add("torques", "numpy.ndarray", "[N m] or [N] (joints,) to be sent to the joints.",
              [](const Tick& t) { return joints_of(t, t.record.torques); });
  binding.add("q", "numpy.ndarray",
              "[rad] or [m] (joints,) as read, or predicted where the reading was not believed.",
              [](const Tick& t) { return joints_of(t, t.record.q); });
  binding.add("v", "numpy.ndarray", "[rad/s] or [m/s] (joints,) their rates.",
              [](const Tick& t) { return joints_of(t, t.record.v); });
  binding.add("p_WT", "numpy.ndarray", "[m] (3,) the tool.",
              [](const Tick& t) { return to_array(t.record.p_WT); });
  binding.add("v_WT", "numpy.ndarray", "[m/s] (3,) its velocity.",
              [](const Tick& t) { return to_array(t.record.v_WT); });
}

void add_forces(TickBinding& binding) {
  binding.add("virtual_force", "numpy.ndarray",
              "(6,) force [N] and torque [N m] of the walls on the tool, about its origin, world "
              "axes.",
              [](const Tick& t) { return to_array(t.record.virtual_force); });
  binding.add("coupling", "numpy.ndarray",
              "(6,) force [N] and torque [N m] from the operator's side on the tool.",
              [](const Tick& t) { return to_array(t.record.coupling); });
  binding.add("lever_torque", "float", "[N m] reflected to the lever; times `gain`.",
              [](const Tick& t) { return t.record.lever_torque; });
  binding.add(
      "grip", "numpy.ndarray",
      "(6,) force [N] and torque [N m] of a master with six axes on the hand; times `gain`.",
      [](const Tick& t) { return to_array(t.record.grip); });
  binding.add("gain", "float", "Of the fail-safe, 0 to 1.",
              [](const Tick& t) { return t.record.gain; });
  binding.add("held_force", "float", "[N] with which hard walls held the arm.",
              [](const Tick& t) { return t.record.held_force; });
  binding.add("hold_margin", "float",
              "[m] How far off every hard wall the arm can still be stopped, by the proof; "
              "infinite where none is near.",
              [](const Tick& t) { return t.record.hold.margin; });
  binding.add("energy", "dict[str, float]", "[J] the ledger of each module of the network.",
              &energy_of);
}

void add_pairs(TickBinding& binding) {
  binding.add("nearest", "float", "[m] least signed distance of all pairs evaluated.",
              [](const Tick& t) { return t.record.pairs.nearest; });
  binding.add("nearest_pair", "str | None", "The pair that has it.",
              [](const Tick& t) { return name_of(t, t.record.pairs.nearest_pair); });
  binding.add("deepest", "float", "[m] no pair evaluated was deeper.",
              [](const Tick& t) { return t.record.pairs.deepest; });
  binding.add("peak_force", "float", "[N] largest force of one pair.",
              [](const Tick& t) { return t.record.pairs.peak_force; });
  binding.add("hardest_pair", "str | None", "The pair that has it.",
              [](const Tick& t) { return name_of(t, t.record.pairs.hardest_pair); });
  binding.add("pairs_near", "int", "Pairs that may be within range.",
              [](const Tick& t) { return t.record.pairs.near; });
  binding.add("pairs_evaluated", "int", "Of these, evaluated at this tick.",
              [](const Tick& t) { return t.record.pairs.evaluated; });
  binding.add("pairs_stale", "int", "Of these, with an older answer.",
              [](const Tick& t) { return t.record.pairs.stale; });
}

network::Command command_of(nb::handle linear, nb::handle angular, double lever_rate,
                            nb::handle direction_W, double silent_for, bool sound) {
  // Not vector_of: what a master reports may be NaN, and the tick has its own reaction to that.
  const auto row = [](nb::handle value, const char* name) -> Vec3 {
    constexpr const char* expected = "three numbers (3,)";
    const Array v = array_of(value, name, expected);
    if (v.ndim() != 1 || v.size() != 3) refuse_shape(v, name, expected);
    return {v.data()[0], v.data()[1], v.data()[2]};
  };
  network::Command command;
  command.hand.ball = {row(linear, "linear"), row(angular, "angular")};
  command.hand.lever_rate = lever_rate;
  command.hand.direction_W = row(direction_W, "direction_W");
  command.silent_for = silent_for;
  command.sound = sound;
  return command;
}

void bind_command(nb::module_& m) {
  using network::Command;
  nb::class_<Command>(m, "Command", "What the operator's master reports in one tick.")
      .def(
          "__init__",
          [](Command* command, nb::handle linear, nb::handle angular, double lever_rate,
             nb::handle direction_W, double silent_for, bool sound) {
            new (command)
                Command(command_of(linear, angular, lever_rate, direction_W, silent_for, sound));
          },
          nb::kw_only(), nb::arg("linear") = nb::make_tuple(0.0, 0.0, 0.0),
          nb::arg("angular") = nb::make_tuple(0.0, 0.0, 0.0), nb::arg("lever_rate") = 0.0,
          nb::arg("direction_W") = nb::make_tuple(1.0, 0.0, 0.0), nb::arg("silent_for") = 0.0,
          nb::arg("sound") = true,
          nb::sig("def __init__(self, *, linear: numpy.typing.ArrayLike = (0, 0, 0), angular: "
                  "numpy.typing.ArrayLike = (0, 0, 0), lever_rate: float = 0.0, direction_W: "
                  "numpy.typing.ArrayLike = (1, 0, 0), silent_for: float = 0.0, sound: bool = "
                  "True) -> None"),
          "linear [m/s], angular [rad/s]: rates of a hand, world axes. lever_rate [rad/s] of a "
          "lever that is felt, which drives the tool along the unit vector direction_W. "
          "silent_for [s]: age of the sample. sound: false if the source reports that its data "
          "are invalid.")
      .def_prop_ro(
          "linear", [](const Command& c) { return to_array(c.hand.ball.linear); },
          nb::sig("def linear(self) -> numpy.ndarray"), "[m/s] (3,)")
      .def_prop_ro(
          "angular", [](const Command& c) { return to_array(c.hand.ball.angular); },
          nb::sig("def angular(self) -> numpy.ndarray"), "[rad/s] (3,)")
      .def_prop_ro(
          "direction_W", [](const Command& c) { return to_array(c.hand.direction_W); },
          nb::sig("def direction_W(self) -> numpy.ndarray"), "(3,) unit")
      .def_prop_ro(
          "lever_rate", [](const Command& c) { return c.hand.lever_rate; }, "[rad/s]")
      .def_ro("silent_for", &Command::silent_for, "[s]")
      .def_ro("sound", &Command::sound)
      .def_ro("phase", &Command::phase, "Of a script.");
}

}  // namespace

void bind_ticks(nb::module_& m) {
  TickBinding binding(m);
  add_loop(binding);
  add_arm(binding);
  add_forces(binding);
  add_pairs(binding);
  binding.finish();
  bind_command(m);
}

}  // namespace repel::python
