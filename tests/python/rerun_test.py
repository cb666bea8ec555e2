# SPDX-License-Identifier: BSD-3-Clause
"""Recordings and cells in Rerun, read back from its files."""

import json
import sys

import numpy as np
import pytest

import repel
from gantry import gantry_cell


def test_says_how_to_have_rerun(monkeypatch):
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(repel.SetupError, match=r"pip install 'repel-haptics\[rerun\]'"):
        repel.rerun(gantry_cell(), save="none.rrd")


try:
    import rerun as rr
    from rerun.chunk import RrdReader
except ImportError:
    rr = None
with_rerun = pytest.mark.skipif(rr is None, reason="no rerun-sdk 0.41: pip install '.[rerun]'")
with_recordings = pytest.mark.skipif(not hasattr(repel._repel, "_read_mcap") or
                                     not hasattr(repel._repel, "run_scene"),
                                     reason="built without recordings or runs")


class Logged:
    """What a file has: of each entity the rows in the order of ticks."""

    def __init__(self, file):
        self.rows = {}
        for chunk in RrdReader(str(file)).stream():
            for row in chunk.to_record_batch().to_pylist():
                self.rows.setdefault(chunk.entity_path.replace("\\", ""), []).append(row)
        for rows in self.rows.values():
            rows.sort(key=lambda row: row.get("tick") or 0)

    def __getitem__(self, path):
        return self.rows[path]

    def under(self, path):
        return {name for name in self.rows if name.startswith(path)}

    def ticks(self, path):
        return [row["tick"] for row in self[path]]

    def seconds(self, path):
        return [row["time"].total_seconds() for row in self[path]]

    def plot(self, name):
        return np.array([row["Scalars:scalars"][0] for row in self[f"/plots/{name}"]])


def recorded(scene, seconds, folder):
    file = folder / "run.mcap"
    assert repel.run(scene, seconds=seconds, log=file)["exit_status"] == 0
    messages = repel._repel._read_mcap(str(file), ["/separations", "/poses", "/bodies", "/log",
                                                  "/contacts", "/cameras/"])["messages"]
    told = {topic: [(tick, json.loads(data)) for _, tick, data in of_topic]
            for topic, of_topic in messages.items()}
    repel.rerun(file, save=folder / "run.rrd")
    return repel.read_recording(file), told, Logged(folder / "run.rrd")


@with_rerun
@with_recordings
def test_has_every_column_pair_pose_and_event_of_a_recording(tmp_path):
    run, told, logged = recorded("anderson_4x8", 6.0, tmp_path)
    plots = {path.rpartition("/")[2]: path.removeprefix("/plots/")
             for path in logged.under("/plots/")}
    numbers = {name for name, column in run.items() if column.dtype.kind in "if"}
    assert set(plots) == numbers - {"tick", "time_s"} | {"virtual_n"}
    for name in set(plots) - {"virtual_n"}:
        assert np.array_equal(logged.plot(plots[name]), run[name], equal_nan=True), name
    assert plots["nearest_m"] == "distance/nearest_m" and plots["q1_rad"].startswith("joints/pos")
    path = "/plots/force/virtual_n"
    assert logged.ticks(path) == list(run["tick"])
    assert logged.seconds(path) == pytest.approx(run["time_s"], abs=1e-6)
    force = np.linalg.norm([run[f"virtual_f{axis}_n"] for axis in "xyz"], axis=0)
    assert logged.plot("force/virtual_n") == pytest.approx(force) and force.max() > 10.0

    pushes = 0
    for row, arrows, (tick, message) in zip(logged["/world/pairs"], logged["/world/forces"],
                                            told["/separations"], strict=True):
        pairs = message["pairs"]
        assert row["tick"] == arrows["tick"] == tick
        strips = np.array(row["LineStrips3D:strips"] or []).reshape(-1, 2, 3)
        assert len(strips) == len(pairs)
        for strip, vector, pair in zip(strips, arrows["Arrows3D:vectors"] or [], pairs):
            assert strip == pytest.approx(np.array([pair["a"], pair["b"]]), abs=1e-6)
            assert vector == pytest.approx(0.002 * pair["force"] * np.array(pair["extraction"]),
                                           abs=1e-6)
            pushes += pair["force"] > 0.0
    assert pushes > 100
    sums = {row["tick"]: row["Arrows3D:vectors"] for row in logged["/world/force on tools"]}
    assert len(sums) == len(told["/contacts"])
    for tick, vectors in sums.items():
        fx, fy, fz = (run[f"virtual_f{axis}_n"][tick] for axis in "xyz")
        assert np.ravel(vectors) == pytest.approx([0.002 * f for f in (fx, fy, fz)]
                                                  if force[tick] > 0 else [], abs=2e-6)

    poses = {each["child_frame_id"]: each for each in told["/poses"][-1][1]["transforms"]}
    for frame, pose in poses.items():
        last = logged[f"/world/bodies/{frame}"][-1]
        assert last["Transform3D:translation"][0] == pytest.approx(
            [pose["translation"][axis] for axis in "xyz"], abs=1e-6)
        assert last["Transform3D:quaternion"][0] == pytest.approx(
            [pose["rotation"][axis] for axis in "xyzw"], abs=1e-6)
    for entity in told["/bodies"][0][1]["entities"]:
        (mesh,) = logged[f"/world/bodies/{entity['frame_id']}/{entity['id']}"]
        triangles = entity["triangles"][0]
        assert len(mesh["Mesh3D:vertex_positions"]) == len(triangles["indices"])
        if entity["frame_id"] == "world":  # in the body: where the wall stands
            corners = np.array(mesh["Mesh3D:vertex_positions"])
            middle = [triangles["pose"]["position"][axis] for axis in "xyz"]
            assert (corners.min(axis=0) <= np.array(middle) + 1e-6).all()
            assert (corners.max(axis=0) >= np.array(middle) - 1e-6).all()
    texts = [row["TextLog:text"][0] for row in logged["/log"]]
    assert sorted(texts) == sorted(f"{m['name']}: {m['message']}" for _, m in told["/log"])
    levels = {row["TextLog:level"][0] for row in logged["/log"]}
    assert "INFO" in levels and levels <= {"INFO", "WARN", "ERROR"}


@with_rerun
@with_recordings
def test_shows_parts_that_come_and_go_and_what_cameras_see(tmp_path):
    _, told, logged = recorded("seen", 1.0, tmp_path)
    images = logged["/cameras/camera"]
    assert [row["tick"] for row in images] == [tick for tick, _ in told["/cameras/camera"]]
    assert len(images) >= 29
    there = {}  # by path, what is shown last
    for path in logged.under("/world/bodies/"):
        for row in logged[path]:
            if row.get("Mesh3D:vertex_positions"):
                there[path] = True
            elif row.get("Clear:is_recursive") is not None:
                there[path] = False
    last = {f"/world/bodies/{each['frame_id']}/{each['id']}"
            for each in told["/bodies"][-1][1]["entities"]}
    assert {path for path, is_there in there.items() if is_there} == last
    assert not all(there.values())


@with_rerun
def test_shows_a_cell_as_of_its_last_tick(tmp_path):
    bottle = repel.Loose("bottle", repel.Shape.sphere(0.05), ([-0.3, 0, 0], [1, 0, 0, 0]))
    cell = gantry_cell(loose=[bottle])
    with repel.rerun(cell, save=tmp_path / "cell.rrd") as log:
        with pytest.raises(repel.SetupError, match="log comes after a tick"):
            log.log()
        ticks = []
        for k in range(600):
            if k == 100:
                cell.add("bottle")
            if k == 400:
                cell.remove("bottle", over=0.1)
            ticks.append(cell.step([0.19, 0, 0], np.zeros(3), repel.Command()))
            log.log(compute=1e-4)
    logged = Logged(tmp_path / "cell.rrd")
    for name, value in (("distance/nearest_m", lambda t: t.nearest),
                        ("force/virtual_n", lambda t: np.linalg.norm(t.virtual_force[:3])),
                        ("joints/position/q1", lambda t: t.q[0]),
                        ("joints/effort/tau3", lambda t: t.torques[2]),
                        ("timing/compute_us", lambda t: 100.0)):
        assert logged.plot(name) == pytest.approx([value(tick) for tick in ticks]), name
        assert logged.ticks(f"/plots/{name}") == [tick.tick for tick in ticks]
    assert logged.seconds("/world/pairs") == pytest.approx([t.time for t in ticks], abs=1e-6)
    strips = np.array(logged["/world/pairs"][0]["LineStrips3D:strips"])
    lengths = np.linalg.norm(strips[:, 1] - strips[:, 0], axis=1)
    assert lengths.min() == pytest.approx(ticks[0].nearest, abs=1e-6)
    force = 0.002 * ticks[0].virtual_force[:3]
    assert np.abs(force).max() > 1e-4, "the wall should push"
    assert logged["/world/force on tools"][0]["Arrows3D:vectors"][0] == pytest.approx(force,
                                                                                     abs=1e-6)
    (wall,) = (logged[path] for path in logged.under("/world/bodies/") if path.endswith("/wall"))
    corners = np.array(wall[0]["Mesh3D:vertex_positions"])
    assert corners.min(axis=0) == pytest.approx([0.25, -1, -1], abs=1e-6)
    assert corners.max(axis=0) == pytest.approx([0.45, 1, 1], abs=1e-6)
    (path,) = (path for path in logged.under("/world/bodies/bottle/"))
    assert 100 <= logged[path][0]["tick"] <= 102
    cleared = [row for row in logged["/world/bodies/bottle"] if row.get("Clear:is_recursive")]
    assert len(cleared) == 1 and cleared[0]["tick"] > 400
    texts = [row["TextLog:text"][0] for row in logged["/log"]]
    assert "arm: frozen_joints" in texts and "arm: braking" in texts  # it is pushed, yet stands


@with_rerun
@with_recordings
def test_opens_the_viewer(tmp_path, monkeypatch):
    file, spawned = tmp_path / "run.mcap", []
    monkeypatch.setattr(rr.RecordingStream, "spawn", lambda self, **how: spawned.append(how))
    repel.run("empty", seconds=0.1, log=file)
    repel.rerun(repel.read_recording(file), spawn=True)
    assert list(spawned[0]) == ["default_blueprint"]


@with_rerun
def test_takes_a_stream_and_refuses_what_it_cannot_show(tmp_path):
    cell = gantry_cell()
    stream = rr.RecordingStream("own")
    stream.save(str(tmp_path / "own.rrd"))
    log = repel.rerun(cell, stream=stream)
    cell.step(np.zeros(3), np.zeros(3), repel.Command())
    log.log()
    log.close()
    stream.log("mine", rr.TextLog("still open"))
    stream.disconnect()
    logged = Logged(tmp_path / "own.rrd")
    assert logged["/mine"] and logged["/world/pairs"]
    for where in ({}, {"save": "a.rrd", "spawn": True}):
        with pytest.raises(repel.SetupError, match="one of save=FILE.rrd, spawn=True, stream="):
            repel.rerun(cell, **where)
    with pytest.raises(repel.SetupError, match="cannot be written"):
        repel.rerun(cell, save=tmp_path / "none" / "a.rrd")
    table = tmp_path / "run.csv"
    table.write_text("tick,time_s\n0,0\n")
    with pytest.raises(repel.SetupError, match="a table has no bodies to show"):
        repel.rerun(table, save=tmp_path / "a.rrd")
