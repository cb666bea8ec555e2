# SPDX-License-Identifier: BSD-3-Clause
"""The hand of the operator in a study: a spline of few numbers, a table, or the script."""

from __future__ import annotations

import csv
import json
import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import _repel
from .._errors import SetupError
from .entry import Entry
from .quantities import draws
from .store import whole

#: The columns of a table of a hand, see `teleop run --hand`.
COLUMNS = ("time_s", "vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s")
LEVER_COLUMNS = ("lever_rad_s", "direction_x", "direction_y", "direction_z")
#: Knots by which a hand of so many axes is searched: with many numbers, few runs find nothing.
_SEARCHED = {3: 4, 6: 3}
_ROWS_A_KNOT = 10


def _length(way: np.ndarray) -> np.ndarray:
    x, y, z = way[..., 0], way[..., 1], way[..., 2]
    return np.asarray(np.sqrt(x * x + y * y + z * z))


@dataclass(frozen=True)
class RandomHand:
    """A hand whose rates are a uniform cubic B-spline: between its knots, and no faster than they.

    speed [m/s], turn [rad/s]: at most. bandwidth [Hz]: two knots a period. acceleration [m/s^2],
    turning [rad/s^2]: at most, by the differences of the knots.
    """

    speed: float
    turn: float
    bandwidth: float
    acceleration: float = math.inf
    turning: float = math.inf

    @property
    def axes(self) -> int:
        return 6 if self.turn > 0 else 3

    def knots(self, seconds: float) -> int:
        """How many a run has: the spline needs one before it begins, and two behind its end."""
        return math.ceil(2 * self.bandwidth * seconds) + 3

    def drawn(self, seed: int, index: int, seconds: float) -> np.ndarray:
        """The knots (knots, 6) of a random run: any direction, any part of the speed.

        By arithmetic alone, of which every processor makes the same bits.
        """
        count = self.knots(seconds)
        some = draws(seed, "hand ways", index, 24 * count).reshape(count, 6, 4)
        ways = some[..., 0] + some[..., 1] + some[..., 2] + some[..., 3] - 2  # nearly normal
        lengths = draws(seed, "hand lengths", index, 2 * count).reshape(count, 2)
        for part, most in ((0, self.speed), (1, self.turn)):
            way = ways[:, 3 * part:3 * part + 3]
            way *= (most * lengths[:, part] / np.maximum(1e-12, _length(way)))[:, None]
        return self.limited(ways, seconds)

    def searched(self, numbers: list[float], seconds: float) -> np.ndarray:
        """The knots (knots, 6) that numbers from -1 to 1 stand for: fewer, spread over the run."""
        few = np.clip(np.asarray(numbers, float), -1, 1).reshape(-1, self.axes)
        count = self.knots(seconds)
        at = np.linspace(0, len(few) - 1, count)
        knots = np.zeros((count, 6))
        for axis in range(self.axes):
            knots[:, axis] = np.interp(at, np.arange(len(few)), few[:, axis])
        knots[:, :3] *= self.speed
        knots[:, 3:] *= self.turn
        return self.limited(knots, seconds)

    def size(self, seconds: float) -> int:
        """How many numbers the search has."""
        return self.axes * min(_SEARCHED[self.axes], self.knots(seconds))

    def limited(self, knots: np.ndarray, seconds: float) -> np.ndarray:
        step = seconds / max(1, len(knots) - 3)
        for part, speed, rate in ((slice(0, 3), self.speed, self.acceleration),
                                  (slice(3, 6), self.turn, self.turning)):
            last = None
            for knot in knots[:, part]:
                knot *= min(1.0, speed / max(1e-12, float(_length(knot))))
                if last is not None and math.isfinite(rate):
                    change = knot - last
                    knot[:] = last + change * min(1.0, rate * step / max(1e-12,
                                                                         float(_length(change))))
                last = knot
        return knots

    def table(self, knots: np.ndarray, seconds: float) -> np.ndarray:
        """The rows (rows, 7) of the spline, for `repel.run(hands=...)`."""
        pieces = len(knots) - 3
        u = np.arange(pieces * _ROWS_A_KNOT + 1) / _ROWS_A_KNOT
        piece = np.minimum(u.astype(int), pieces - 1)
        t = (u - piece)[:, None]
        a, b, c, d = (knots[piece + i] for i in range(4))
        s, tt, ttt = 1 - t, t * t, t * t * t
        rates = (s * s * s * a + (3 * ttt - 6 * tt + 4) * b + (3 * tt - 3 * ttt + 3 * t + 1) * c
                 + ttt * d) / 6
        return np.column_stack([u * (seconds / pieces), rates])


@dataclass(frozen=True)
class Hand:
    """The hand of the first operator: the script (neither of both), drawn, or a table, in which
    he rests where it has no rows."""

    random: RandomHand | None = None
    table: tuple[tuple[float, ...], ...] | None = None


def hand_of(entry: Entry | None, folder: str) -> Hand:
    """What `hand` says: script, {random: ...}, {file: TABLE.csv} or {recording: RUN.mcap}."""
    if entry is None or (entry.is_text and entry.word_of(["script"])):
        return Hand()
    how = entry.only(("random", "file", "recording"))
    if how.name == "random":
        return Hand(_random_of(how))
    path = os.path.join(folder, how.text)
    if not os.path.isfile(path):
        how.fail(f"{how.name} of hand is '{how.text}', which is no file")
    rows = _rows_of_csv(path) if how.name == "file" else _rows_of_recording(path)
    return Hand(table=tuple(map(tuple, rows)))


def _random_of(entry: Entry) -> RandomHand:
    units = {"speed": "m/s", "turn": "rad/s", "bandwidth": "Hz", "acceleration": "m/s^2",
             "turning": "rad/s^2"}
    numbers = {name: each.number(units[name], 0.0 if name in ("speed", "turn") else 1e-3, 1e3)
               for name, each in entry.entries(units).items()}
    for name in ("speed", "bandwidth"):
        if name not in numbers:
            entry.fail(f"a random hand without {name}; allowed: with speed, bandwidth, and "
                       "possibly turn, acceleration, turning")
    return RandomHand(**{"turn": 0.0, **numbers})


def _rows_of_csv(path: str) -> list[list[float]]:
    with open(path, newline="", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    names = tuple(rows[0]) if rows else ()
    if names not in (COLUMNS, COLUMNS + LEVER_COLUMNS):
        raise SetupError(f"{path}:1: the first line is not that of a hand; allowed: "
                         f"{','.join(COLUMNS)}, and behind it possibly ,{','.join(LEVER_COLUMNS)}",
                         path, 1)
    for line, row in enumerate(rows[1:], 2):
        if len(row) != len(names):
            raise SetupError(f"{path}:{line}: a row of {len(row)} numbers; allowed: {len(names)}, "
                             "as the first line has names", path, line)
    try:
        return [[float(number) for number in row] for row in rows[1:]]
    except ValueError as error:
        raise SetupError(f"{path}: not a table of numbers: {error}", path) from error


def _rows_of_recording(path: str) -> list[list[float]]:
    """What the first operator did: his rates, and his lever."""
    try:
        messages = _repel._read_mcap(path, ["/inputs"])["messages"].get("/inputs", [])
        rows = []
        for _, _, text in messages:
            tick = json.loads(text)
            arm = tick["arms"][0]
            rows.append([tick["time_s"], *arm["linear"], *arm["angular"], arm["lever_rate"],
                         *arm["direction"]])
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise SetupError(f"{path}: this is not a run of repel: {error}", path) from error
    if not rows:
        raise SetupError(f"{path}: has no tick of an operator; allowed: a recording that has", path)
    return rows


def write_table(rows: np.ndarray | tuple[tuple[float, ...], ...], path: str) -> None:
    """Writes the rows for `teleop run --hand`, every number to its last bit. Raises NotWritten."""
    width = len(rows[0]) if len(rows) > 0 else len(COLUMNS)
    lines = [(COLUMNS + LEVER_COLUMNS)[:width], *([repr(float(x)) for x in row] for row in rows)]
    with whole(Path(path)) as file:
        file.write("".join(",".join(line) + "\n" for line in lines).encode())
