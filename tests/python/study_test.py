# SPDX-License-Identifier: BSD-3-Clause
"""Studies: what they draw, what they measure, and what they refuse."""

import json
import pickle
import subprocess
import sys

import numpy as np
import pytest

import repel

yaml = pytest.importorskip("yaml")
pytest.importorskip("pyarrow")
study_package = pytest.importorskip("repel.study.plan")
hands = pytest.importorskip("repel.study.hands")
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
