# SPDX-License-Identifier: BSD-3-Clause
"""Strict access to a YAML file: every value knows its line; nothing is guessed or ignored."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from typing import Any, NoReturn

from .._errors import SetupError, needed

_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?inf)\s*(.*?)\s*")

#: What one of a unit is, in the units of the package.
_UNITS = {"s": {"s": 1.0, "ms": 1e-3}, "Hz": {"Hz": 1.0, "kHz": 1e3},
          "m/s": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3},
          "rad/s": {"rad/s": 1.0, "deg/s": 0.017453292519943295},
          "m/s^2": {"m/s^2": 1.0}, "rad/s^2": {"rad/s^2": 1.0}, "": {"": 1.0}}


def number_and_unit(text: str) -> tuple[float, str] | None:
    """`20 N` is (20.0, "N"); None: it is no number."""
    found = _NUMBER.fullmatch(text)
    return (float(found[1]), found[2]) if found else None


class Entry:
    """A value of a file. What it does not have is refused with file, line and what is allowed."""

    def __init__(self, node: Any, name: str, file: str):
        self._node = node
        self.name = name
        self.file = file
        self.line = int(node.start_mark.line) + 1

    def fail(self, message: str) -> NoReturn:
        raise SetupError(f"{self.file}:{self.line}: {message}", self.file, self.line)

    @property
    def is_text(self) -> bool:
        return bool(self._node.id == "scalar")

    @property
    def is_list(self) -> bool:
        return bool(self._node.id == "sequence")

    @property
    def is_map(self) -> bool:
        return bool(self._node.id == "mapping")

    @property
    def text(self) -> str:
        if not self.is_text or not self._node.value:
            self.fail(f"{self.name}: expected a word or a number")
        return str(self._node.value)

    def word_of(self, words: Iterable[str]) -> str:
        if self.text not in (allowed := list(words)):
            self.fail(f"{self.name} is '{self.text}'; {did_you_mean(self.text, allowed)}")
        return self.text

    def number(self, unit: str = "", low: float = float("-inf"),
               high: float = float("inf")) -> float:
        """In `unit`, one of the package; a number without one is in it, too."""
        found = number_and_unit(self.text)
        factor = _UNITS[unit].get(found[1] or unit) if found else None
        if found is None or factor is None or not low <= found[0] * factor <= high:
            units = " or ".join(each for each in _UNITS[unit] if each)
            self.fail(f"{self.name} is '{self.text}'; allowed: a number from {low:g} to {high:g}"
                      + (f" {unit} ({units})" if units else ""))
        return found[0] * factor

    def integer(self, low: int, high: int) -> int:
        number = self.number("", low, high)
        if number != int(number):
            self.fail(f"{self.name} is '{self.text}'; allowed: a whole number")
        return int(number)

    def __iter__(self) -> Iterator[Entry]:
        """The entries of a list, or the only one of what is none."""
        if not self.is_list:
            return iter([self])
        return iter([Entry(each, f"{self.name}[{i}]", self.file)
                     for i, each in enumerate(self._node.value)])

    def entries(self, allowed: Iterable[str] | None = None) -> dict[str, Entry]:
        """Of a map, by key. allowed: the keys there may be; None: any."""
        if not self.is_map:
            self.fail(f"{self.name}: expected a map, as {{key: value}}")
        found: dict[str, Entry] = {}
        for key, value in self._node.value:
            entry = Entry(value, str(key.value), self.file)
            entry.line = int(key.start_mark.line) + 1
            if entry.name in found:
                entry.fail(f"{entry.name} stands twice in {self.name}")
            if allowed is not None and entry.name not in (keys := list(allowed)):
                entry.fail(f"unknown key '{entry.name}' of {self.name}; "
                           f"{did_you_mean(entry.name, keys)}")
            found[entry.name] = entry
        return found

    def only(self, allowed: Iterable[str]) -> Entry:
        """The entry of a map that has just one."""
        entries = self.entries(keys := list(allowed))
        if len(entries) != 1:
            self.fail(f"{self.name}: expected just one of {', '.join(keys)}")
        return next(iter(entries.values()))


def did_you_mean(word: str, allowed: list[str]) -> str:
    near = difflib.get_close_matches(word, allowed, 3)
    if near and len(allowed) > 12:
        return f"did you mean {' or '.join(near)}?"
    return ("did you mean " + near[0] + "? " if near else "") + "allowed: " + ", ".join(allowed)


def read(text: str, file: str) -> Entry:
    """The root of the only document in a text."""
    yaml = needed("yaml", "PyYAML", extra="study")
    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = mark.line + 1 if mark else 1
        raise SetupError(f"{file}:{line}: not YAML: {getattr(error, 'problem', error)}", file,
                         line) from error
    except RecursionError as error:
        raise SetupError(f"{file}: nested too deep; allowed: what docs/qualify.md has", file
                         ) from error
    if node is None:
        raise SetupError(f"{file}: the file is empty; allowed: one study", file)
    return Entry(node, "the study", file)
