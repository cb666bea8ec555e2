// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/cell.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <repel/base/setup_error.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "own_cell.hpp"

namespace repel::python {
namespace {

std::unique_ptr<Cell> built(CellDescription description, Trouble& trouble) {
  try {
    std::unique_ptr<Cell> cell;
    {
      const Released others_go_on;
      cell = std::make_unique<Cell>(std::move(description));
    }
    raise(trouble);
    return cell;
  } catch (const SetupError&) {
    raise(trouble);  // which is why
    throw;
  }
}

}  // namespace

OwnReadings::OwnReadings(nb::handle positions, nb::handle rates, std::size_t joints)
    : q(numbers_of(positions, "q", joints)), v(numbers_of(rates, "v", joints)) {}

void OwnReadings::add(nb::handle sensor, const std::string& drive) {
  if (!sensor.is_none()) {
    const std::vector<double> six = numbers_of(sensor, "wrench", 6);
    wrench = Wrench{{six[0], six[1], six[2]}, {six[3], six[4], six[5]}};
  }
  static constexpr std::pair<std::string_view, ArmState> states[] = {
      {"enabled", ArmState::enabled},
      {"disabled", ArmState::disabled},
      {"stopped", ArmState::stopped}};
  const auto* const found = std::find_if(std::begin(states), std::end(states),
                                         [&](const auto& each) { return each.first == drive; });
  if (found == std::end(states)) {
    throw SetupError("state is '" + drive + "'; allowed: enabled, disabled, stopped");
  }
  state = found->second;
}

ArmReadings OwnReadings::readings() const {
  return {.q = q, .v = v, .state = state, .wrench = wrench, .homed = homed};
}

OwnCell::OwnCell(OwnDescription description, Trouble trouble)
    : trouble_(std::move(trouble)),
      kinematics_(std::move(description.kinematics)),
      cell_(built(std::move(description.cell), trouble_)),
      names_(names_of(*cell_)) {
  for (const ArmDescription& arm : cell_->description().arms) {
    auto& end = ends_.emplace_back();
    if (arm.takes_motion) end.emplace(arm.model, arm.response, 1.0 / cell_->description().rate_hz);
  }
}

Tick OwnCell::tick_of(std::size_t arm, const TickRecord& record, const OwnReadings& own) {
  Tick tick{record, names_[arm]};
  if (auto& end = ends_[arm]) {
    end->step(own.readings(), record.torques, record.brakes);
    tick.positions.assign(end->positions().begin(), end->positions().end());
    tick.rates.assign(end->rates().begin(), end->rates().end());
  }
  return tick;
}

std::chrono::nanoseconds OwnCell::time_of(std::optional<std::int64_t> now) {
  last_ = now ? std::chrono::nanoseconds(*now) : last_ + cell_->period();
  return last_;
}

std::size_t OwnCell::checked_arm(int arm) const {
  return static_cast<std::size_t>(
      checked("arm", arm, 0.0, static_cast<double>(cell_->arms()) - 1.0, ""));
}

Tick OwnCell::step(nb::handle q, nb::handle v, const network::Command& hands,
                   std::optional<std::int64_t> now, bool homed, nb::handle wrench,
                   const std::string& state) {
  if (cell_->arms() != 1) {
    throw SetupError("step is for a cell with one arm; allowed: sense, then act");
  }
  const InUse in_use(is_in_use_);
  OwnReadings own(q, v, names_.front()->joints);
  own.add(wrench, state);
  own.homed = homed;
  const TickRecord* record = nullptr;
  {
    const auto time = time_of(now);
    const Released others_go_on;
    record = &cell_->step(own.readings(), hands, time);
  }
  records_.assign(1, record);
  raise(trouble_);
  return tick_of(0, *record, own);
}

void OwnCell::sense(const nb::sequence& readings, std::optional<std::int64_t> now, bool homed) {
  const InUse in_use(is_in_use_);
  if (nb::len(readings) != cell_->arms()) {
    throw nb::value_error(("readings: expected " + std::to_string(cell_->arms()) +
                           ", one for each arm, got " + std::to_string(nb::len(readings)))
                              .c_str());
  }
  std::vector<OwnReadings> own;
  for (std::size_t arm = 0; arm < cell_->arms(); ++arm) {
    const nb::object each = readings[arm];
    const std::size_t count = nb::isinstance<nb::sequence>(each) ? nb::len(each) : 0;
    if (count < 2 || count > 4) {
      throw nb::type_error(
          "readings: expected (q, v), (q, v, wrench) or (q, v, wrench, state) for each arm");
    }
    OwnReadings& reading = own.emplace_back(each[0], each[1], names_[arm]->joints);
    reading.add(count > 2 ? nb::object(each[2]) : nb::none(),
                count > 3 ? nb::cast<std::string>(each[3]) : "enabled");
    reading.homed = homed;
  }
  std::vector<ArmReadings> all;
  all.reserve(own.size());
  for (const OwnReadings& each : own) all.push_back(each.readings());
  {
    const auto time = time_of(now);
    const Released others_go_on;
    cell_->sense(all, time);
  }
  sensed_ = std::move(own);
  has_sensed_ = true;
  raise(trouble_);
}

std::vector<Tick> OwnCell::act(const std::vector<network::Command>& hands) {
  const InUse in_use(is_in_use_);
  if (!has_sensed_) throw SetupError("act comes after sense, once");
  if (hands.size() != cell_->arms()) {
    throw nb::value_error(("commands: expected " + std::to_string(cell_->arms()) +
                           ", one for each arm, got " + std::to_string(hands.size()))
                              .c_str());
  }
  has_sensed_ = false;
  std::vector<Tick> ticks;
  {
    std::span<const TickRecord* const> records;
    {
      const Released others_go_on;
      records = cell_->act(hands);
    }
    records_.assign(records.begin(), records.end());
    for (std::size_t i = 0; i < records.size(); ++i)
      ticks.push_back(tick_of(i, *records[i], sensed_[i]));
  }
  raise(trouble_);
  return ticks;
}

namespace {

network::GainCheck gain_check_of(const std::string& name) {
  if (name == "error") return network::GainCheck::error;
  if (name == "warning") return network::GainCheck::warning;
  throw SetupError("gain_check is '" + name + "'; allowed: error, warning");
}

StartInside start_inside_of(const std::string& name) {
  if (name == "refuse") return StartInside::refuse;
  if (name == "push_out") return StartInside::push_out;
  if (name == "allow") return StartInside::allow;
  throw SetupError("start_inside is '" + name + "'; allowed: refuse, push_out, allow");
}

CoprocessorMode mode_of(const std::string& name) {
  if (const auto mode = coprocessor_mode_named(name)) return *mode;
  throw SetupError("mode is '" + name + "'; allowed: together, beside");
}

int traverse(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  for (const OwnKinematics* own : nb::inst_ptr<OwnCell>(self)->kinematics()) {
    Py_VISIT(own->object().ptr());
  }
  return 0;
}

int clear(PyObject* self) {
  if (!nb::inst_ready(self)) return 0;  // its __init__ has failed, or has not been called
  for (OwnKinematics* own : nb::inst_ptr<OwnCell>(self)->kinematics()) own->clear();
  return 0;
}

/// What may be asked of a cell between ticks.
void bind_questions(nb::class_<OwnCell>& cell) {
  cell.def(
          "X_WT", [](OwnCell& c, int arm) { return to_array(c.cell().X_WT(c.checked_arm(arm))); },
          nb::arg("arm") = 0, nb::sig("def X_WT(self, arm: int = 0) -> numpy.ndarray"),
          "[m] (4, 4) the tool of an arm, as of the last `sense` or `step`.")
      .def_prop_ro(
          "elapsed", [](OwnCell& c) { return c.cell().elapsed(); },
          "[s] since the last tick, as of the last `sense`.")
      .def_prop_ro(
          "period",
          [](OwnCell& c) { return std::chrono::duration<double>(c.cell().period()).count(); },
          "[s]")
      .def_prop_ro("arm_count", [](OwnCell& c) { return c.cell().arms(); })
      .def(
          "joints",
          [](OwnCell& c, int arm) {
            std::vector<std::string> names;
            const CellDescription& d = c.cell().description();
            for (const ArmLink& link : d.arms[c.checked_arm(arm)].model.links) {
              names.push_back(link.joint_name);
            }
            return names;
          },
          nb::arg("arm") = 0, "The names of the joints of an arm, base outward.")
      .def(
          "start",
          [](OwnCell& c, int arm) {
            const auto& start = c.cell().description().arms[c.checked_arm(arm)].start;
            return to_array(start.data(), {start.size()});
          },
          nb::arg("arm") = 0, nb::sig("def start(self, arm: int = 0) -> numpy.ndarray"),
          "[rad] or [m] (joints,) where an arm starts.")
      .def_prop_ro(
          "pairs", [](OwnCell& c) { return names_of(c.cell()).front()->pairs; },
          "The names of the pairs.")
      .def_prop_ro(
          "warnings", [](OwnCell& c) { return c.cell().warnings(); },
          "What the description was forgiven.");
}

}  // namespace

void bind_cell(nb::module_& m) {
  // The collector finds cells that their own kinematics refer to.
  PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse)},
                         {Py_tp_clear, reinterpret_cast<void*>(clear)},
                         {0, nullptr}};
  nb::class_<OwnCell> cell(m, "Cell", nb::type_slots(slots),
                           "Everything between the joint readings of arms and the torques sent to "
                           "them, with all checks. Not for two threads at once.");
  cell.def(
          "__init__",
          [](OwnCell* self, double rate_hz, nb::handle arms, nb::handle obstacles, nb::handle loose,
             const std::string& gain_check, const std::string& start_inside, nb::handle limits,
             const std::string& measure, int threads, const std::string& mode) {
            const Trouble trouble = std::make_shared<std::optional<nb::python_error>>();
            OwnDescription description = described(rate_hz, arms, obstacles, loose, trouble);
            description.cell.gain_check = gain_check_of(gain_check);
            description.cell.start_inside = start_inside_of(start_inside);
            description.cell.limits = capacities_of(limits);
            description.cell.measure = measure_of(measure);
            description.cell.coprocessor.threads =
                static_cast<int>(checked("threads", threads, 0.0, 64.0, ""));
            description.cell.coprocessor.mode = mode_of(mode);
            new (self) OwnCell(std::move(description), trouble);
          },
          nb::kw_only(), nb::arg("rate_hz"), nb::arg("arms"),
          nb::arg("obstacles") = nb::make_tuple(), nb::arg("loose") = nb::make_tuple(),
          nb::arg("gain_check") = "error", nb::arg("start_inside") = "refuse",
          nb::arg("limits") = nb::none(), nb::arg("measure") = "deepest_point",
          nb::arg("threads") = 0, nb::arg("mode") = "together",
          nb::sig(
              "def __init__(self, *, rate_hz: float, arms: collections.abc.Sequence[repel."
              "Arm], obstacles: collections.abc.Sequence[repel.Obstacle] = (), loose: "
              "collections.abc.Sequence[repel.Loose] = (), gain_check: str "
              "= 'error', start_inside: str = 'refuse', limits: repel.Capacities | None = None, "
              "measure: str = 'deepest_point', threads: int = 0, mode: str = 'together') -> None"),
          "rate_hz [Hz] of the tick, 1 to 1e5. loose: parts that come and go, see `add`. "
          "gain_check of a wall too stiff for it: error, or "
          "warning (see `warnings`). start_inside: what becomes of an arm that starts in an "
          "obstacle, refuse, push_out (slowly) or allow. limits: how much the cell can hold; none: "
          "Capacities(). measure of an overlap: see QueryOptions. threads of the coprocessor, "
          "besides the caller, and their mode: together, which share the pairs of a tick, or "
          "beside, whose answers are of a tick before. Runs every check; raises SetupError.")
      .def("step", &OwnCell::step, nb::arg("q"), nb::arg("v"), nb::arg("command"),
           nb::arg("now") = nb::none(), nb::arg("homed") = false, nb::kw_only(),
           nb::arg("wrench") = nb::none(), nb::arg("state") = "enabled",
           nb::sig("def step(self, q: numpy.typing.ArrayLike, v: numpy.typing.ArrayLike, command: "
                   "Command, now: int | None = None, homed: bool = False, *, wrench: "
                   "numpy.typing.ArrayLike | None = None, state: str = 'enabled') -> Tick"),
           "One tick of a cell with one arm: joint positions q [rad] or [m] and rates v (joints,), "
           "the command of the operator, and the due time `now` [ns], above 0 and growing from "
           "tick to tick; without it, one period after the last. What is not finite is a fault of "
           "the tick, not an error. homed: the positions are those of the arm, by a reference "
           "beside its encoders; a joint that was lost is believed then. wrench [N, N m] (6,): of "
           "a force sensor that carries the tool, on the tool, about its origin and in its axes, "
           "for the module force_sensor. state of the drive: enabled, disabled or stopped.")
      .def("sense", &OwnCell::sense, nb::arg("readings"), nb::arg("now") = nb::none(),
           nb::arg("homed") = false,
           nb::sig("def sense(self, readings: collections.abc.Sequence[tuple[typing.Any, ...]], "
                   "now: int | None = None, homed: bool = False) -> None"),
           "The first half of a tick: for each arm (q, v), (q, v, wrench) or (q, v, wrench, "
           "state), with the wrench or None. See `step`; homed is of all arms.")
      .def("act", &OwnCell::act, nb::arg("commands"),
           "The second half of a tick: a command for each arm. Returns a Tick for each.");
  bind_questions(cell);
}

}  // namespace repel::python
