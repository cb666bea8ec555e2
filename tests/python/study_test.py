# SPDX-License-Identifier: BSD-3-Clause
"""Studies: what they draw, what they measure, and what they refuse."""

import json
import os
import pathlib
import pickle
import re
import resource
import shutil
import subprocess
import sys

import numpy as np
import pytest

import repel

yaml = pytest.importorskip("yaml")
pytest.importorskip("pyarrow")
study_package = pytest.importorskip("repel.study.plan")
hands = pytest.importorskip("repel.study.hands")
files = pytest.importorskip("repel.study.files")
if not hasattr(repel._repel, "run_scene"):
    pytest.skip("this build runs no scenes", allow_module_level=True)

FIRST = """
scenes: [anderson_4x8]
runs: 20
seed: 7
seconds: 0.3
vary: {plant_inertia: {uniform: [0.6, 1.7]}, laws.default.surface_force: {log_uniform: [20 N, 400 N]}}
hand: {random: {speed: 0.25 m/s, turn: 1 rad/s, bandwidth: 2 Hz}}
hold: {nearest_wall_m: {above: -1e-4}, sampling_energy_j: {below: 0.5}}
"""


def study_of(tmp_path, text, name="study.yaml", **options):
    file = tmp_path / name
    file.write_text(text)
    return study_package.load_study(file, **options)


def test_a_row_is_a_function_of_study_and_index(tmp_path):
    study = study_of(tmp_path, FIRST)
    assert [name for name, _ in study.columns] == [
        "index", "scene", "plant_inertia", "laws.default.surface_force", "nearest_wall_m",
        "sampling_energy_j", "margin", "refused", "held"]
    row = study.row(3)
    assert set(row) == {name for name, _ in study.columns}
    other = pickle.loads(pickle.dumps(study_of(tmp_path, FIRST)))
    other.row(5)
    assert other.row(3) == row
    assert row["index"] == 3 and row["refused"] == ""
    assert study.row(4) != {**row, "index": 4}


def test_the_command_of_a_run_makes_the_same_bits_in_any_folder(tmp_path, teleop, monkeypatch):
    study = study_of(tmp_path, FIRST)
    row = study.row(2)
    with monkeypatch.context() as elsewhere:
        elsewhere.chdir(tmp_path)
        line = study.command(2, "replay")
    report = tmp_path / "report.json"
    subprocess.run([teleop, *line[1:], "--quiet", "--report", report], check=True)
    told = json.loads(report.read_text())
    assert told["nearest_wall_m"] == row["nearest_wall_m"]
    assert max(m["sampling_energy_j"] for m in told["modules"]) == row["sampling_energy_j"]
    assert told["plant_inertia"] == row["plant_inertia"]


def test_a_recording_of_a_run_replays_to_the_bit(tmp_path, teleop):
    study = study_of(tmp_path, FIRST)
    log = tmp_path / "run.mcap"
    subprocess.run([*study.command(1, str(tmp_path)), "--quiet", "--log", log], check=True)
    done = subprocess.run([teleop, "replay", log], check=True, capture_output=True, text=True)
    assert "120 of 120 ticks, bit for bit" in done.stdout


def test_draws_fill_their_ranges_and_are_the_same_everywhere(tmp_path):
    study = study_of(tmp_path, FIRST.replace("runs: 20", "runs: 2000"))
    inertia = np.array([study.values(i)["plant_inertia"] for i in range(2000)])
    force = np.array([study.values(i)["laws.default.surface_force"] for i in range(2000)])
    assert 0.6 <= inertia.min() < 0.61 and 1.69 < inertia.max() <= 1.7
    assert abs(np.mean(np.log(force)) - np.mean(np.log([20, 400]))) < 0.1
    assert abs(np.corrcoef(inertia, force)[0, 1]) < 0.1
    assert study.values(0)["plant_inertia"] == 0.9722714752047603


@pytest.mark.parametrize("keys, is_random", [
    ("vary: {plant_inertia: {uniform: [0.6, 1.7]}}", True),
    ("sampling: sobol\nvary: {plant_inertia: {uniform: [0.6, 1.7]}}", False),
    ("vary: {plant_inertia: {grid: [1, 1.5]}}", False),
    ("hand: {random: {speed: 0.1 m/s, bandwidth: 2 Hz}}\nvary: {rate: {grid: [200 Hz]}}", True)])
def test_knows_whether_its_runs_are_a_random_sample(tmp_path, keys, is_random):
    study = study_of(tmp_path, f"scenes: [anderson_4x8]\nruns: 4\n{keys}\nhold: {{exit: 0}}\n")
    assert study.is_random == is_random


@pytest.mark.parametrize("sampling", ["latin_hypercube", "sobol"])
def test_designs_leave_no_gap(tmp_path, sampling):
    pytest.importorskip("scipy")
    study = study_of(tmp_path, FIRST.replace("runs: 20", f"runs: 64\nsampling: {sampling}"))
    inertia = sorted(study.values(i)["plant_inertia"] for i in range(64))
    assert np.diff(inertia).max() < 3 * 1.1 / 64


def test_grids_make_each_combination_once(tmp_path):
    study = study_of(tmp_path, """
scenes: [empty, plates]
seconds: 0.1
vary:
  rate: {grid: [200 Hz, 400 Hz, 1 kHz]}
  arm: {grid: {light: {robot.payload.mass: 0 kg}, laden: {robot.payload.mass: 2 kg}}}
measure: [rate_hz, payload_kg]
hold: {exit: 0}
""".replace("1 kHz", "1000 Hz"))
    assert study.runs == 12
    seen = {tuple(study.values(i).values()) for i in range(12)}
    assert len(seen) == 12
    rows = [study.row(i) for i in range(12)]
    assert {row["rate_hz"] for row in rows} == {200.0, 400.0, 1000.0}
    assert all(row["payload_kg"] == (2.0 if row["arm"] == "laden" else 0.0) for row in rows)
    assert all(row["held"] for row in rows)


def test_a_random_hand_keeps_its_limits():
    hand = hands.RandomHand(0.25, 1.0, 2.0, acceleration=0.5)
    for index in range(50):
        table = hand.table(hand.drawn(1, index, 3.0), 3.0)
        assert table[0, 0] == 0 and table[-1, 0] == pytest.approx(3.0)
        speed = np.linalg.norm(table[:, 1:4], axis=1)
        assert 0.02 < speed.max() <= 0.25 + 1e-12
        assert np.linalg.norm(table[:, 4:], axis=1).max() <= 1 + 1e-12
        change = np.linalg.norm(np.diff(table[:, 1:4], axis=0), axis=1) / np.diff(table[:, 0])
        assert change.max() <= 0.5 * (1 + 1e-9)


def test_the_hand_of_a_recording_does_what_its_operator_did(tmp_path):
    log = tmp_path / "run.mcap"
    before = repel.run("anderson_4x8", seconds=1.0, log=log)
    (tmp_path / "study.yaml").write_text("")
    study = study_of(tmp_path, f"""
scenes: [anderson_4x8]
runs: 1
seconds: 1
hand: {{recording: {log.name}}}
measure: [peak_force_n]
hold: {{exit: 0}}
""")
    assert study.row(0)["peak_force_n"] == before["peak_force_n"]


def test_functions_of_the_log_are_measured(tmp_path):
    (tmp_path / "own.py").write_text(
        "def lowest(log, report):\n    return log['z_m'].min()\n")
    study = study_of(tmp_path, FIRST.replace("hold:", "measure: [wall_force_n, {low_m: "
                                             "own.py:lowest}]\nhold:"))
    (tmp_path / "own.py").unlink()  # its text goes with the study
    row = pickle.loads(pickle.dumps(study)).row(0)
    assert 0.1 < row["low_m"] < 1.0
    assert row["wall_force_n"] >= 0.0


def test_a_hand_without_rows_rests(tmp_path):
    (tmp_path / "rest.csv").write_text(",".join(hands.COLUMNS) + "\n")
    text = FIRST[:FIRST.index("vary:")].replace("0.3", "1") + "hold: {nearest_wall_m: {above: 0}}\n"
    study = study_of(tmp_path, text + "hand: {file: rest.csv}")
    rest = repel.run("anderson_4x8", seconds=1.0, arguments=["--set=script=[]"])["nearest_wall_m"]
    assert study.row(0)["nearest_wall_m"] == rest
    assert study_of(tmp_path, text).row(0)["nearest_wall_m"] != rest
    line = [each for each in study.command(0, tmp_path) if each.startswith("--hand=")]
    assert pathlib.Path(line[0][7:]).read_text() == (tmp_path / "rest.csv").read_text()


def test_a_recording_without_an_operator_is_no_hand(tmp_path):
    repel.run("anderson_4x8", seconds=0.0, log=tmp_path / "none.mcap")
    with pytest.raises(repel.SetupError, match="no tick"):
        study_of(tmp_path, FIRST[:FIRST.index("hand:")] + "hand: {recording: none.mcap}\n"
                 "hold: {exit: 0}")


def test_the_margin_is_that_of_the_least_bound_that_has_a_measure_of_how_well(tmp_path):
    bounds = FIRST.replace("hold: {", "hold: {exit: 0, ")
    row, graded = study_of(tmp_path, bounds).row(0), study_of(tmp_path, FIRST).row(0)
    assert row["margin"] == graded["margin"] > 0
    failing = study_of(tmp_path, bounds.replace("exit: 0", "exit: 3")).row(0)
    assert failing["margin"] == -1.0 and not failing["held"]


def test_a_scene_refused_for_what_was_drawn_is_a_row(tmp_path):
    study = study_of(tmp_path, """
scenes: [anderson_4x8]
runs: 40
seconds: 0.1
vary: {obstacles.table.position.2: {uniform: [0.3, 0.5]}}
hold: {exit: 0}
""")
    rows = [study.row(i) for i in range(40)]
    refused = [row for row in rows if row["refused"]]
    assert 0 < len(refused) < 40
    assert all(not row["held"] and np.isnan(row["margin"]) for row in refused)
    assert "inside" in refused[0]["refused"]


CELL = """
scenes: [cell.yaml]
runs: 3
seconds: 0.05
hold: {exit: 0}
"""


@pytest.fixture
def cell(tmp_path):
    """A scene of one's own with its robot, and a heavier one beside it."""
    share = repel._scenes.FOLDER
    robot = (share.parent / "robots/puma560.urdf").read_text()
    robot = re.sub("<visual>.*?</visual>", "", robot, flags=re.DOTALL)
    (tmp_path / "arm.urdf").write_text(robot)
    (tmp_path / "heavy.urdf").write_text(robot.replace('mass value="10', 'mass value="12'))
    scene = tmp_path / "cell.yaml"
    scene.write_text((share / "plates.yaml").read_text().replace("../robots/puma560.urdf",
                                                                 "arm.urdf"))
    return scene


@pytest.mark.parametrize("changed", ["cell.yaml", "arm.urdf", "heavy.urdf"])
def test_a_file_that_changes_stops_the_study_and_makes_it_another(tmp_path, cell, changed):
    text = CELL + "vary: {robot.urdf: {choice: [arm.urdf, heavy.urdf]}}"
    study = study_of(tmp_path, text)
    assert not study.row(0)["refused"]
    (tmp_path / changed).write_text((tmp_path / changed).read_text() + "\n")
    with pytest.raises(files.CannotRun, match=f"{changed} is not as it was"):
        study.row(1)
    (tmp_path / changed).rename(tmp_path / "gone")
    with pytest.raises(files.CannotRun, match=f"{changed} is missing"):
        study.row(1)
    (tmp_path / "gone").rename(tmp_path / changed)
    assert study_of(tmp_path, text).identity != study.identity


def test_a_file_that_changes_during_a_run_leaves_no_row(tmp_path, cell, monkeypatch):
    study = study_of(tmp_path, CELL)

    def edited(*words, **options):
        cell.write_text("no scene any more")
        return repel.run(*words, **options)
    monkeypatch.setattr(study_package, "run", edited)
    with pytest.raises(files.CannotRun, match="cell.yaml is not as it was"):
        study.row(0)


def test_the_files_of_a_study_are_found_in_each_other(tmp_path):
    texts = {
        "cell/cell.yaml": "robot: {urdf: ../ws/a/arm.urdf, packages: [../ws]}\n"
                          "partners: [{robot: {mjcf: arm.xml}}]\ncamera: {recording: seen}\n",
        "ws/a/arm.urdf": "<robot><mesh filename='package://a/in/a.stl'/>"
                         "<mesh filename='package://far/b.stl'/></robot>",
        "ws/a/in/a.stl": "a", "ws/deep/other/b.stl": "b", "ws/a/in/a.stl.parts.yaml": "mesh: a.stl",
        "cell/arm.xml": "<mujoco><compiler meshdir='in'/><include file='more.xml'/></mujoco>",
        "cell/more.xml": "<mujoco><asset><mesh file='c.stl'/></asset></mujoco>",
        "cell/in/c.stl": "c", "cell/seen/camera.yaml": "", "cell/seen/depth/1.png": "1",
        "part.stl": "d", "cell/another.stl": "e"}
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    found = files.read_by(str(tmp_path / "cell/cell.yaml"), ["[{shape: mesh, file: part.stl}]"],
                          str(tmp_path))
    named = {str((tmp_path / file).resolve()) for file in set(texts) - {"cell/another.stl"}}
    assert {os.path.realpath(file) for file, digest in found.items() if digest} == named


def test_another_numpy_makes_another_study(tmp_path, monkeypatch):
    pytest.importorskip("scipy")
    study = study_of(tmp_path, FIRST)
    assert "scipy" in study_of(tmp_path, FIRST + "sampling: sobol\n").versions
    monkeypatch.setattr(np, "__version__", "0.1")
    assert study_of(tmp_path, FIRST).identity != study.identity


def test_a_study_is_the_same_wherever_it_is_called_from(cell, tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    for name, folder in (("case", "one"), ("robot.urdf", "two")):
        choice = "{x: {robot.urdf: heavy.urdf}}" if name == "case" else "[heavy.urdf]"
        for each in (tmp_path / folder, tmp_path / "sub" / folder):
            each.mkdir()
            shutil.copy(tmp_path / "heavy.urdf", each)
        text = CELL + f"vary: {{{name}: {{choice: {choice}}}}}"
        monkeypatch.chdir(tmp_path)  # where the scene is found
        study, other = (study_of(each, text) for each in (tmp_path / folder,
                                                          tmp_path / "sub" / folder))
        monkeypatch.chdir(tmp_path / "sub")  # as a worker may be elsewhere
        row = pickle.loads(pickle.dumps(study)).row(0)
        assert not row["refused"] and row[name] in ("x", "heavy.urdf")
        assert str(tmp_path / folder / "heavy.urdf") in " ".join(study.command(0, tmp_path))
        assert row == other.row(0) and study.identity == other.identity


def test_a_scene_of_the_package_is_found_where_the_package_is(tmp_path, monkeypatch):
    study = pickle.dumps(study_of(tmp_path, FIRST))
    moved = shutil.copytree(repel._scenes.FOLDER.parent, tmp_path / "share")
    monkeypatch.setattr(files, "_SHARE", f"{moved}/")
    (tmp_path / "anderson_4x8").mkdir()  # is no scene
    monkeypatch.chdir(tmp_path)
    there = pickle.loads(study)
    assert not there.row(0)["refused"] and str(moved) in there.command(0, tmp_path)[2]


def test_a_log_that_is_not_whole_is_no_result(tmp_path):
    study = study_of(tmp_path, CELL.replace("cell.yaml", "plates").replace(
        "exit: 0", "joint_speed_rad_s: {below: 100}"))
    assert study.row(0)["held"]
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        with pytest.raises(files.CannotRun, match="log.csv: cannot be written: File too large"):
            study.row(0)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("old, new, line, said", [
    ("runs: 20", "runs: 0", 3, "allowed: a number from 1"),
    ("runs: 20", "runs: 20\nhands: 3", 4, "did you mean hand?"),
    ("[anderson_4x8]", "[anderson_4x9]", 2, "no such scene"),
    ("laws.default.surface_force", "laws.default.surface_forc", 6, "did you mean 'surface_force'"),
    ("plant_inertia", "plant_inertias", 6, "unknown key 'plant_inertias'"),
    ("uniform: [0.6, 1.7]", "uniform: [1.7, 0.6]", 6, "the least before the greatest"),
    ("uniform: [0.6, 1.7]", "uniform: [0.6]", 6, "allowed: two"),
    ("uniform: [0.6, 1.7]", "triangular: [0.6]", 6, "allowed: uniform"),
    ("[20 N, 400 N]", "[20 N, 400 kN]", 6, "allowed: one for all"),
    ("[20 N, 400 N]", "[0 N, 400 N]", 6, "allowed: above 0"),
    ("uniform: [0.6, 1.7]", "normal: [1, 0]", 6, "allowed: above 0"),
    ("uniform: [0.6, 1.7]", "choice: [1, 1]", 6, "a value twice"),
    ("uniform: [0.6, 1.7]", "choice: [1, 9]", 6, "plant_inertia of anderson_4x8 set to 9"),
    ("2 Hz", "2 m", 7, "allowed: a number"),
    (", bandwidth: 2 Hz", "", 7, "without bandwidth"),
    ("nearest_wall_m", "nearest_wal_m", 8, "did you mean nearest_wall_m"),
    ("nearest_wall_m: {above", "nearest_wall_m: {over", 8, "allowed: above, below, equals"),
    ("{above: -1e-4}", "{above: 1 mm}", 8, "allowed: a number"),
    ("hold: {", "hold: {}\nx: {", 9, "unknown key 'x'"),
    ("seed: 7", "seed: [", 6, "not YAML"),
    ("[anderson_4x8]", "[plates, ./plates]", 2, "another scene has the name plates"),
    ("vary:", "with: {contact: true}\nvary:", 6, "contact is 'true'; allowed: yes, no"),
    ("plant_inertia: {", "tool_alone: {choice: [yes, yse]}, x: {", 6, "'yse'; allowed: yes, no"),
    ("vary:", "with: {drive_delay: 1, robot.drive_delay: 2}\nvary:", 6, "which drive_delay sets"),
    ("plant_inertia:", "a: {choice: {b: {plant_inertia: 1}}}, plant_inertia:", 6, "which a sets"),
    ("laws.default.s", "laws.wall.s: {uniform: [1 N, 2 N]}, laws.wall: {choice: ['{}']}, laws.s", 6,
     "laws.wall replaces laws.wall.s"),
    ("seed: 7", "seed: " + 3000 * "[" + 3000 * "]", 0, "nested too deep"),
    ("[anderson_4x8]", "[]", 2, "scenes is empty"),
    ("hold:", "measure: [scene]\nhold:", 8, "another column of the table"),
    ("hold: {", "hold: {margin: 1, ", 8, "another column of the table"),
    ("{above: -1e-4}", "{above: -inf}", 8, "allowed: a finite number"),
    ("{above: -1e-4}", "{above: 1, scale: inf}", 8, "scale is 'inf'"),
    ("hold: {", "hold: {exit: zero, ", 8, "'zero', but it is a number"),
    ("hold: {", "hold: {exit: 0 N, ", 8, "'0 N', but it is a number"),
    ("hold: {", "hold: {prediction: yes, ", 8, "of yes and no 1 and 0"),
    ("hold: {", "hold: {backend: {above: 3}, ", 8, "it is a word, as 'bullet'"),
    ("vary: {", "measure: [physical_contact]\nvary: {contact: {choice: [no, yes]}, ", 6,
     "not measured with contact of anderson_4x8 set to yes"),
    ("vary: {", "vary: {levels: {uniform: [1, 15]}, ", 6, "levels of anderson_4x8 set to 8."),
    ("vary: {", "vary: {fault: {choice: [nonsense]}, ", 6, "no fault is called 'nonsense'"),
    ("vary: {", "faults: {names: [none]}\nvary: {fault: {choice: [none]}, ", 7, "one of both"),
    ("vary: {", "vary: {fault_s: {uniform: [1 ms, 2 ms]}, ", 6, "numbers in s"),
    ("seconds: 0.3", "seconds: 1e6", 7, "has 4000003 knots"),
])
def test_what_is_wrong_is_refused_with_its_line_before_the_first_run(tmp_path, old, new, line,
                                                                     said):
    assert old in FIRST
    with pytest.raises(repel.SetupError) as error:
        study_of(tmp_path, FIRST.replace(old, new))
    assert said in str(error.value)
    assert error.value.line == line, error.value


def test_what_varies_replaces_what_is_fixed(tmp_path):
    study = study_of(tmp_path, FIRST.replace("vary: {", "with: {walls: hard, contact: yes}\nvary: "
                                             "{walls: {choice: [soft]}, contact: {choice: [no]}, "))
    words = study.command(0, tmp_path)
    assert "--walls=soft" in words and "--walls=hard" not in words and "--contact" not in words


def test_a_design_of_fewer_runs_is_replayed_as_it_was_made(tmp_path):
    pytest.importorskip("scipy")
    text = FIRST + "sampling: latin_hypercube\n"
    few = study_of(tmp_path, text, runs=4)
    assert few.values(0) != study_of(tmp_path, text).values(0)
    assert few.options == ("--runs", "4") and study_of(tmp_path, text).options == ()
@pytest.mark.parametrize("own, said", [
    ("x = 3", "x of .* is no function"),
    ("def x(log, report): return None", "x returned None; allowed: a number"),
    ("def x(log, report): return 'high'", "x returned 'high'; allowed: a number"),
    ("def x(log, report): return 1 / 0", r"ZeroDivisionError: .*own.py:1\)")])
def test_functions_of_the_log_are_tried_before_the_first_run(tmp_path, own, said):
    (tmp_path / "own.py").write_text(own)
    with pytest.raises(repel.SetupError, match=said):
        study_of(tmp_path, FIRST.replace("hold:", "measure: [{mine: own.py:x}]\nhold:"))


def test_a_function_may_need_a_whole_log(tmp_path):
    (tmp_path / "own.py").write_text("def x(log, report): return log['z_m'][100]\n")  # of 120
    study_of(tmp_path, FIRST.replace("hold:", "measure: [{mine: own.py:x}]\nhold:"))


@pytest.mark.parametrize("rows, said", [
    ("0,0,0,0,0,0,0\n1,2,3,4\n", "hand.csv:3: a row of 4 numbers; allowed: 7"),
    ("0,0,0,0,0,0,0\n\n", "hand.csv:3: a row of 0 numbers"),
    ("0,0,0,0,0,0,nan\n", "study.yaml:3: row 1 of the hand has what is no number"),
    ("1,0,0,0,0,0,0\n1,0,0,0,0,0,0\n", "study.yaml:3: row 2 of the hand is not later")])
def test_a_table_of_a_hand_is_tried_before_the_first_run(tmp_path, rows, said):
    (tmp_path / "hand.csv").write_text(",".join(hands.COLUMNS) + "\n" + rows)
    with pytest.raises(repel.SetupError, match=said):
        study_of(tmp_path, "scenes: [anderson_4x8]\nseconds: 0.1\nhand: {file: hand.csv}\n"
                           "hold: {exit: 0}\n")


def test_a_run_in_process_takes_the_words_of_the_program():
    usual = repel.run("plates", seconds=0.5)
    same = repel.run("plates", seconds=0.5, arguments=["--set", "laws.wall.damping=100 N s/m"])
    heavy = repel.run("plates", seconds=0.5, arguments=["--plant-inertia=1.5"])
    assert heavy["plant_inertia"] == 1.5 and usual["plant_inertia"] == 1.0
    assert same["exit_status"] == 0
    with pytest.raises(repel.SetupError, match="allowed"):
        repel.run("plates", arguments=["--set=laws.wall.dampin=1 N s/m"])
    with pytest.raises(repel.SetupError, match="plant-inertia"):
        repel.run("plates", arguments=["--plant-inertia=9"])


def test_the_command_line_is_there():
    done = subprocess.run([sys.executable, "-m", "repel", "study", "--help"], check=True,
                          capture_output=True, text=True)
    assert "--resume" in done.stdout
