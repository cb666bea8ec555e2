// SPDX-License-Identifier: BSD-3-Clause
#include "tick.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>

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

/// Type and doc of a property.
template <class Value>
std::pair<const char*, std::string> doc_of(const std::string& what) {
  if constexpr (std::is_same_v<Value, JointNumbers>) return {"numpy.ndarray", "(joints,) " + what};
  if constexpr (std::is_same_v<Value, Vec3>) return {"numpy.ndarray", "(3,) " + what};
  if constexpr (std::is_same_v<Value, Wrench>) return {"numpy.ndarray", "(6,) " + what};
  if constexpr (std::is_same_v<Value, ModuleEnergies>) return {"dict[str, float]", what};
  if constexpr (std::is_same_v<Value, Status>) return {"tuple[str, ...]", what};
  if constexpr (std::is_same_v<Value, Stop>) return {"str", what};
  if constexpr (std::is_same_v<Value, bool>) return {"bool", what};
  return {std::is_integral_v<Value> ? "int" : "float", what};
}

template <class Value>
nb::object value_of(const Tick& tick, const Value& x) {
  if constexpr (std::is_same_v<Value, JointNumbers>) {
    return joints_of(tick, x);
  } else if constexpr (std::is_same_v<Value, ModuleEnergies>) {
    return energy_of(tick);
  } else if constexpr (std::is_same_v<Value, Status>) {
    return names_of(x);
  } else if constexpr (std::is_same_v<Value, Stop>) {
    return nb::cast(to_text(x));
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return nb::cast(x);
  } else {
    return to_array(x);
  }
}

void add_fields(TickBinding& binding) {
  const TickRecord none;
  int count = 0;
  for_each_field(
      [&](const TickField& field, const auto& x) {
        const int place = count++;
        if (*field.name == '\0') return;
        const auto [type, doc] = doc_of<std::remove_cvref_t<decltype(x)>>(field.what);
        binding.add(field.name, type, doc.c_str(), [place](const Tick& tick) {
          nb::object found;
          int at = 0;
          for_each_field(
              [&](const TickField& /*field*/, const auto& y) {
                if (at++ == place) found = value_of(tick, y);
              },
              tick.record);
          return found;
        });
      },
      none);
}

void add_motion(TickBinding& binding) {
  const auto of_arm = [](const std::vector<double>& all) {
    return all.empty() ? nb::object(nb::none()) : to_array(all.data(), {all.size()});
  };
  binding.add(
      "positions", "numpy.ndarray | None",
      "[rad] or [m] (joints,) command to an arm with an Admittance; none: it takes torques.",
      [of_arm](const Tick& t) { return of_arm(t.positions); });
  binding.add("rates", "numpy.ndarray | None", "[rad/s] or [m/s] (joints,) the same as rates.",
              [of_arm](const Tick& t) { return of_arm(t.rates); });
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

// Not vector_of: what a master reports may be NaN, and the tick has its own reaction to that.
Vec3 row_of(nb::handle value, const char* name) {
  constexpr const char* expected = "three numbers (3,)";
  const Array v = array_of(value, name, expected);
  if (v.ndim() != 1 || v.size() != 3) refuse_shape(v, name, expected);
  return {v.data()[0], v.data()[1], v.data()[2]};
}

/// Calls visit(name, field, x) for what both hands of a command do.
template <class Command, class Visit>
void for_each_of_hands(Command& command, const Visit& visit) {
  for (auto* hand : {&command.hand, &command.second}) {
    const std::string prefix = hand == &command.hand ? "" : "second_";
    network::for_each_field(
        [&](const network::HandField& field, auto& x) { visit(prefix + field.name, field, x); },
        *hand);
  }
}

/// The arguments of a command, as a signature states them.
std::string arguments() {
  std::string text;
  const network::Command rest;
  for_each_of_hands(rest, [&](const std::string& name, const auto& /*field*/, const auto& x) {
    using Value = std::remove_cvref_t<decltype(x)>;
    if constexpr (std::is_same_v<Value, Vec3>) {
      text +=
          name + ": numpy.typing.ArrayLike = (" + std::to_string(std::lround(x.x())) + ", 0, 0)";
    } else if constexpr (std::is_integral_v<Value>) {
      text += name + ": int = " + std::to_string(x);
    } else {
      text += name + ": float = " + std::to_string(std::lround(x)) + ".0";
    }
    text += ", ";
  });
  return text + "silent_for: float = 0.0, sound: bool = True";
}

network::Command command_of(const nb::kwargs& given) {
  network::Command command;
  nb::dict left;
  left.update(given);
  const auto take = [&left](const std::string& name, auto& x) {
    if (!left.contains(name.c_str())) return;
    const nb::object value = left[name.c_str()];
    nb::del(left[name.c_str()]);
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(x)>, Vec3>) {
      x = row_of(value, name.c_str());
    } else if (!nb::try_cast(value, x)) {
      throw nb::type_error((name + ": expected a number").c_str());
    }
  };
  for_each_of_hands(
      command, [&](const std::string& name, const auto& /*field*/, auto& x) { take(name, x); });
  take("silent_for", command.silent_for);
  take("sound", command.sound);
  for (const auto& [name, value] : left) {
    throw nb::type_error(
        ("Command has no argument '" + nb::cast<std::string>(name) + "'; allowed: " + arguments())
            .c_str());
  }
  return command;
}

void bind_command(nb::module_& m) {
  using network::Command;
  nb::class_<Command> bound(m, "Command", "What the operator's master reports in one tick.");
  const std::string signature = "def __init__(self, *, " + arguments() + ") -> None";
  bound.def(
      "__init__",
      [](Command* command, const nb::kwargs& given) { new (command) Command(command_of(given)); },
      nb::sig(signature.c_str()),
      "What hands do and choose, in world axes; each is told at its property. silent_for [s]: age "
      "of the sample. sound: false if the source reports that its data are invalid.");
  const Command rest;
  for_each_of_hands(rest, [&](const std::string& name, const auto& field, const auto& x) {
    using Value = std::remove_cvref_t<decltype(x)>;
    const char* type = std::is_same_v<Value, Vec3> ? "numpy.ndarray"
                       : std::is_integral_v<Value> ? "int"
                                                   : "float";
    std::string told;
    if (*field.unit != '\0') told.append("[").append(field.unit).append("] ");
    if constexpr (std::is_same_v<Value, Vec3>) told += "(3,) ";
    told += field.what;
    bound.def_prop_ro(
        name.c_str(),
        [name](const Command& c) {
          nb::object found;
          for_each_of_hands(c, [&](const std::string& each, const auto& /*field*/, const auto& y) {
            if (each != name) return;
            if constexpr (std::is_same_v<Value, std::remove_cvref_t<decltype(y)>>) {
              if constexpr (std::is_same_v<Value, Vec3>) {
                found = to_array(y);
              } else {
                found = nb::cast(y);
              }
            }
          });
          return found;
        },
        nb::sig(("def " + name + "(self) -> " + type).c_str()), told.c_str());
  });
  bound.def_ro("silent_for", &Command::silent_for, "[s]")
      .def_ro("sound", &Command::sound)
      .def_ro("phase", &Command::phase, "Of a script.");
}

}  // namespace

void bind_ticks(nb::module_& m) {
  TickBinding binding(m);
  add_fields(binding);
  add_motion(binding);
  add_pairs(binding);
  binding.finish();
  bind_command(m);
}

}  // namespace repel::python
