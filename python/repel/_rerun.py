# SPDX-License-Identifier: BSD-3-Clause
"""Recordings and cells in the viewer Rerun."""

from __future__ import annotations

import base64
import json
import os
import re
from collections.abc import Iterable, Sequence
from typing import Any, overload

import numpy as np

from . import _repel
from ._errors import SetupError, needed
from .recording import Recording, read_recording

_TOPICS = ["/poses", "/bodies", "/separations", "/contacts", "/log", "/cameras/"]
#: [m/N] of arrows, as in a recording.
_ARROW = 0.002
_COLOURS = {"tool": (74, 97, 120, 255), "link": (194, 199, 209, 255),
            "obstacle": (227, 217, 194, 255), "passable": (128, 105, 194, 87)}
_PUSHES, _NEAR, _SUM = (217, 51, 38), (120, 160, 120), (10, 97, 196)
_LEVELS = {1: "DEBUG", 2: "INFO", 3: "WARN", 4: "ERROR", 5: "CRITICAL"}
#: Where a column is plotted, by its name; of the others, under `state`.
_PLOTS = ((r"nearest_m|hold_margin_m", "distance"), (r"energy_.*", "energy"),
          (r"(hardest|held|virtual|virtual_f.|coupling_f.)_n", "force"),
          (r"virtual_t._nm|lever_torque_nm", "torque"), (r"(compute|late)_us", "timing"),
          (r"q\d+(_.*)?", "joints/position"), (r"v\d+(_.*)?", "joints/rate"),
          (r"tau\d+(_.*)?", "joints/effort"))


@overload
def rerun(source: _repel.Cell, *, save: str | os.PathLike[str] | None = None, spawn: bool = False,
          stream: Any = None) -> CellLog: ...


@overload
def rerun(source: Recording | str | os.PathLike[str], *,
          save: str | os.PathLike[str] | None = None, spawn: bool = False,
          stream: Any = None) -> None: ...


def rerun(source: Any, *, save: str | os.PathLike[str] | None = None, spawn: bool = False,
          stream: Any = None) -> CellLog | None:
    """Logs a recording, or a Cell while your program ticks it, to Rerun (docs/recording.md).

    source: what read_recording gave of an .mcap file, or the path of one: all of it is logged. Or
    a Cell: returns a CellLog, whose `log` you call after a tick. One of: save, an .rrd file to
    write; spawn, which opens the viewer; stream, a rerun.RecordingStream of your own.

    Raises SetupError if rerun-sdk is not installed, or the recording has no bodies (a CSV log).
    """
    rr = needed("rerun", "rerun-sdk", extra="rerun")
    if (save is not None) + bool(spawn) + (stream is not None) != 1:
        raise SetupError("rerun: where to? allowed: one of save=FILE.rrd, spawn=True, stream=")
    if isinstance(source, _repel.Cell):
        return CellLog(rr, source, _Sink(rr, "repel cell", save, stream))
    recording = source if isinstance(source, Recording) else read_recording(source)
    if "repel run" not in recording.metadata:
        raise SetupError(f"{recording.file}: a table has no bodies to show; allowed: a recording, "
                         "as of --log FILE.mcap", recording.file)
    scene = os.path.basename(recording.metadata["repel run"].get("scene", ""))
    with _Sink(rr, f"repel {scene.removesuffix('.yaml')}", save, stream) as sink:
        _Player(rr, sink.stream).play(recording)
    return None


class _Sink:
    """Where it goes: a stream of our own, which ends with us, or that of the caller."""

    def __init__(self, rr: Any, name: str, save: str | os.PathLike[str] | None, stream: Any):
        self._owns = stream is None
        self.stream = rr.RecordingStream(name) if stream is None else stream
        if self._owns:  # no third timeline, of when it was logged
            self.stream.set_log_time_enabled(False)
        if save is not None:
            try:
                self.stream.save(os.fspath(save), default_blueprint=_blueprint())
            except (OSError, RuntimeError) as error:
                raise SetupError(f"{os.fspath(save)}: cannot be written: {error}",
                                 os.fspath(save)) from error
        elif self._owns:
            self.stream.spawn(default_blueprint=_blueprint())

    def __enter__(self) -> _Sink:
        return self

    def __exit__(self, *args: object) -> None:
        self.stream.flush()
        if self._owns:
            self.stream.disconnect()


def _blueprint() -> Any:
    views: Any = needed("rerun.blueprint", "rerun-sdk", extra="rerun")

    def plot(origin: str, name: str) -> Any:
        return views.TimeSeriesView(origin=f"plots/{origin}", name=name)
    scene = views.Vertical(views.Spatial3DView(origin="world", name="Scene"),
                           views.TextLogView(origin="log", name="Log"), row_shares=[3, 1])
    joints = [plot(f"joints/{kind}", f"Joints: {kind}") for kind in ("position", "rate", "effort")]
    plots = views.Vertical(
        plot("distance", "Distance [m]"), plot("force", "Force [N]"), plot("timing", "Timing [us]"),
        views.Tabs(*joints, plot("torque", "Torque [N m]"), plot("energy", "Energy [J]"),
                   plot("state", "State"), views.Spatial2DView(origin="cameras", name="Cameras")))
    return views.Blueprint(views.Horizontal(scene, plots, column_shares=[3, 2]))


def _plot_path(name: str) -> list[str]:
    """Of a column: those of a partner begin with its name."""
    arm, _, last = name.rpartition("/")
    group = next((to for pattern, to in _PLOTS if re.fullmatch(pattern, last)), "state")
    return ["plots", *group.split("/"), *([arm] if arm else []), last]


def _told_apart(names: Sequence[str]) -> list[str]:
    """Repeated ones with a number."""
    apart: list[str] = []
    for name in names:
        own, count = name, 1
        while own in apart:
            count += 1
            own = f"{name} #{count}"
        apart.append(own)
    return apart


def _rotation(q: Any) -> np.ndarray:
    """Of a unit quaternion x y z w."""
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def _mesh(rr: Any, vertices: np.ndarray, triangles: np.ndarray, colour: Sequence[int]) -> Any:
    """Faces that meet in edges: each corner has the normal of its triangle."""
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return rr.Mesh3D(vertex_positions=corners.reshape(-1, 3),
                     vertex_normals=np.repeat(normals, 3, axis=0), albedo_factor=colour)


def _xyz(value: dict[str, float]) -> list[float]:
    return [value["x"], value["y"], value["z"]]


def _xyzw(value: dict[str, float]) -> list[float]:
    return [value["x"], value["y"], value["z"], value["w"]]


class _Player:
    """Logs a recording, each channel by columns."""

    def __init__(self, rr: Any, stream: Any):
        self._rr = rr
        self._stream = stream
        self._begin_ns = 0

    def play(self, recording: Recording) -> None:
        contents = _repel._read_mcap(recording.file, ["/inputs", *_TOPICS])
        messages = {topic: [(tick, ns, data) for ns, tick, data in of_topic]
                    for topic, of_topic in contents["messages"].items()}
        if messages.get("/inputs"):
            tick, ns, data = messages["/inputs"][0]
            self._begin_ns = ns - round(1e9 * json.loads(data)["time_s"])
        self._stream.log("world", self._rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._plots(recording)
        for topic, show in (("/poses", self._poses), ("/bodies", self._bodies),
                            ("/separations", self._pairs), ("/contacts", self._sums),
                            ("/log", self._log)):
            show([(tick, ns, json.loads(data)) for tick, ns, data in messages.get(topic, [])])
        for topic, of_topic in messages.items():
            if topic.startswith("/cameras/"):
                self._images(topic.removeprefix("/cameras/"), of_topic)

    def _path(self, *names: str) -> str:
        path: str = self._rr.new_entity_path(list(names))
        return path

    def _send(self, path: str, ticks: Any, seconds: Any, columns: Any) -> None:
        self._rr.send_columns(path, [self._rr.TimeColumn("tick", sequence=np.asarray(ticks)),
                                     self._rr.TimeColumn("time", duration=np.asarray(seconds))],
                              columns, recording=self._stream)

    def _seconds(self, ns: Iterable[int]) -> np.ndarray:
        return 1e-9 * (np.array(list(ns), np.int64) - self._begin_ns)

    def _send_rows(self, path: str, rows: Sequence[tuple[int, int, Any]], columns: Any) -> None:
        self._send(path, [tick for tick, _, _ in rows], self._seconds(ns for _, ns, _ in rows),
                   columns)

    def _plots(self, recording: Recording) -> None:
        ticks, seconds = recording["tick"], recording["time_s"]
        columns = {name: column for name, column in recording.items()
                   if column.dtype.kind in "if" and name not in ("tick", "time_s")}
        for name in recording:
            if name.endswith("virtual_fx_n"):
                arm = name.removesuffix("fx_n")
                columns[f"{arm}n"] = np.linalg.norm(
                    [recording[f"{arm}f{axis}_n"] for axis in "xyz"], axis=0)
        for name, column in columns.items():
            self._send(self._path(*_plot_path(name)), ticks, seconds,
                       self._rr.Scalars.columns(scalars=column))

    def _poses(self, rows: list[tuple[int, int, Any]]) -> None:
        by_frame: dict[str, list[tuple[int, int, Any]]] = {}
        for tick, ns, message in rows:
            for each in message["transforms"]:
                own = by_frame.setdefault(each["child_frame_id"], [])
                stood = own and all(own[-1][2][key] == each[key] for key in ("translation",
                                                                             "rotation"))
                if not stood:
                    own.append((tick, ns, each))
        for frame, own in by_frame.items():
            columns = self._rr.Transform3D.columns(
                translation=[_xyz(each["translation"]) for _, _, each in own],
                quaternion=[_xyzw(each["rotation"]) for _, _, each in own])
            self._send_rows(self._path("world", "bodies", frame), own, columns)

    def _bodies(self, rows: list[tuple[int, int, Any]]) -> None:
        """Each message has all that is there: what it has no more is gone."""
        shown: dict[str, Any] = {}
        for tick, ns, message in rows:
            self._stream.set_time("tick", sequence=tick)
            self._stream.set_time("time", duration=float(self._seconds([ns])[0]))
            now = {self._path("world", "bodies", each["frame_id"], each["id"]): each["triangles"]
                   for each in message["entities"]}
            for path in shown.keys() - now.keys():
                self._stream.log(path, self._rr.Clear(recursive=False))
            for path, (drawn,) in now.items():
                if shown.get(path) == [drawn]:
                    continue
                pose = drawn["pose"]
                points = np.array([_xyz(point) for point in drawn["points"]])
                points = points @ _rotation(_xyzw(pose["orientation"])).T + _xyz(pose["position"])
                colour = [round(255 * drawn["color"][part]) for part in "rgba"]
                triangles = np.array(drawn["indices"], int).reshape(-1, 3)
                self._stream.log(path, _mesh(self._rr, points, triangles, colour))
            shown = now
        self._stream.reset_time()

    def _pairs(self, rows: list[tuple[int, int, Any]]) -> None:
        pairs = [pair for _, _, message in rows for pair in message["pairs"]]
        if not pairs:
            return
        counts = [len(message["pairs"]) for _, _, message in rows]
        forces = np.array([pair["force"] for pair in pairs])
        begins = np.array([pair["a"] for pair in pairs])
        strips = np.stack([begins, [pair["b"] for pair in pairs]], axis=1)
        colours = np.where((forces > 0.0)[:, None], _PUSHES, _NEAR).astype(np.uint8)
        self._send_rows(self._path("world", "pairs"), rows, self._rr.LineStrips3D.columns(
            strips=strips, colors=colours).partition(counts))
        vectors = _ARROW * forces[:, None] * [pair["extraction"] for pair in pairs]
        self._send_rows(self._path("world", "forces"), rows, self._rr.Arrows3D.columns(
            vectors=vectors, origins=begins,
            colors=np.tile(np.array(_PUSHES, np.uint8), (len(pairs), 1))).partition(counts))

    def _sums(self, rows: list[tuple[int, int, Any]]) -> None:
        """The force on each tool, from where /contacts has it."""
        arrows = [[each["arrows"][0] for each in message["entities"]
                   if each["id"].startswith("force on ") and each["arrows"]]
                  for _, _, message in rows]
        flat = [arrow for of_row in arrows for arrow in of_row]
        if not flat:
            return
        turns = [_rotation(_xyzw(arrow["pose"]["orientation"]))[:, 0] for arrow in flat]
        lengths = np.array([arrow["shaft_length"] + arrow["head_length"] for arrow in flat])
        self._send_rows(self._path("world", "force on tools"), rows, self._rr.Arrows3D.columns(
            vectors=lengths[:, None] * turns,
            origins=[_xyz(arrow["pose"]["position"]) for arrow in flat],
            colors=np.tile(np.array(_SUM, np.uint8), (len(flat), 1))).partition(
                [len(of_row) for of_row in arrows]))

    def _log(self, rows: list[tuple[int, int, Any]]) -> None:
        if rows:
            self._send_rows("log", rows, self._rr.TextLog.columns(
                text=[f"{message['name']}: {message['message']}" for _, _, message in rows],
                level=[_LEVELS[message["level"]] for _, _, message in rows]))

    def _images(self, camera: str, rows: list[tuple[int, int, bytes]]) -> None:
        for tick, ns, data in rows:
            image = json.loads(data)
            depth = np.frombuffer(base64.b64decode(image["data"]), "<u2")
            self._stream.set_time("tick", sequence=tick)
            self._stream.set_time("time", duration=float(self._seconds([ns])[0]))
            self._stream.log(self._path("cameras", camera), self._rr.DepthImage(
                depth.reshape(image["height"], image["width"]), meter=1000.0))
        self._stream.reset_time()


class CellLog:
    """Logs a Cell to Rerun as of its last tick. A context manager: its end completes the file."""

    def __init__(self, rr: Any, cell: _repel.Cell, sink: _Sink):
        self._rr = rr
        self._cell = cell
        self._sink = sink
        self._bodies = [rr.new_entity_path(["world", "bodies", name])
                        for name in _told_apart(cell._bodies())]
        self._there: list[int] = [0] * len(self._bodies)
        self._states: list[tuple[str, ...]] = [()] * cell.arm_count
        self._stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)

    @property
    def _stream(self) -> Any:
        return self._sink.stream

    def log(self, compute: float | None = None) -> None:
        """After a tick: logs it. compute [s] that it took. Raises SetupError before the first."""
        picture = self._cell._picture()
        first = picture["ticks"][0]
        self._stream.set_time("tick", sequence=first.tick)
        self._stream.set_time("time", duration=first.time)
        self._show_bodies(picture)
        begins, forces = picture["a"], picture["forces"]
        pushes = np.any(forces != 0.0, axis=1)
        self._stream.log("world/pairs", self._rr.LineStrips3D(
            np.stack([begins, picture["b"]], axis=1),
            colors=np.where(pushes[:, None], _PUSHES, _NEAR).astype(np.uint8)))
        self._stream.log("world/forces", self._rr.Arrows3D(
            origins=begins[pushes], vectors=_ARROW * forces[pushes], colors=_PUSHES))
        self._stream.log(self._rr.new_entity_path(["world", "force on tools"]), self._rr.Arrows3D(
            origins=[tick.p_WT for tick in picture["ticks"]],
            vectors=[_ARROW * tick.virtual_force[:3] for tick in picture["ticks"]], colors=_SUM))
        self._plot("nearest_m", first.nearest)
        self._plot("hardest_n", first.peak_force)
        if compute is not None:
            self._plot("compute_us", 1e6 * compute)
        for arm, tick in enumerate(picture["ticks"]):
            self._show_arm(arm, tick)

    def _plot(self, name: str, value: float) -> None:
        self._stream.log(self._rr.new_entity_path(_plot_path(name)), self._rr.Scalars(value))

    def _show_bodies(self, picture: dict[str, Any]) -> None:
        there = picture["is_there"]
        come = {body for body, now in enumerate(there) if now and not self._there[body]}
        for body, path in enumerate(self._bodies):
            if there[body]:
                X = picture["X_WB"][body]
                self._stream.log(path, self._rr.Transform3D(translation=X[:3, 3],
                                                            mat3x3=X[:3, :3]))
            elif self._there[body]:
                self._stream.log(path, self._rr.Clear(recursive=True))
        self._there = there
        if not come:
            return
        parts = self._cell._parts()
        for part, name in zip(parts, _told_apart([part["name"] for part in parts])):
            if part["body"] not in come:
                continue
            vertices, triangles = part["shape"].mesh()
            X_BP = part["X_BP"]
            group = "passable" if part["passable"] else part["group"]
            self._stream.log(
                f"{self._bodies[part['body']]}/{self._rr.escape_entity_path_part(name)}",
                _mesh(self._rr, vertices @ X_BP[:3, :3].T + X_BP[:3, 3], triangles,
                      _COLOURS[group]))

    def _show_arm(self, arm: int, tick: _repel.Tick) -> None:
        prefix = f"arm{arm}/" if arm else ""
        self._plot(f"{prefix}virtual_n", float(np.linalg.norm(tick.virtual_force[:3])))
        self._plot(f"{prefix}held_n", tick.held_force)
        for name, values in (("q", tick.q), ("v", tick.v), ("tau", tick.torques)):
            for joint, value in enumerate(values):
                self._plot(f"{prefix}{name}{joint + 1}", value)
        for module, energy in tick.energy.items():
            self._plot(f"{prefix}energy_{module}_j", energy)
        before, now = self._states[arm], (*tick.status, *([tick.stop] * (tick.stop != "running")))
        name = f"arm {arm}" if arm else "arm"
        for state in now:
            if state not in before:
                self._stream.log("log", self._rr.TextLog(f"{name}: {state}", level="WARN"))
        for state in before:
            if state not in now:
                self._stream.log("log", self._rr.TextLog(f"{name}: {state} is over", level="INFO"))
        self._states[arm] = now

    def close(self) -> None:
        """Completes what was logged, and the file of `save`."""
        self._sink.__exit__()

    def __enter__(self) -> CellLog:
        return self

    def __exit__(self, *args: object) -> None:
        self.close()
