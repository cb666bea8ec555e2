# SPDX-License-Identifier: BSD-3-Clause
"""A study: the scenes of a cell, what varies in them, what is measured and what must hold."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import os
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .. import _repel
from .._errors import SetupError, how_to_have, needed
from .._scenes import path_of
from ..program import program, run
from ..recording import read_recording
from .entry import Entry, did_you_mean, number_and_unit, read
from .files import CannotRun, anywhere, here, read_by, require_same
from .hands import Hand, hand_of, write_table
from .measures import Bound, Measure, bounds_of, measures_of, told, unknown
from .quantities import SAMPLINGS, Quantity, draws, quantity_of, shares

_KEYS = ("name", "scenes", "runs", "seed", "seconds", "sampling", "with", "vary", "hand", "faults",
         "measure", "hold")
#: Options of a run by the name that a study has for them; flags by the word that sets them.
_OPTIONS = {"plant_inertia": "plant-inertia", "backend": "backend", "hold": "walls",
            "walls": "walls", "measure": "measure", "levels": "levels", "threads": "threads",
            "coprocessor": "coprocessor", "budget": "budget"}
_FLAGS = {"contact": ("yes", "--contact"), "tool_alone": ("yes", "--tool-alone"),
          "every_pair": ("yes", "--every-pair"), "prediction": ("no", "--no-prediction")}
_SHORT = {"drive_delay": "robot.drive_delay"}
_FILES = ("robot.urdf", "robot.mjcf", "robot.srdf")
_FAULT, _FAULT_TIME = "fault", "fault_s"
_OWN = ("index", "scene", "margin", "refused", "held")
_BESIDE = 0.0013371  # of a distribution, from its middle; of no usual range a whole number
_KNOTS = 1_000_000  # of a hand, at most, which takes a gigabyte

Values = dict[str, float | str]
Numbers = Sequence[float]


class Study:
    """A study that has been read and checked. A run of it is a function of the study and an index
    alone.

    name, file, text: of its file. runs: how many. seed: of all that is drawn. identity: a digest of
    what decides the rows. versions: of what decides their bits. files: digests of what the runs
    read. options: of the command line, beside the file, on which the runs depend. columns: name and
    type of the columns of a row.
    """

    def __init__(self, file: str, text: str, runs: int | None = None):
        self.file, self.text = file, text
        self.options: tuple[str, ...] = () if runs is None else ("--runs", str(runs))
        root = read(text, file)
        keys = root.entries(_KEYS)
        for required in ("scenes", "hold"):
            if required not in keys:
                root.fail(f"no key '{required}'; required: scenes, hold")
        self._folder = folder = os.path.dirname(os.path.abspath(file))
        name = os.path.splitext(os.path.basename(file))[0]
        self.name = keys["name"].text if "name" in keys else name
        self.seed = keys["seed"].integer(0, 2**53) if "seed" in keys else 1
        self.seconds = keys["seconds"].number("s", 1e-3, 1e6) if "seconds" in keys else 20.0
        self.sampling = keys["sampling"].word_of(SAMPLINGS) if "sampling" in keys else "random"
        self._scenes = _scenes_of(keys["scenes"], folder)
        if not self._scenes:
            keys["scenes"].fail("scenes is empty; allowed: one scene or more")
        self._fixed = _fixed_of(keys["with"]) if "with" in keys else ()
        drawn = [quantity_of(each) for each in keys["vary"].entries().values()] \
            if "vary" in keys else []
        if drawn:
            _refuse_replaced(keys["vary"], {each.name: _names_of(each) for each in drawn})
        self._hand: Hand = hand_of(keys.get("hand"), folder)
        drawn += _faults_of(keys["faults"], self.seconds) if "faults" in keys else []
        self._drawn = tuple(drawn)
        self.bounds: tuple[Bound, ...] = tuple(bounds_of(keys["hold"]))
        self._measures = self._all_measures(measures_of(keys.get("measure"), folder))
        self.runs = self._runs_of(keys.get("runs"), runs)
        self.files = self._read()
        self._check(root, keys)
        self.versions = self.versions_here()
        self.identity = self._digest()

    def versions_here(self) -> dict[str, str]:
        """Of what decides the bits of a row, in this process."""
        versions = {"repel": _version(), "numpy": np.__version__}
        if self.sampling != "random":
            versions["scipy"] = needed("scipy", extra="study").__version__
        return versions

    @property
    def scenes(self) -> tuple[tuple[str, str], ...]:
        """The names of the scenes in the table, and where they are on this machine."""
        return tuple((name, here(path)) for name, path in self._scenes)

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """What a search may change: the scene, if there are several, and what varies."""
        scenes = [each for each, _ in self.scenes]
        first = [Quantity("scene", kind="choice", choices=tuple(scenes), is_word=True)]
        return (*(first if len(scenes) > 1 else []), *self._drawn)

    @property
    def is_random(self) -> bool:
        """Whether the runs are a random sample: not for designs and grids, which are chosen."""
        is_drawn = any(each.kind != "grid" for each in self._drawn)
        return self.sampling == "random" if is_drawn else self._hand.random is not None

    @property
    def measures(self) -> tuple[str, ...]:
        return tuple(each.name for each in self._measures)

    @property
    def columns(self) -> tuple[tuple[str, str], ...]:
        def kind(is_word: bool) -> str:
            return "string" if is_word else "float64"
        return (("index", "int64"), ("scene", "string"),
                *((each.name, kind(each.is_word)) for each in self._drawn),
                *((each.name, kind(each.is_word)) for each in self._measures),
                ("margin", "float64"), ("refused", "string"), ("held", "bool"))

    def values(self, index: int) -> Values:
        """What varied in a run. Grids go round, the scenes the fastest; all else is drawn."""
        values: Values = {"scene": self.scenes[index % len(self.scenes)][0]}
        index_of_grid = index // len(self.scenes)
        drawn = [each.name for each in self._drawn if each.kind != "grid"]
        at = dict(zip(drawn, shares(self.sampling, self.seed, self.runs, drawn, index)))
        for each in self._drawn:
            if each.kind == "grid":
                values[each.name] = each.choices[index_of_grid % len(each.choices)]
                index_of_grid //= len(each.choices)
            else:
                values[each.name] = each.at(at[each.name])
        return values

    def point(self, index: int) -> tuple[Values, list[float] | None]:
        """Values and hand of a run to begin a search with: any index, beyond the runs as well."""
        hand = 2 * draws(self.seed, "searched hand", index, self.hand_size()) - 1
        return self.values(index), [float(x) for x in hand] or None

    def hand_size(self) -> int:
        """How many numbers from -1 to 1 the hand of a search has; 0: it is not drawn."""
        return self._hand.random.size(self.seconds) if self._hand.random else 0

    def row(self, index: int) -> dict[str, Any]:
        """Makes a run."""
        return {**self._made(self.values(index), self._table(index, None)), "index": index}

    def row_of(self, values: Mapping[str, float | str],
               hand: Numbers | None = None) -> dict[str, Any]:
        """Makes a run with these values, and a hand of hand_size() numbers. A value that is left
        out is that of the scene, a hand that is left out the script."""
        return {**self._made(dict(values), self._table(None, hand)), "index": -1}

    def command(self, which: int | Mapping[str, float | str], folder: str | os.PathLike[str],
                hand: Numbers | None = None) -> list[str]:
        """The command line that makes a run again, of an index or of values. Writes the table of
        the hand, if there is one, to `folder`. Raises NotWritten."""
        index = which if isinstance(which, int) else None
        values = self.values(which) if isinstance(which, int) else dict(which)
        table = self._table(index, hand)
        words = [program(), "run", self._scene_path(values), "--fast",
                 f"--seconds={self.seconds!r}", *self._words(values)]
        if table is not None:
            name = "hand.csv" if index is None else f"hand_{index}.csv"
            file = os.path.abspath(os.path.join(folder, name))  # the line is for any folder
            write_table(table, file)
            words.append(f"--hand={file}")
        return words

    def _table(self, index: int | None, numbers: Numbers | None) -> Any:
        """The rows of the hand; None: the script."""
        drawn = self._hand.random
        if drawn is None or (index is None and numbers is None):
            return self._hand.table
        if index is not None:
            knots = drawn.drawn(self.seed, index, self.seconds)
        else:
            knots = drawn.searched(list(numbers or ()), self.seconds)
        return drawn.table(knots, self.seconds)

    def _scene_path(self, values: Mapping[str, float | str]) -> str:
        return dict(self.scenes)[str(values.get("scene", self.scenes[0][0]))]

    def _words(self, values: Mapping[str, float | str]) -> list[str]:
        """The options of a run with these values."""
        settings = list(self._fixed)
        for each in self._drawn:
            if each.name in values and each.name not in (_FAULT, _FAULT_TIME):
                settings += each.settings(values[each.name])
        options: dict[str, list[str]] = {}
        for name, text in settings:
            options.pop(_key_of(name), None)  # what varies replaces what is fixed
            options[_key_of(name)] = _option(name, self._beside(name, text))
        words = [word for option in options.values() for word in option]
        fault = values.get(_FAULT, "none")
        if fault != "none":
            words.append(f"--fault={fault}@{values.get(_FAULT_TIME, 0.0)!r}")
        return words

    def _made(self, values: Values, table: Any, seconds: float | None = None) -> dict[str, Any]:
        row: dict[str, Any] = dict.fromkeys((name for name, _ in self.columns), math.nan)
        row.update({each.name: "" for each in self._drawn if each.is_word})
        row.update(values)
        row["scene"] = values.get("scene", self.scenes[0][0])
        require_same(self.files)
        refused = ""
        try:
            row.update(self._measured(values, table, seconds or self.seconds))
        except SetupError as error:
            refused = str(error)
        require_same(self.files)  # they may have changed meanwhile
        if refused:
            row.update({each.name: "" for each in self._measures if each.is_word})
            return {**row, "refused": refused, "held": False}
        least = self._margin(row)
        return {**row, "margin": least, "refused": "", "held": least > 0.0}

    def _margin(self, row: Mapping[str, Any]) -> float:
        """The least of the bounds. An equality that holds says nothing of how well."""
        margins = [bound.margin(row) for bound in self.bounds]
        graded = [margin for bound, margin in zip(self.bounds, margins)
                  if bound.relation != "equals"]
        if any(map(math.isnan, margins)):
            return math.nan
        return min(margins) if min(margins) <= 0.0 else min(graded or margins)

    def _measured(self, values: Values, table: Any, seconds: float) -> dict[str, Any]:
        hands = [] if table is None else [table]
        scene, words = self._scene_path(values), self._words(values)
        if not any(each.needs_log for each in self._measures):
            report = run(scene, seconds=seconds, hands=hands, arguments=words)
            return {each.name: each.of(report, None) for each in self._measures}
        with tempfile.TemporaryDirectory(dir=_quick_folder()) as folder:
            file = os.path.join(folder, "log.csv")
            try:
                report = run(scene, seconds=seconds, hands=hands, arguments=words, log=file)
                trouble = report["log_trouble"]
            except SetupError as error:
                trouble = str(error)
                if not trouble.startswith(file):
                    raise
            if trouble:
                raise CannotRun(f"{trouble}; allowed: room for the log of a run")
            log = read_recording(file)
        return {each.name: each.of(report, log) for each in self._measures}

    def _all_measures(self, named: list[Measure]) -> tuple[Measure, ...]:
        """Those that are named, and those of the bounds."""
        found = {each.name: each for each in named}
        for bound in self.bounds:
            found.setdefault(bound.measure, Measure(bound.measure))
        return tuple(found.values())

    def _runs_of(self, entry: Entry | None, runs: int | None) -> int:
        if runs is not None:
            return runs
        if entry is not None:
            return entry.integer(1, 10**9)
        return len(self.scenes) * math.prod(
            len(each.choices) for each in self._drawn if each.kind == "grid")

    def _check(self, root: Entry, keys: Mapping[str, Entry]) -> None:
        """Makes a short run of each scene, and one with every choice: what is refused is refused
        now, and what is measured is known.

        A value that is drawn may still be refused in its run: the row says so.
        """
        if not hasattr(_repel, "run_scene"):
            raise SetupError(f"this build runs no scenes: {how_to_have('teleop')}")
        vary = keys["vary"].entries() if "vary" in keys else {}
        for measure in self.measures:
            if measure in _OWN:
                _place_of(measure, keys).fail(f"'{measure}' is no measure, but another column of "
                                              "the table")
        for each in self._drawn:
            if each.name in _OWN or each.name in self.measures:
                root.fail(f"'{each.name}' cannot vary; it is another column of the table")
            if each.name in (_FAULT, _FAULT_TIME) and each.name in vary and "faults" in keys:
                vary[each.name].fail(f"{each.name} is drawn by faults, too; allowed: one of both")
            if each.name == _FAULT_TIME and (each.is_word or each.unit not in ("", "s")):
                vary[each.name].fail(f"{each.name} is no time in s; allowed: numbers in s")
        reports = [run(scene, seconds=0.0, arguments=self._words({})) for _, scene in self.scenes]
        for report in reports:
            self._require_measured(report, keys)
        self._measures = tuple(dataclasses.replace(each, is_word=isinstance(
            each.of(reports[-1], None), str)) for each in self._measures)
        self._check_bounds(reports[-1], keys)
        self._check_hand(keys)
        self._try_own(keys)
        for each in self._drawn:
            if each.name in vary:
                few = each.choices if len(each.choices) <= 100 else ()
                for value in few or (each.at(0.5),):
                    self._try({each.name: value}, vary[each.name], keys)
                if not each.choices:
                    self._try_beside(each, vary[each.name], keys)

    def _try(self, values: Values, entry: Entry, keys: Mapping[str, Entry]) -> None:
        for name, scene in self.scenes:
            what = f"{entry.name} of {name} set to {values[entry.name]}"
            try:
                report = run(scene, seconds=0.0, arguments=self._words(values))
            except SetupError as error:
                others = "" if "." in entry.name else (
                    f" (or an option of a run: {', '.join([*_OPTIONS, *_FLAGS, 'rate'])})")
                entry.fail(f"{what}: {error}{others}")
            self._require_measured(report, keys, f" with {what}")

    def _try_beside(self, quantity: Quantity, entry: Entry, keys: Mapping[str, Entry]) -> None:
        """The middle may be the only value that is whole, or 0: one beside it has to do, too."""
        try:
            self._try({quantity.name: quantity.at(0.5 - _BESIDE)}, entry, keys)
        except SetupError:
            self._try({quantity.name: quantity.at(0.5 + _BESIDE)}, entry, keys)

    def _require_measured(self, report: Mapping[str, Any], keys: Mapping[str, Entry],
                          where: str = "") -> None:
        for each in self._measures:
            try:
                each.of(report, None)
            except KeyError as error:
                raise unknown(_place_of(each.name, keys), each.name, report, where) from error

    def _check_bounds(self, report: Mapping[str, Any], keys: Mapping[str, Entry]) -> None:
        """A word never equals a number."""
        values = {each.name: each.of(report, None) for each in self._measures}
        for bound in self.bounds:
            value = values[bound.measure]
            if isinstance(value, str) and not isinstance(bound.limit, str):
                _place_of(bound.measure, keys).fail(
                    f"{bound.measure} {bound.relation} {bound.limit:g}, but it is a word, as "
                    f"'{value}'; allowed: a word that it equals")
            if isinstance(bound.limit, str) and not isinstance(value, str) and value == value:
                _place_of(bound.measure, keys).fail(
                    f"{bound.measure} equals '{bound.limit}', but it is a number; allowed: a "
                    "number without a unit, of yes and no 1 and 0")

    def _check_hand(self, keys: Mapping[str, Entry]) -> None:
        drawn = self._hand.random
        if drawn and drawn.knots(self.seconds) > _KNOTS:
            keys["hand"].fail(f"a random hand of {drawn.bandwidth:g} Hz for {self.seconds:g} s has "
                              f"{drawn.knots(self.seconds)} knots; allowed: {_KNOTS}, with a lower "
                              "bandwidth or fewer seconds")
        try:
            for _, scene in self.scenes if self._hand.table else ():
                run(scene, seconds=0.0, hands=[self._hand.table], arguments=self._words({}))
        except SetupError as error:
            keys["hand"].fail(str(error))

    def _try_own(self, keys: Mapping[str, Entry]) -> None:
        """Calls functions of one's own: with a short log, or if that is not enough, a whole one."""
        if not any(each.function for each in self._measures):
            return
        try:
            self._measured({}, self._hand.table, min(0.1, self.seconds))
        except Exception:
            try:
                self._measured({}, self._hand.table, self.seconds)
            except SetupError:
                raise
            except Exception as error:
                keys["measure"].fail(told(error))

    def _beside(self, name: str, text: str) -> str:
        """Robot files beside the study by their whole path: a scene would look beside itself."""
        path = os.path.join(self._folder, text)
        return path if name in _FILES and os.path.isfile(path) else text

    def _read(self) -> dict[str, str]:
        settings = [*self._fixed, *((name, str(text)) for each in self._drawn
                                    for choice in each.choices
                                    for name, text in each.settings(choice))]
        texts = list(dict.fromkeys(text for _, text in settings))
        return {file: digest for _, scene in self.scenes
                for file, digest in read_by(scene, texts, self._folder).items()}

    def _digest(self) -> str:
        digest = hashlib.blake2b(digest_size=16)
        # More runs leave those that are drawn by themselves as they are.
        runs = "" if self.sampling == "random" else str(self.runs)
        parts = [self.text, runs, repr(self.versions), repr(self._hand.table)]
        parts += [*(each.source for each in self._measures), *self.files.values()]
        for part in parts:
            digest.update(hashlib.blake2b(part.encode()).digest())
        return digest.hexdigest()


def load_study(path: str | os.PathLike[str], *, runs: int | None = None) -> Study:
    """Reads a study (docs/qualify.md). runs: in place of its own.

    Raises SetupError naming file, line, value and what is allowed; a run of no length is made of
    every scene and choice, so that paths and measures are known to be right.
    """
    file = os.fspath(path)
    try:
        with open(file, encoding="utf-8") as text:
            return Study(file, text.read(), runs)
    except (OSError, UnicodeDecodeError) as error:
        raise SetupError(f"{file}: cannot be read: {error}", file) from error


def _version() -> str:
    from .. import __version__
    return __version__


def _quick_folder() -> str | None:
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


def _scenes_of(entries: Entry, folder: str) -> tuple[tuple[str, str], ...]:
    """The names that they have in the table, and where they are."""
    scenes: dict[str, str] = {}
    for entry in entries:
        beside = os.path.join(folder, entry.text)
        path = beside if os.path.isfile(beside) else entry.text
        name = os.path.splitext(os.path.basename(path))[0]
        if name in scenes:
            entry.fail(f"another scene has the name {name} of '{entry.text}'; allowed: files with "
                       "different names, by which the table tells them apart")
        try:
            scenes[name] = anywhere(os.path.abspath(path_of(path)))
        except SetupError as error:
            entry.fail(str(error))
    return tuple(scenes.items())


def _fixed_of(entry: Entry) -> tuple[tuple[str, str], ...]:
    """What `with` says."""
    fixed = entry.entries()
    _refuse_replaced(entry, {name: [[name]] for name in fixed})
    for each in fixed.values():
        try:
            _option(each.name, each.text)
        except SetupError as error:
            each.fail(str(error))
    return tuple((each.name, each.text) for each in fixed.values())


def _names_of(quantity: Quantity) -> list[list[str]]:
    """What it sets, in each of its cases."""
    return [[name for name, _ in case] for case in quantity.cases] or [[quantity.name]]


def _refuse_replaced(entry: Entry, sets: Mapping[str, Sequence[Sequence[str]]]) -> None:
    """Refuses a value that a later one replaces in the same run: it would be told, and not used.
    sets: of each entry the names that it sets, in each of its cases."""
    before: dict[str, str] = {}
    for name, cases in sets.items():
        own: dict[str, str] = {}
        for case in cases:
            taken = dict(before)
            for key in map(_key_of, case):
                for other, by in taken.items():
                    if other == key or other.startswith(f"{key}."):
                        entry.entries()[name].fail(f"{name} replaces {other}, which {by} sets; "
                                                   "allowed: one entry that sets it")
                taken[key] = own[key] = name
        before.update(own)


def _key_of(name: str) -> str:
    """What a name sets: two may set the same."""
    return _OPTIONS.get(name, _SHORT.get(name, name))


def _place_of(measure: str, keys: Mapping[str, Entry]) -> Entry:
    """Where a measure is named."""
    return keys["hold"].entries().get(measure) or keys.get("measure", keys["hold"])


def _option(name: str, text: str) -> list[str]:
    """What the command line of a run says for a value."""
    if name in _OPTIONS:
        return [f"--{_OPTIONS[name]}={text}"]
    if name in _FLAGS:
        word, flag = _FLAGS[name]
        if text not in ("yes", "no"):
            raise SetupError(f"{name} is '{text}'; allowed: yes, no")
        return [flag] if text == word else []
    if name == "rate":
        found = number_and_unit(text)
        factor = {"": 1.0, "Hz": 1.0, "kHz": 1e3}.get(found[1]) if found else None
        if found and factor:
            return [f"--rate={found[0] * factor!r}"]
    return [f"--set={_SHORT.get(name, name)}={text}"]


def _faults_of(entry: Entry, seconds: float) -> list[Quantity]:
    """What `faults` says: {names: [...], at: [from, to]} or {kinds: [...], at: ...}."""
    keys = entry.entries(("names", "kinds", "at"))
    known = dict(_repel.fault_names())
    chosen = [each.word_of(["none", *known]) for each in keys.get("names", ())]
    kinds = [each.word_of(sorted(set(known.values()))) for each in keys.get("kinds", ())]
    chosen += [name for name, kind in known.items() if kind in kinds]
    if not chosen:
        entry.fail("faults without names or kinds; allowed: names of `teleop list --faults`, and "
                   f"kinds: {did_you_mean('', sorted(set(known.values())))}")
    times = [each.number("s", 0.0, seconds) for each in keys["at"]] if "at" in keys else []
    if len(times) not in (0, 2) or (times and times[0] >= times[1]):
        keys["at"].fail("at of faults: expected two times, the earlier first")
    low, high = times or (0.0, seconds)
    return [Quantity(_FAULT, kind="choice", choices=tuple(dict.fromkeys(chosen)), is_word=True),
            Quantity(_FAULT_TIME, "s", low=low, high=high)]
