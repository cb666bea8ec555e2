// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <repel/runs/engine/session.hpp>
#include <repel/runs/faults/choice.hpp>
#include <repel/runs/faults/exchange.hpp>
#include <repel/runs/options/hand_track.hpp>
#include <repel/runs/report/report.hpp>
#include <repel/runs/setup/run_choice.hpp>
#include <repel/scene/scene.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "tick.hpp"

namespace repel::python {
namespace {

/// What Python wants from a run while it goes on.
class Watcher {
 public:
  /// @param on_tick called with the list of the ticks of all arms, and may return what their
  /// operators do next; None: it is not called
  /// @param every [ticks] it is called
  /// @param stop has `is_set()`, as threading.Event; None: the run ends by itself
  Watcher(nb::object on_tick, int every, nb::object stop, std::size_t arms)
      : hands(arms), on_tick_(std::move(on_tick)), every_(every), stop_(std::move(stop)) {}

  /// After each tick, in its thread. An exception ends the run at once and is kept.
  void look(const Cell& cell, std::span<const TickRecord* const> records) {
    // Who wants nothing can still press Ctrl-C.
    const std::int64_t tick = records.front()->tick;
    const bool calls = !on_tick_.is_none() && tick % every_ == 0;
    if (!calls && stop_.is_none() && tick % 64 != 0) return;
    const nb::gil_scoped_acquire holds;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      if (!stop_.is_none() && nb::cast<bool>(stop_.attr("is_set")())) ends = true;
      if (!calls) return;
      if (names_.empty()) names_ = names_of(cell);
      nb::list ticks;
      for (std::size_t i = 0; i < records.size(); ++i) ticks.append(Tick{*records[i], names_[i]});
      obey(on_tick_(ticks));
    } catch (...) {
      trouble = std::current_exception();
      ends = at_once = true;
    }
  }

  std::atomic<bool> ends{false};
  std::atomic<bool> at_once{false};
  std::exception_ptr trouble;
  std::vector<std::optional<network::Command>> hands;  ///< see SessionOptions

 private:
  /// @param told None, the command of the first arm, or one or None for each arm
  void obey(const nb::object& told) {
    std::fill(hands.begin(), hands.end(), std::nullopt);
    if (told.is_none()) return;
    if (nb::isinstance<network::Command>(told)) {
      hands.front() = nb::cast<network::Command>(told);
      return;
    }
    std::vector<std::optional<network::Command>> all;
    if (!nb::isinstance<nb::sequence>(told) || !nb::try_cast(told, all) ||
        all.size() != hands.size()) {
      throw nb::type_error(
          ("on_tick: expected None, a Command of the first arm, or a sequence of " +
           std::to_string(hands.size()) + ", a Command or None for each arm")
              .c_str());
    }
    std::copy(all.begin(), all.end(), hands.begin());  // the run reads them where they are
  }

  nb::object on_tick_;
  int every_;
  nb::object stop_;
  std::vector<std::shared_ptr<const TickNames>> names_;
};

/// @param table [s, m/s, rad/s, ...] (rows, 7) or (rows, 11), the columns of read_hand_track
runs::HandTrack track_of(nb::handle table, const std::string& name) {
  const auto rows =
      value_of<std::vector<std::vector<double>>>(table, name, "numbers (rows, 7) or (rows, 11)");
  std::vector<runs::HandRow> track;
  track.reserve(rows.size());
  for (const std::vector<double>& x : rows) {
    if (x.size() != 7 && x.size() != 11) {
      throw SetupError(name + ": a row of " + std::to_string(x.size()) +
                       " numbers; allowed: 7 or 11, see repel.run");
    }
    track.push_back(runs::hand_row_of(x));
  }
  return runs::HandTrack(std::move(track));
}

nb::tuple run_scene(const std::string& file, double seconds, bool fast,
                    std::optional<double> rate_hz, const std::optional<std::string>& backend,
                    const std::string& log, nb::object on_tick, int every, nb::object stop,
                    const std::vector<std::string>& arguments, const nb::list& hands) {
  runs::RunChoice choice = runs::choice_of(arguments);
  const scene::Scene scene = runs::scene_of(choice, file);
  choice.rate_hz = rate_hz.value_or(choice.rate_hz);
  runs::RunOptions options = runs::options_of(choice, scene);
  options.seconds =
      choice.has_seconds ? options.seconds : checked("seconds", seconds, 0.0, 1e6, "s");
  options.fast = fast || options.fast;
  // Other libraries of the process reserve gigabytes that would be filled for it.
  options.lock_memory = !options.fast;
  checked("rate_hz", options.rate_hz, 1.0, 1e5, "Hz");
  options.backend = backend.value_or(options.backend);
  options.log = log;
  checked("every", every, 1.0, 1e9, "ticks");
  Watcher watcher(std::move(on_tick), every, std::move(stop), scene.partners.size() + 1);
  runs::SessionOptions session;
  session.on_tick = [&watcher](const Cell& cell, std::span<const TickRecord* const> records) {
    watcher.look(cell, records);
  };
  session.hands = watcher.hands;
  for (const std::string& table : choice.hands) {
    session.tracks.push_back(runs::read_hand_track(table));
  }
  for (std::size_t i = 0; i < hands.size(); ++i) {
    session.tracks.push_back(track_of(hands[i], "hands[" + std::to_string(i) + "]"));
  }
  runs::RunResult result;
  {
    const nb::gil_scoped_release others_go_on;
    result = runs::run_session(scene, options, session, nullptr, watcher.ends, watcher.at_once,
                               [](const runs::Progress&) {});
  }
  if (watcher.trouble) std::rethrow_exception(watcher.trouble);
  std::ostringstream report;
  runs::write_json(result, report);
  return nb::make_tuple(report.str(), runs::exit_status(result));
}

}  // namespace

void bind_runs(nb::module_& m) {
  m.def("run_scene", &run_scene, nb::arg("file"), nb::kw_only(), nb::arg("seconds"),
        nb::arg("fast"), nb::arg("rate_hz").none(), nb::arg("backend").none(), nb::arg("log"),
        nb::arg("on_tick").none(), nb::arg("every"), nb::arg("stop").none(), nb::arg("arguments"),
        nb::arg("hands"),
        nb::sig("def run_scene(file: str, *, seconds: float, fast: bool, rate_hz: float | None, "
                "backend: str | None, log: str, on_tick: typing.Any, every: int, stop: typing.Any, "
                "arguments: list[str], hands: list[typing.Any]) -> tuple[str, int]"),
        "See repel.run: the report as JSON, and the exit status of teleop.");
  m.def(
      "fault_names",
      [] {
        nb::list names;
        for (const faults::Fault& fault : faults::all_faults()) {
          if (faults::can_be_had(fault)) {
            names.append(nb::make_tuple(fault.name, faults::to_text(fault.kind)));
          }
        }
        return names;
      },
      nb::sig("def fault_names() -> list[tuple[str, str]]"),
      "The faults that a run can have, each with its kind: those of teleop list --faults.");
  m.def("run_words", &runs::names_of_choice,
        "The options of teleop run that `run_scene` takes as arguments.");
}

}  // namespace repel::python
