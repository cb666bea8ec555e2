# SPDX-License-Identifier: BSD-3-Clause
"""Scenes, runs and what they log."""

import json
import pathlib
import re
import subprocess
import sys
import threading

import numpy as np
import pytest

import repel

pytestmark = pytest.mark.skipif(not hasattr(repel, "load_scene"), reason="built without scenes")


def test_a_scene_says_what_is_in_it(scenes):
    scene = repel.load_scene(scenes / "anderson_4x8.yaml")
    assert (scene.name, scene.rate_hz, scene.arms) == ("anderson_4x8", 400.0, [""])
    assert len(scene.tool) == 4 and len(scene.obstacles) == 8
    table = scene.obstacles[0]
    assert table["name"] == "table" and table["kind"] == "box" and table["X_WP"].shape == (4, 4)
    assert table["shape"].reach > 0.1 and table["law"].range > 0.0 and not table["moves"]
    assert scene.script[0][1] > 0.0
    assert repel.load_scene(str(scenes / "two_arms.yaml")).arms == ["", "right"]


def test_faults_of_a_scene_are_refused_with_their_line(tmp_path, scenes):
    bad = tmp_path / "bad.yaml"
    text = (scenes / "anderson_4x8.yaml").read_text()
    bad.write_text(text.replace("rate: 400 Hz", "rate: fast"))
    with pytest.raises(repel.SetupError, match="rate") as refused:
        repel.load_scene(bad)
    assert refused.value.file == str(bad)
    assert text.splitlines()[refused.value.line - 1].startswith("rate: 400 Hz")
    with pytest.raises(repel.SetupError, match="cannot be opened"):
        repel.load_scene(tmp_path / "none.yaml")


def logged(cell, arm, operator, ticks):
    """The records of a scripted run, as the program makes it."""
    for _ in range(ticks):
        cell.sense([(arm.q, arm.v)])
        (tick,) = cell.act([operator.step(cell.X_WT(), cell.elapsed)])
        arm.apply(tick)
        arm.step(cell.period)
        yield tick


@pytest.mark.parametrize("backend, gravity", [("reference", True), ("ideal", False)])
def test_a_cell_runs_as_the_program_does_bit_for_bit(teleop, scenes, tmp_path, backend, gravity):
    log = tmp_path / "run.csv"
    report = repel.run("anderson_4x8", seconds=1.5, backend=backend, log=log)
    assert report["exit_status"] == 0
    run = repel.read_recording(log)
    scene = repel.load_scene(scenes / "anderson_4x8.yaml")
    cell = repel.Cell.from_scene(scene, gravity=gravity)
    ticks = list(logged(cell, repel.SimulatedArm(cell, kind=backend), scene.operator(), run.ticks))
    assert run.ticks == 600
    for i in range(6):
        assert np.array_equal(run[f"tau{i + 1}_nm"], [t.torques[i] for t in ticks])
        assert np.array_equal(run[f"q{i + 1}_rad"], [t.q[i] for t in ticks])
    nearest = np.array([t.nearest for t in ticks])
    nearest[np.isinf(nearest)] = np.nan  # an empty cell of the table: nothing is near
    assert np.array_equal(run["nearest_m"], nearest, equal_nan=True)
    assert list(run["hardest_pair"]) == [t.hardest_pair or "" for t in ticks]
    assert (run["hardest_n"] > 1.0).any()  # it touches something


def test_every_scene_makes_a_cell(scenes):
    files = sorted(scenes.glob("*.yaml"))
    assert len(files) > 10
    for file in files:
        cell = repel.Cell.from_scene(file)
        cell.sense([(cell.start(i), 0 * cell.start(i)) for i in range(cell.arm_count)])
        ticks = cell.act([repel.Command()] * cell.arm_count)
        assert [tick.stop for tick in ticks] == ["running"] * cell.arm_count, file.name


def test_a_cell_of_a_scene_takes_another_rate(scenes):
    cell = repel.Cell.from_scene(scenes / "empty.yaml", 1000.0)
    assert cell.period == pytest.approx(0.001)
    with pytest.raises(repel.SetupError, match="rate"):
        repel.Cell.from_scene(scenes / "empty.yaml", -1.0)


def test_a_run_gives_its_report(teleop, scenes):
    report = repel.run(repel.load_scene(scenes / "empty.yaml"), seconds=0.5)
    assert report["exit_status"] == 0 and report["ticks"] == 200
    again = repel.run(scenes / "empty.yaml", seconds=0.5, rate_hz=1000.0, arguments=["--threads=0"])
    assert again["ticks"] == 500


def test_a_run_is_that_of_the_program_bit_for_bit(teleop, tmp_path):
    here, child = tmp_path / "here.csv", tmp_path / "child.csv"
    report = repel.run("plates", seconds=2.0, log=here)
    assert report["exit_status"] == 0
    repel.run("plates", seconds=2.0, log=child, arguments=["--quiet"])
    assert here.read_bytes() == child.read_bytes()


# It did, to count page faults: a worker of a study had 1.4 GB of what others had but reserved.
def test_a_run_not_by_the_clock_locks_no_memory_of_the_process(scenes):
    def locked():
        status = pathlib.Path("/proc/self/status").read_text()
        return int(re.search(r"VmLck:\s+(\d+) kB", status)[1])
    before = locked()
    report = repel.run(scenes / "plates.yaml", seconds=0.1)
    assert locked() == before and report["page_faults_in_tick"] is None


def test_a_run_tells_its_ticks_and_stops_when_it_is_told_to(scenes):
    seen = []
    report = repel.run("two_arms", seconds=0.5, on_tick=seen.append)
    assert [ticks[0].tick for ticks in seen] == list(range(200)) and len(seen[0]) == 2
    assert report["ticks"] == 200 and report["exit_status"] == 0
    stop, count = threading.Event(), []

    def look(ticks):
        count.append(ticks[0].gain)
        if len(count) == 100:
            stop.set()
    repel.run(scenes / "plates.yaml", seconds=20.0, on_tick=look, stop=stop)
    assert 100 < len(count) < 1000 and count[99] == 1.0 and count[-1] == 0.0  # it faded


def test_a_callback_is_the_operator_of_a_run():
    """It drives the tool upwards, sees that, and lets go."""
    seen, up = [], repel.Command(linear=[0, 0, 0.05])

    def drive(ticks):
        seen.append(ticks[0])
        return up if len(seen) < 30 else repel.Command()
    report = repel.run("empty", seconds=1.0, on_tick=drive, every=10)
    assert report["exit_status"] == 0 and [tick.tick for tick in seen] == list(range(0, 400, 10))
    way = seen[29].p_WT - seen[1].p_WT
    assert way[2] == pytest.approx(0.05 * 280 / 400, rel=0.2) and abs(way[:2]).max() < 5e-3
    assert abs(seen[-1].v_WT).max() < 1e-3
    by_script, both = [], []
    repel.run("two_arms", seconds=0.5, on_tick=by_script.append)
    repel.run("two_arms", seconds=0.5, on_tick=lambda ticks: both.append(ticks) or [None, up])
    assert (both[-1][0].p_WT == by_script[-1][0].p_WT).all()
    assert both[-1][1].p_WT[2] > by_script[-1][1].p_WT[2] + 0.005
    for wrong in (1.0, "up", [up], [up, 1.0], [up, None, None]):
        with pytest.raises(TypeError, match="on_tick: expected None, a Command of the first arm, or "
                                            "a sequence of 2"):
            repel.run("two_arms", seconds=0.1, on_tick=lambda ticks, wrong=wrong: wrong)
    with pytest.raises(repel.SetupError, match="every is 0"):
        repel.run("empty", on_tick=drive, every=0)


def test_what_a_callback_raises_ends_the_run(scenes):
    with pytest.raises(ZeroDivisionError):
        repel.run(scenes / "empty.yaml", seconds=1e5, on_tick=lambda ticks: 1 / 0)
    with pytest.raises(repel.SetupError, match="without arguments"):
        repel.run(scenes / "empty.yaml", on_tick=print, arguments=["--quiet"])


def test_hands_that_are_no_tables_are_refused_by_name(scenes):
    if not hasattr(repel._repel, "run_scene"):
        pytest.skip("built without runs")
    with pytest.raises(TypeError, match=r"hands\[0\]: expected numbers"):
        repel.run(scenes / "empty.yaml", seconds=0.1, hands=[np.zeros(3)])
    with pytest.raises(repel.SetupError, match=r"hands\[1\]: a row of 5 numbers"):
        repel.run("two_arms", seconds=0.1, hands=[np.zeros((1, 7)), np.zeros((1, 5))])


def test_what_the_program_refuses_is_an_error(teleop, tmp_path, monkeypatch):
    with pytest.raises(repel.SetupError, match="no such scene; allowed: a file, or one of"):
        repel.run("nonesuch")
    with pytest.raises(repel.SetupError, match="--nonesuch"):
        repel.run("empty", arguments=["--nonesuch"])
    with pytest.raises(TypeError, match=r"arguments\[0\]: expected a str, got int"):
        repel.run("empty", arguments=[5])
    with pytest.raises(repel.SetupError, match="log is ''"):
        repel.run("empty", log="")
    with pytest.raises(repel.SetupError, match="backend"):
        repel.run("empty", backend="marble")
    bad = tmp_path / "bad.yaml"
    bad.write_text("rate: fast\n")
    with pytest.raises(repel.SetupError) as refused:
        repel.run(bad)
    assert refused.value.file == str(bad) and refused.value.line == 1
    monkeypatch.setenv("REPEL_TELEOP", str(bad))
    with pytest.raises(repel.SetupError, match="which is no program"):
        repel.program()
    monkeypatch.delenv("REPEL_TELEOP")
    monkeypatch.setenv("PATH", str(tmp_path))
    # As of a wheel without the program.
    monkeypatch.setitem(repel.program.__globals__, "__file__", str(tmp_path / "program.py"))
    with pytest.raises(repel.SetupError, match="the program teleop is not here"):
        repel.program()


def same(a, b):
    """Columns of a log; a number that does not exist is NaN in both."""
    return np.array_equal(a, b, equal_nan=a.dtype == np.float64)


@pytest.fixture(scope="module", params=["anderson_4x8", "two_arms", "storage_tank"])
def logs(request, teleop, tmp_path_factory):
    """The same run as CSV and as a recording."""
    folder = tmp_path_factory.mktemp(request.param)
    for name in ("run.csv", "run.mcap"):
        repel.run(request.param, seconds=2.0, log=folder / name)
    return folder / "run.csv", folder / "run.mcap"


def test_a_recording_has_the_columns_of_the_csv(logs):
    table, recording = (repel.read_recording(path) for path in logs)
    assert recording.ticks == table.ticks == 800 and recording.trouble == ""
    place = re.compile(r"(.*/)?v?[xyz]_m(_s)?$")  # a recording has no tool, but the joints
    missing = [name for name in table if name not in recording and not place.match(name)]
    assert {name.rpartition("/")[2] for name in missing} == {"pairs_stale", "oldest_age_ticks"}
    for name in table:
        if name in ("compute_us", "late_us"):  # not of a run that is not by the clock
            assert np.isnan(table[name]).all() and np.isfinite(recording[name]).all(), name
        elif name in recording:
            assert same(table[name], recording[name]), name
    assert table["status"].dtype == np.int64 and table["time_s"].dtype == np.float64
    assert "scene.yaml" in recording.attachments and "repel run" in recording.metadata


def test_a_recording_becomes_tables(logs, tmp_path):
    recording = repel.read_recording(logs[1])
    array = recording.to_numpy()
    assert array.shape == (800,) and array["time_s"][-1] == recording["time_s"][-1]
    pandas = pytest.importorskip("pandas")
    frame = recording.to_pandas()
    assert list(frame) == list(recording) and len(frame) == 800
    pytest.importorskip("pyarrow")
    recording.to_parquet(tmp_path / "run.parquet")
    assert np.array_equal(pandas.read_parquet(tmp_path / "run.parquet")["tick"], recording["tick"])


def test_without_the_packages_a_table_says_what_is_missing(logs, monkeypatch):
    recording = repel.read_recording(logs[0])
    monkeypatch.setitem(sys.modules, "pandas", None)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(repel.SetupError, match="pandas is not installed.*pip install pandas"):
        recording.to_pandas()
    with pytest.raises(repel.SetupError, match="pyarrow is not installed"):
        recording.to_parquet("run.parquet")


def test_of_a_truncated_recording_the_whole_ticks_are_read(logs, tmp_path):
    data = logs[1].read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data[:len(data) * 2 // 3])
    recording = repel.read_recording(cut)
    assert 100 < recording.ticks < 800 and "cut.mcap" in recording.trouble
    whole = repel.read_recording(logs[1])
    for name in recording:
        assert same(recording[name], whole[name][:recording.ticks]), name


def test_what_is_no_recording_is_refused(tmp_path):
    for name in ("none.csv", "none.mcap"):
        with pytest.raises(repel.SetupError, match=name):
            repel.read_recording(tmp_path / name)
    (tmp_path / "odd.csv").write_text("tick,time_s,status\n0,soon,0\n")
    with pytest.raises(repel.SetupError, match="odd.csv: a column is not of numbers"):
        repel.read_recording(tmp_path / "odd.csv")
    for name in ("bad.csv", "bad.mcap"):
        (tmp_path / name).write_bytes(b"a,b\n1,2\n")
        with pytest.raises(repel.SetupError, match=name):
            repel.read_recording(tmp_path / name)


def test_a_recording_without_a_whole_tick_is_refused(logs, tmp_path):
    data = logs[1].read_bytes()
    cut = tmp_path / "early.mcap"
    cut.write_bytes(data[:data.index(b"/inputs") + 200])
    with pytest.raises(repel.SetupError, match="early.mcap: .*no whole tick"):
        repel.read_recording(cut)


def said_by(*arguments, status=0):
    done = subprocess.run([sys.executable, "-m", "repel", *map(str, arguments)],
                          capture_output=True, text=True, check=False)
    assert done.returncode == status, done.stderr
    return done.stdout if status == 0 else done.stderr


def test_the_command_line(teleop, tmp_path):
    assert "SCENE" in said_by("run", "--help") and "view" in said_by("--help")
    assert said_by("--version").strip() == repel.__version__
    assert said_by("program").strip() == teleop
    log = tmp_path / "run.csv"
    report = json.loads(said_by("run", "--fast", "--seconds", "0.1", "--log", log, "empty", "--",
                                "--threads", "0"))
    assert report["ticks"] == 40
    assert "no such scene" in said_by("run", "nonesuch", status=1)
    assert "tau1_nm" in said_by("columns", log).split()


def test_the_view_shows_its_page(teleop, monkeypatch, capsys):
    shown = []
    monkeypatch.setattr("webbrowser.open", lambda address: shown.append(address) or True)
    assert repel.view("empty", ["--listen", "127.0.0.1:0", "--seconds", "0.2"]) == 0
    assert len(shown) == 1 and shown[0].startswith("http://127.0.0.1:")
    assert shown[0] in capsys.readouterr().out
