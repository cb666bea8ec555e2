# SPDX-License-Identifier: BSD-3-Clause
"""The search finds planted weaknesses that random runs miss, and takes away what is not needed."""

import importlib.util
import json
import math
import sys

import pytest

for needs in ("cma", "pyarrow", "scipy"):
    pytest.importorskip(needs)

from problem import ROOT
from repel import SetupError
from repel.study import command, falsify
from repel.study.engine import Here
from toy_study import ToyStudy

spec = importlib.util.spec_from_file_location("planted", ROOT / "bench/studies/falsify.py")
planted = importlib.util.module_from_spec(spec)
sys.modules["planted"] = planted
spec.loader.exec_module(planted)


@pytest.mark.parametrize("name, at_most", [
    ("bowl, 4 numbers, 0.1 %", 10), ("bowl, 4 numbers and one of 3 words, 0.1 %", 10),
    ("slot for a hand of 12 numbers", 3)])
def test_finds_what_random_runs_miss(name, at_most):
    pairs = [planted.found_by(planted.PLANTED[name], seed) for seed in range(1, 11)]
    assert sum(search is not None for search, _ in pairs) >= 9
    assert sum(random is not None for _, random in pairs) <= at_most


class Corner(planted.Planted):
    """Fails where x0 and the third number of the hand are large, whatever the rest is."""

    def __init__(self):
        super().__init__([planted.Number(f"x{i}", nominal=0.5) for i in range(4)], 6, 1)

    def margin(self, values, hand):
        return 1.6 - values["x0"] - hand[2]


def test_takes_away_what_the_failure_does_not_need():
    found = falsify.search(Corner(), Here(), runs=300, seed=3)
    assert found.worst.is_failure and found.minimal.is_failure
    assert set(found.set_back) == {"x1", "x2", "x3", "hand[0]", "hand[1]", "hand[3]", "hand[4]",
                                   "hand[5]"}
    assert found.minimal.values["x0"] > 0.5 and "x1" not in found.minimal.values
    assert [x == 0 for x in found.minimal.hand] == [True, True, False, True, True, True]
    assert found.random_runs == found.runs


class Chain(planted.Planted):
    """Fails with all three set, without the third, and with the second alone."""

    def __init__(self):
        super().__init__([planted.Number(name, nominal=0.5) for name in ("a", "b", "c")], 0, 1)

    def margin(self, values, hand):
        names = "".join(name for name in "abc" if values[name] != 0.5)
        return -1.0 if names in ("abc", "ab", "b") else 1.0


def test_takes_away_what_could_not_be_taken_before_the_rest_was():
    found = falsify.search(Chain(), Here(), runs=10, seed=1, compare=False)
    assert list(found.minimal.values) == ["b"] and sorted(found.set_back) == ["a", "c"]


def test_is_the_same_for_the_same_seed_and_keeps_its_budget():
    first, again, other = (falsify.search(planted.Slot(6, 1, width=0.01), Here(), runs=90,
                                          seed=seed, every=True) for seed in (1, 1, 2))
    assert first.runs == first.random_runs == 90
    assert first.worst == again.worst and first.worst != other.worst
    assert falsify.search(Corner(), Here(), runs=50, seconds=-1.0, seed=1, every=True,
                          compare=False).runs > 0


class Refused(Corner):
    """Where it would fail it is refused, or does not measure anything."""

    def row_of(self, values, hand):
        row = super().row_of(values, hand)
        if row["margin"] > 0:
            return row
        how = {"refused": "in a wall"} if values["x1"] > 0.5 else {"margin": math.nan}
        return {**row, **how, "held": False}


def test_what_is_refused_is_no_failure_and_yet_did_not_hold():
    found = falsify.search(Refused(), Here(), runs=200, seed=1)
    assert not found.worst.is_failure and found.minimal is None
    assert 0 < found.worst.margin < 0.2
    assert 0 < found.failed == found.unmeasured < 200 and 0 < found.random_failed < 200


def test_says_that_runs_were_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "read_study", lambda name: Refused())
    assert command.main(["falsify", "it", "--runs", "50", "--workers", "0", "--out",
                         str(tmp_path / "found")]) == 6
    assert "of 50 runs were refused or without a measure; they did not" in capsys.readouterr().out


class Unbounded(planted.Planted):
    """A number without bounds and one by its logarithm."""

    def __init__(self):
        super().__init__([planted.Number("force", low=None, high=None, nominal=10.0),
                          planted.Number("mass", low=0.01, high=100.0, scale="log",
                                         nominal=1.0)], 0, 1)

    def point(self, index):
        values = planted.np.random.default_rng([1, index])
        return {"force": float(values.normal(10, 2)), "mass": float(10 ** values.uniform(-2, 2))
                }, None

    def margin(self, values, hand):
        assert 0.01 <= values["mass"] <= 100 and -10 < values["force"] < 30
        return abs(math.log10(values["mass"]) + 1.5) + abs(values["force"] - 14.5) - 0.02


def test_searches_as_far_as_draws_go():
    found = falsify.search(Unbounded(), Here(), runs=500, seed=1, compare=False)
    assert found.worst.is_failure
    assert found.spans["mass"] == (0.01, 100.0) and found.spans["force"][1] > 14


class Nothing(planted.Planted):
    def __init__(self):
        super().__init__([], 0, 1)


def test_refuses_a_study_in_which_nothing_varies():
    with pytest.raises(SetupError, match="nothing varies"):
        falsify.search(Nothing(), Here())


def test_tries_to_write_before_it_searches(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "read_study", lambda name: ToyStudy())
    monkeypatch.setattr(falsify, "search", lambda *_, **__: pytest.fail("it searches"))
    (tmp_path / "file").touch()
    assert command.main(["falsify", "it", "--workers", "0", "--out", str(tmp_path / "file/x")]) == 4
    assert "not written: Not a directory" in capsys.readouterr().err


def test_a_search_is_told_where_its_folder_cannot_be_written_any_more(tmp_path, monkeypatch,
                                                                      capsys):
    def tried_in_vain(folder):
        folder.touch()
    monkeypatch.setattr(command, "read_study", lambda name: ToyStudy())
    monkeypatch.setattr(command, "try_to_write", tried_in_vain)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert command.main(["falsify", "it", "--workers", "0", "--out", str(tmp_path / "out")]) == 4
    said, complained = capsys.readouterr()
    elsewhere, = tmp_path.glob("repel-falsify-*/falsify.json")
    assert "failure found" in said and f"is in {elsewhere.parent}" in complained


@pytest.mark.parametrize("words", [("--minutes", "0"), ("--minutes", "nan"), ("--minutes", "-1"),
                                   ("--seed", "5000000000"), ("--runs", "100000000000000")])
def test_refuses_budgets_that_are_none(words, capsys):
    with pytest.raises(SystemExit):
        command.main(["falsify", "it", *words])
    assert f"argument {words[0]}: {words[1]} is no " in capsys.readouterr().err


def test_writes_what_it_found(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "read_study", lambda name: ToyStudy(limit=float(name)))
    monkeypatch.chdir(tmp_path)
    arguments = ["--runs", "40", "--workers", "0", "--out"]
    assert command.main(["falsify", "0.9", *arguments, "found"]) == 6
    said = capsys.readouterr().out
    summary = json.loads((tmp_path / "found/falsify.json").read_text())
    assert summary["failed"] and summary["worst"]["margin"] <= 0
    assert "failure found" in said and summary["minimal"]["replay"] in said
    for each in ("worst", "minimal"):
        assert (tmp_path / "found" / each / "replay.sh").read_text().splitlines() == [
            "#!/bin/sh", summary[each]["replay"]]
    assert command.main(["falsify", "0.9", *arguments, "found"]) == 1
    assert "another --out" in capsys.readouterr().err
    assert command.main(["falsify", "2", *arguments, "none", "--no-compare", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["random"] is None
