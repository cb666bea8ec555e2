# SPDX-License-Identifier: BSD-3-Clause
"""Reads what a run has logged: recordings and CSV files."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np

from . import _repel
from ._errors import SetupError, needed

_TOPICS = ("/inputs", "/forces", "/separations", "/energy", "/timing")
#: The messages of a topic, in their order.
_Rows = list[dict[str, Any]]


class Recording(Mapping[str, np.ndarray]):
    """The columns of a run by name, each an array with an entry for each tick.

    Names and units are those of the columns of `--log FILE.csv` (docs/recording.md): `time_s`,
    `tau1_nm`, ... `metadata` and `attachments` (bytes) are those of a recording; `trouble` says why
    the file is incomplete, and is empty if it is not.
    """

    def __init__(self, columns: dict[str, np.ndarray], *, file: str = "",
                 metadata: dict[str, dict[str, str]] | None = None,
                 attachments: dict[str, bytes] | None = None, trouble: str = ""):
        self._columns = columns
        self.file = file
        self.metadata = metadata or {}
        self.attachments = attachments or {}
        self.trouble = trouble

    def __getitem__(self, name: str) -> np.ndarray:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def ticks(self) -> int:
        """The number of ticks."""
        return len(self["tick"])

    def to_numpy(self) -> np.ndarray:
        """One structured array, with a field for each column."""
        table = np.empty(self.ticks, [(name, column.dtype) for name, column in self.items()])
        for name, column in self.items():
            table[name] = column
        return table

    def to_pandas(self) -> Any:
        """A pandas.DataFrame."""
        pandas = needed("pandas", extra="tables")
        return pandas.DataFrame(self._columns)

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Writes a Parquet file with a column for each."""
        arrow = needed("pyarrow", extra="tables")
        parquet = needed("pyarrow.parquet", "pyarrow", extra="tables")
        parquet.write_table(arrow.table(self._columns), os.fspath(path))

    def __repr__(self) -> str:
        return f"<repel.Recording of {self.ticks} ticks, {len(self)} columns>"


def read_recording(path: str | os.PathLike[str]) -> Recording:
    """Reads the file that `--log` wrote: a recording if its name ends in .mcap, else CSV.

    Of a truncated recording, every complete tick. Raises SetupError for a file that is neither.
    """
    file = os.fspath(path)
    return _from_mcap(file) if file.endswith((".mcap", ".mcap.part")) else _from_csv(file)


def _from_csv(file: str) -> Recording:
    try:
        with open(file, newline="", encoding="utf-8") as lines:
            rows = csv.reader(lines)
            names = next(rows, [])
            if names[:2] != ["tick", "time_s"]:
                raise SetupError(f"{file}: expected the columns tick, time_s, ... of a log, "
                                 f"found {', '.join(names[:2]) or 'nothing'}", file, 1)
            values = [row for row in rows if len(row) == len(names)]
    except (OSError, UnicodeDecodeError) as error:
        raise SetupError(f"{file}: cannot be read: {error}", file) from error
    texts = zip(*values) if values else [() for _ in names]
    try:
        columns = {name: _column(name, text) for name, text in zip(names, texts)}
    except ValueError as error:
        raise SetupError(f"{file}: a column is not of numbers: {error}", file) from error
    return Recording(columns, file=file)


_WHOLE = ("tick", "phase", "status", "brakes", "pairs_near", "pairs_evaluated", "pairs_stale",
          "oldest_age_ticks")
_TEXT = ("hardest_pair", "stop")


def _column(name: str, values: Any) -> np.ndarray:
    """With the type that its name tells; a number that does not exist is an empty cell."""
    last = name.rpartition("/")[2]
    if last in _TEXT:
        return np.array(values, dtype=str)
    if last in _WHOLE:
        return np.array(values, dtype=np.int64)
    return np.array([text or "nan" for text in values], dtype=np.float64)


def _from_mcap(file: str) -> Recording:
    if not hasattr(_repel, "_read_mcap"):
        raise SetupError("repel was built without its part record")
    contents = _repel._read_mcap(file, [*_TOPICS, "/poses"])
    try:
        columns = _from_contents(contents)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        raise SetupError(f"{file}: this is not a run of repel: {error}", file) from error
    return Recording(columns, file=file, metadata=contents["metadata"],
                     attachments=contents["attachments"], trouble=contents["trouble"])


def _from_contents(contents: dict[str, Any]) -> dict[str, np.ndarray]:
    messages = {topic: [json.loads(data) for _, _, data in contents["messages"].get(topic, [])]
                for topic in _TOPICS}
    poses = contents["messages"].get("/poses", [])[:1]  # for the names of the bodies
    messages["/poses"] = [json.loads(data) for _, _, data in poses]
    # Of a file that is cut off, the last tick may lack some of its messages.
    topics = [messages[topic] for topic in ("/inputs", "/forces", "/separations")]
    ticks = min(len(topic) for topic in topics)
    if ticks == 0:
        raise ValueError("there is no whole tick in the topics /inputs, /forces and /separations")
    inputs, forces, separations = (topic[:ticks] for topic in topics)
    columns = _of_ticks(inputs, separations)
    timing = messages["/timing"][:ticks]
    if len(timing) == ticks:
        for name in ("compute_us", "late_us"):
            columns[name] = np.array([row[name] for row in timing], float)
    for arm, prefix in enumerate(_arm_names(messages, len(inputs[0]["arms"]))):
        kinds = _joint_types(contents["attachments"].get(f"robot {arm}.urdf"),
                             len(inputs[0]["arms"][arm]["q"]))
        columns.update(_of_arm([row["arms"][arm] for row in inputs],
                               [row["arms"][arm] for row in forces], prefix, kinds))
    columns.update(_of_energy(messages["/energy"][:ticks], ticks))
    return columns


def _of_ticks(inputs: _Rows, separations: _Rows) -> dict[str, np.ndarray]:
    nearest = [row.get("nearest_m") for row in separations]  # left out, in older ones null: none
    hardest = [max(row["pairs"], key=lambda pair: (pair["force"], -pair["index"]), default=None)
               for row in separations]
    pushed = [pair if pair and pair["force"] > 0.0 else None for pair in hardest]
    return {
        "tick": np.array([row["tick"] for row in inputs], np.int64),
        "time_s": np.array([row["time_s"] for row in inputs], float),
        "nearest_m": np.array([np.nan if n is None else n for n in nearest], float),
        "hardest_pair": np.array([pair["pair"] if pair else "" for pair in pushed], str),
        "hardest_n": np.array([pair["force"] if pair else 0.0 for pair in pushed], float),
        "pairs_near": np.array([row["near"] for row in separations], np.int64),
        "pairs_evaluated": np.array([row["evaluated"] for row in separations], np.int64),
    }


def _arm_names(messages: dict[str, _Rows], arms: int) -> list[str]:
    """The prefixes of the columns of the arms, in their order; that of the first is empty."""
    energy, poses = messages["/energy"], messages["/poses"]
    modules = energy[0]["energy_j"] if energy else {}
    found = {name.rpartition("/")[0] for name in modules} - {""}
    if len(found) != arms - 1:
        return ["", *(f"arm{i}/" for i in range(1, arms))]
    # The ledgers are sorted by name; bodies stand in the order of the arms.
    bodies = [each["child_frame_id"] for each in poses[0]["transforms"]] if poses else []
    order = [body.rpartition("/")[0] for body in bodies]
    partners = sorted(found, key=lambda name: order.index(name) if name in order else len(order))
    return ["", *(name + "/" for name in partners)]


def _joint_types(urdf: bytes | None, joints: int) -> list[str] | None:
    """Of the chain of so many joints in a robot description, base outward; none if it cannot be
    told, as for joints that the scene holds."""
    try:
        robot = ElementTree.fromstring(urdf or b"")
    except ElementTree.ParseError:
        return None
    children: dict[str, list[tuple[str, str]]] = {}
    for joint in robot.iter("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None:
            step = (joint.get("type", ""), child.get("link", ""))
            children.setdefault(parent.get("link", ""), []).append(step)
    tips = {link for steps in children.values() for _, link in steps}
    chains: set[tuple[str, ...]] = set()
    ends: list[tuple[str, tuple[str, ...]]] = [(link, ()) for link in children if link not in tips]
    while ends:
        link, chain = ends.pop()
        steps = children.pop(link, [])  # each once, should they form a circle
        if not steps:
            chains.add(chain)
        for kind, tip in steps:
            moves = () if kind == "fixed" else ("prismatic" if kind == "prismatic" else "revolute",)
            ends.append((tip, chain + moves))
    fitting = [chain for chain in chains if len(chain) == joints]
    return list(fitting[0]) if len(fitting) == 1 else None


def _of_arm(inputs: _Rows, forces: _Rows, prefix: str,
            kinds: list[str] | None) -> dict[str, np.ndarray]:
    columns: dict[str, np.ndarray] = {}

    def add(name: str, rows: _Rows, key: str, kind: Any = float) -> None:
        columns[prefix + name] = np.array([row[key] for row in rows], kind)

    def add_each(names: Sequence[str], rows: _Rows, key: str) -> None:
        table = np.array([row[key] for row in rows], float).reshape(len(rows), len(names))
        columns.update({prefix + name: table[:, i].copy() for i, name in enumerate(names)})

    def of_joints(name: str, revolute: str, prismatic: str) -> list[str]:
        count = len(inputs[0]["q"])
        units = [""] * count if kinds is None else [
            revolute if kind == "revolute" else prismatic for kind in kinds]
        return [f"{name}{i + 1}{unit}" for i, unit in enumerate(units)]

    add("phase", inputs, "phase", np.int64)
    add("status", inputs, "status", np.int64)
    add_each([f"virtual_f{axis}_n" for axis in "xyz"], forces, "force")
    add_each([f"virtual_t{axis}_nm" for axis in "xyz"], forces, "torque")
    add_each([f"coupling_f{axis}_n" for axis in "xyz"], forces, "coupling_force")
    add("lever_torque_nm", forces, "lever_torque")
    add("gain", forces, "gain")
    add_each(of_joints("q", "_rad", "_m"), inputs, "q")
    add_each(of_joints("v", "_rad_s", "_m_s"), inputs, "v")
    add("stop", forces, "stop", str)
    add("brakes", forces, "brakes", np.int64)
    add_each(of_joints("tau", "_nm", "_n"), forces, "torques")
    if "held_n" in forces[0]:  # older recordings do not have it
        add("held_n", forces, "held_n")
        columns[prefix + "hold_margin_m"] = np.array(  # it is where a hard wall is near
            [row.get("hold_margin_m", np.nan) for row in forces], float)
    return columns


def _of_energy(rows: _Rows, ticks: int) -> dict[str, np.ndarray]:
    if len(rows) != ticks or not rows:
        return {}
    columns = {}
    for key in rows[0]["energy_j"]:
        arm, _, module = key.rpartition("/")
        name = f"{arm}/energy_{module}_j" if arm else f"energy_{module}_j"
        columns[name] = np.array([row["energy_j"][key] for row in rows], float)
    return columns
