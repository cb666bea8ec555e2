# SPDX-License-Identifier: BSD-3-Clause
"""What is measured of a run, and what must hold of it."""

from __future__ import annotations

import math
import os
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._errors import SetupError
from ..recording import Recording
from .entry import Entry, did_you_mean, number_and_unit

#: A function of the log and the report.
LogFunction = Callable[[Recording, Mapping[str, Any]], float]

_DEMANDS = {"torque_limit", "speed_limit", "torque_rate", "saturated", "joint_limit", "tool_speed"}
_LIMITS = {"torque_limit", "speed_limit", "torque_rate"}
_CUT_HZ = 30.0  # chatter is above it


def _sampling_energy(report: Mapping[str, Any]) -> float:
    arms = [report, *report["partners"]]
    return max(float(module["sampling_energy_j"]) for arm in arms for module in arm["modules"])


def _share(report: Mapping[str, Any], counts: Callable[[str], bool]) -> float:
    ticks = sum(n for name, n in report["status_ticks"].items() if counts(name))
    return float(ticks) / max(1, int(report["ticks"]))


#: Of the report, beside its keys.
OF_REPORT: dict[str, Callable[[Mapping[str, Any]], float | str]] = {
    "exit": lambda report: float(report["exit_status"]),
    "sampling_energy_j": _sampling_energy,
    "chatter_n": lambda report: of_report(report, "chatter.walls.force_rms_n"),
    "fault_share": lambda report: _share(report, lambda name: name not in _DEMANDS),
    "limit_share": lambda report: _share(report, lambda name: name in _LIMITS),
}


def _joint_speed(log: Recording, report: Mapping[str, Any]) -> float:
    joints = [log[name] for name in log if name[:1] == "q" and name[1:2].isdigit()]
    return max(float(np.abs(np.diff(joint)).max(initial=0.0)) for joint in joints) * float(
        report["rate_hz"])


def _wall_force(log: Recording, _: Mapping[str, Any]) -> float:
    x, y, z = (log[f"virtual_f{axis}_n"] for axis in "xyz")
    return float(np.sqrt(x * x + y * y + z * z).max(initial=0.0))


def _force_chatter(log: Recording, report: Mapping[str, Any]) -> float:
    """[N rms] of what is above 30 Hz: the difference from the mean over 1/30 s."""
    x, y, z = (log[f"virtual_f{axis}_n"] for axis in "xyz")
    force = np.sqrt(x * x + y * y + z * z)
    half = max(1, round(float(report["rate_hz"]) / (2 * _CUT_HZ)))
    if len(force) <= 2 * half:
        return 0.0
    sums = np.concatenate([[0.0], np.cumsum(force)])
    rest = force[half:-half] - (sums[2 * half + 1:] - sums[:-2 * half - 1]) / (2 * half + 1)
    return float(np.sqrt(np.mean(rest * rest)))


#: Of the log, which is written for them.
OF_LOG: dict[str, LogFunction] = {
    "joint_speed_rad_s": _joint_speed,
    "wall_force_n": _wall_force,
    "force_above_30hz_n": _force_chatter,
}


def _found(report: Any, path: str) -> Any:
    """The value at a path of the report: `chatter.walls.force_rms_n`, `modules.kbb2.energy_j`."""
    for step in path.split("."):
        if isinstance(report, list):
            named = [each for each in report if isinstance(each, dict) and each.get("name") == step]
            report = named[0] if named else report[int(step)]
        else:
            report = report[step]
    return report


def of_report(report: Mapping[str, Any], name: str) -> float | str:
    """A measure of the report. nan: it has no value there. Raises KeyError if it is no key."""
    if name in report or name not in OF_REPORT:
        try:
            value = _found(report, name)
        except (KeyError, IndexError, TypeError, ValueError) as error:
            raise KeyError(name) from error
        if value is None:
            return math.inf if name.startswith("nearest_") else math.nan  # nothing was near
        if isinstance(value, (dict, list)):
            raise KeyError(name)
        return value if isinstance(value, str) else float(value)
    return OF_REPORT[name](report)


@dataclass(frozen=True)
class Measure:
    """What is measured. source: of a function of the log of one's own, its file's text; of the
    others empty."""

    name: str
    function: str = ""
    source: str = ""
    file: str = ""
    is_word: bool = False

    @property
    def needs_log(self) -> bool:
        return bool(self.function) or self.name in OF_LOG

    def of(self, report: Mapping[str, Any], log: Recording | None) -> float | str:
        """Without the log that it needs, nan."""
        if not self.needs_log:
            return of_report(report, self.name)
        return math.nan if log is None else self._called(log, report)

    def _called(self, log: Recording, report: Mapping[str, Any]) -> float:
        if not self.function:
            return OF_LOG[self.name](log, report)
        value: Any = _compiled(self.source, self.file, self.function)(log, report)
        try:
            return float(value)
        except (TypeError, ValueError):
            raise TypeError(f"{self.name}: {self.function} returned {value!r}; allowed: a number"
                            ) from None


def told(error: Exception) -> str:
    """What went wrong in code, and where."""
    where = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({os.path.basename(where.filename)}:{where.lineno})"


_programs: dict[str, dict[str, Any]] = {}


def _compiled(source: str, file: str, function: str) -> LogFunction:
    """The text goes with the study, so that a worker needs no file of it."""
    if source not in _programs:
        namespace: dict[str, Any] = {"__name__": "repel_study_measures", "__file__": file}
        exec(compile(source, file, "exec"), namespace)  # the study's own
        _programs[source] = namespace
    found: LogFunction = _programs[source][function]
    return found


def measures_of(entry: Entry | None, folder: str) -> list[Measure]:
    """What `measure` says: names, and {NAME: FILE.py:FUNCTION}."""
    measures: list[Measure] = []
    for each in entry or ():
        if each.is_text:
            measures.append(Measure(each.text))
        else:
            measures += [_own(name, function, folder) for name, function in each.entries().items()]
    return measures


def _own(name: str, entry: Entry, folder: str) -> Measure:
    file, colon, function = entry.text.rpartition(":")
    path = os.path.join(folder, file)
    if not colon or not os.path.isfile(path):
        entry.fail(f"{name} is '{entry.text}'; allowed: FILE.py:FUNCTION, a file beside the study")
    with open(path, encoding="utf-8") as text:
        source = text.read()
    try:
        if not callable(_compiled(source, path, function)):
            entry.fail(f"{name}: {function} of {path} is no function")
    except SetupError:
        raise
    except KeyError:
        entry.fail(f"{name}: {path} has no function {function}")
    except Exception as error:
        entry.fail(f"{name}: {path} cannot be run: {error}")
    return Measure(name, function, source, path)


@dataclass(frozen=True)
class Bound:
    """What must hold of a measure. relation: above, below or equals. scale: what counts as one in
    the margin."""

    measure: str
    relation: str
    limit: float | str
    scale: float = 1.0

    @property
    def unit(self) -> str:
        """From the end of the name, as those of the report have it."""
        ends = {"_m": "m", "_j": "J", "_n": "N", "_nm": "N m", "_s": "s", "_us": "us", "_hz": "Hz",
                "_rad_s": "rad/s", "_kg": "kg"}
        return next((ends[end] for end in sorted(ends, key=len, reverse=True)
                     if self.measure.endswith(end)), "")

    def margin(self, row: Mapping[str, Any]) -> float:
        """Above 0 it holds; nan: it was not measured."""
        value: float | str = row[self.measure]
        if isinstance(value, str) or isinstance(self.limit, str):
            return 1.0 if value == self.limit else -1.0
        if self.relation == "equals":
            return 1.0 if value == self.limit else -abs(value - self.limit) / self.scale
        margin = (float(value) - self.limit) / self.scale
        return margin if self.relation == "above" else -margin


def bounds_of(entry: Entry) -> list[Bound]:
    """What `hold` says: {MEASURE: {above: NUMBER}, ...}, or {MEASURE: VALUE} for equals."""
    bounds = []
    for name, each in entry.entries().items():
        if each.is_text:
            bounds.append(_bound(name, "equals", each, None))
            continue
        relations = each.entries(("above", "below", "equals", "scale"))
        scale = relations.pop("scale", None)
        if not relations:
            each.fail(f"{name} without a bound; allowed: above, below, equals")
        bounds += [_bound(name, relation, limit, scale) for relation, limit in relations.items()]
    if not bounds:
        entry.fail("hold is empty; allowed: one bound or more, as {exit: 0}")
    return bounds


def _bound(name: str, relation: str, entry: Entry, scale: Entry | None) -> Bound:
    found = number_and_unit(entry.text)
    if found is None or found[1]:
        if relation != "equals":
            entry.fail(f"{name} {relation} '{entry.text}'; allowed: a number, in the unit that "
                       "the name of the measure ends in")
        return Bound(name, relation, entry.text)
    limit = found[0]
    if not math.isfinite(limit):
        entry.fail(f"{name} {relation} '{entry.text}'; allowed: a finite number")
    usual = abs(limit) if limit else 1.0
    return Bound(name, relation, limit, scale.number("", 1e-12, 1e12) if scale else usual)


def unknown(entry: Entry, measure: str, report: Mapping[str, Any], where: str = "") -> SetupError:
    """The error for a name that is none."""
    names = [name for name in (*report, *OF_REPORT, *OF_LOG) if name != measure]
    return SetupError(f"{entry.file}:{entry.line}: '{measure}' is not measured{where}; "
                      f"{did_you_mean(measure, names)} Allowed: a key of the report (with dots into "
                      f"it, as chatter.walls.force_rms_n), {', '.join([*OF_REPORT, *OF_LOG])}, or a "
                      "function that `measure` names", entry.file, entry.line)
