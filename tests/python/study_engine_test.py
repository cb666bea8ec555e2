# SPDX-License-Identifier: BSD-3-Clause
"""What is around the runs of a study: workers that die, folders that are gone on with, reports."""

import contextlib
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import time

import pytest

for needs in ("distributed", "pyarrow", "scipy"):
    pytest.importorskip(needs)

import psutil
import pyarrow.parquet as parquet

from repel import SetupError
from repel.study import command, report
from repel.study.store import NotWritten, Store, decoded, encoded, whole
from toy_study import Bound, Quantity, ToyStudy, read_study

TOY = pathlib.Path(__file__).with_name("toy_study.py")
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(
    [str(TOY.parent), *(each for each in sys.path if each)])}
PATIENCE_S = 120  # after which something hangs


def hear_interrupts():
    """What a shell has started in the background, as this may be, ignores them."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def begin(*arguments, environment=ENVIRONMENT, **how):
    how.setdefault("preexec_fn", hear_interrupts)
    return subprocess.Popen([sys.executable, TOY, *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, env=environment, **how)


def end(child):
    said, complained = child.communicate(timeout=PATIENCE_S)
    return child.returncode, said, complained


def repel(*arguments, **how):
    return end(begin(*arguments, **how))


def wait_for(what, child=None):
    until = time.monotonic() + PATIENCE_S
    while not what():
        assert time.monotonic() < until
        assert child is None or child.poll() is None, child.communicate()
        time.sleep(0.05)


def parts(folder):
    return list((folder / "parts").glob("[!.]*.parquet"))


def workers_of(child):
    """The processes that make runs."""
    return [each for each in psutil.Process(child.pid).children(recursive=True)
            if "spawn_main" in " ".join(each.cmdline())]


@pytest.fixture
def here(monkeypatch, capfd):
    """`repel` in this process."""
    monkeypatch.setattr(command, "read_study", read_study)

    def repel(*arguments):
        try:
            status = command.main([str(each) for each in arguments])
        except SystemExit as ended:
            status = ended.code
        return status, *capfd.readouterr()
    return repel


@pytest.fixture(scope="session")
def whole_table(tmp_path_factory):
    """The bytes of the table of toy:runs=400,odd=5,refuse=7, made in one process."""
    folder = tmp_path_factory.mktemp("study")
    status, said, complained = repel("study", "toy:runs=400,odd=5,refuse=7", "--out", folder,
                                     "--workers", 0)
    assert status == 6 and not complained, complained
    return (folder / "results.parquet").read_bytes()


FAST = "toy:runs=400,odd=5,refuse=7"
SLOW = FAST + ",sleep=0.02"  # the same table
ENDLESS = FAST + ",sleep=0.3"  # likewise; on a busy machine, too, it is ended before it is over


def gone_on_with(folder):
    """The bytes of the table, and what was said, after a study has gone on in this process."""
    status, said, complained = repel("study", FAST, "--out", folder, "--workers", 0, "--resume")
    assert status == 6, complained
    return (folder / "results.parquet").read_bytes(), complained


@pytest.mark.parametrize("workers", [1, 3])
def test_the_table_is_the_same_on_any_number_of_workers(here, whole_table, tmp_path, workers):
    status, said, complained = here("study", FAST, "--out", tmp_path, "--workers", workers)
    assert status == 6, complained
    assert (tmp_path / "results.parquet").read_bytes() == whole_table
    assert not (tmp_path / "parts").exists()
    assert "of 400 runs held" in said


def test_runs_of_a_killed_worker_are_made_again(whole_table, tmp_path):
    child = begin("study", SLOW, "--out", tmp_path, "--workers", 2)
    wait_for(lambda: parts(tmp_path), child)
    workers_of(child)[0].kill()
    status, said, complained = end(child)
    assert status == 6, complained
    assert (tmp_path / "results.parquet").read_bytes() == whole_table


def test_a_run_that_kills_its_workers_becomes_a_row(here, tmp_path):
    status, said, complained = here("study", "toy:runs=40,killer=33", "--out", tmp_path,
                                    "--workers", 2)
    assert status == 6
    assert "run 33: the worker died each time" in complained
    rows = parquet.read_table(tmp_path / "results.parquet").to_pylist()
    dead = [row for row in rows if row["refused"]]
    assert [row["index"] for row in dead] == [33] and not dead[0]["held"]
    assert dead[0]["refused"] == "the worker died"
    assert [row["index"] for row in rows] == list(range(40))


def test_workers_that_dask_gives_up_are_started_again(tmp_path):
    hasty = {**ENVIRONMENT, "DASK_DISTRIBUTED__DEPLOY__LOST_WORKER_TIMEOUT": "1ms"}
    status, said, complained = repel("study", "toy:runs=4,killer=2", "--out", tmp_path, "--workers",
                                     1, environment=hasty)
    assert status == 6 and "run 2: the worker died each time" in complained


def test_says_that_its_workers_do_not_start(here, tmp_path, monkeypatch):
    def killed(**_):
        raise RuntimeError("Nanny failed to start")
    monkeypatch.setattr("distributed.LocalCluster", killed)
    status, said, complained = here("study", "toy", "--out", tmp_path)
    assert status == 1 and "do not start: Nanny failed to start; allowed: fewer" in complained


def test_goes_on_after_the_coordinator_was_killed(whole_table, tmp_path):
    child = begin("study", ENDLESS, "--out", tmp_path, "--workers", 2)
    wait_for(lambda: len(parts(tmp_path)) > 1, child)
    orphans = workers_of(child)
    child.kill()
    end(child)
    assert not psutil.wait_procs(orphans, timeout=PATIENCE_S)[1]
    assert not (tmp_path / "results.parquet").exists()
    found = [i for file in parts(tmp_path) for i in parquet.read_table(file)["index"].to_pylist()]
    assert len(found) == len(set(found)) > 0
    table, complained = gone_on_with(tmp_path)
    assert f"{400 - len(found)} of 400 runs are missing" in complained
    assert table == whole_table


@pytest.mark.parametrize("workers", [0, 2])
def test_stops_soundly(whole_table, tmp_path, workers):
    child = begin("study", ENDLESS, "--out", tmp_path, "--workers", workers, start_new_session=True)
    wait_for(lambda: parts(tmp_path), child)
    if workers:
        os.killpg(child.pid, signal.SIGINT)  # as the terminal does
    else:
        child.send_signal(signal.SIGTERM)
    status, said, complained = end(child)
    assert status == 4
    assert f"to go on: repel study {ENDLESS} --out {tmp_path} --resume" in complained
    said = [line for line in complained.splitlines() if "dashboard: " not in line]
    assert len(said) == 1
    assert gone_on_with(tmp_path)[0] == whole_table


@contextlib.contextmanager
def dask(folder, environment):
    """A scheduler and a worker elsewhere: its address and both processes."""
    file = folder / "scheduler.json"
    both = [subprocess.Popen([sys.executable, "-m", f"distributed.cli.dask_{what}",
                              "--scheduler-file", file, *rest], env=environment, cwd=folder,
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            for what, rest in (("scheduler", ["--port", "0", "--no-dashboard", "--host",
                                              "127.0.0.1"]),
                               ("worker", ["--nthreads", "1", "--no-dashboard"]))]
    try:
        wait_for(file.exists)
        wait_for(lambda: file.read_text().endswith("}"))
        yield json.loads(file.read_text())["address"], *both
    finally:
        for each in both:
            for child in psutil.Process(each.pid).children(recursive=True):
                child.kill()
            each.kill()
            each.wait()


def test_ends_with_its_scheduler_and_goes_on_without(whole_table, tmp_path):
    out = tmp_path / "out"
    with dask(tmp_path, ENVIRONMENT) as (address, scheduler, worker):
        child = begin("study", ENDLESS, "--out", out, "--scheduler", address)
        wait_for(lambda: parts(out), child)
        scheduler.kill()
        status, said, complained = end(child)
    assert status == 1
    assert complained.splitlines()[-1].startswith(
        f"repel: the scheduler of {address} is gone; allowed: ")
    assert "Traceback" not in complained
    assert parts(out) and not (out / "results.parquet").exists()
    assert gone_on_with(out)[0] == whole_table


def test_refuses_workers_with_other_versions(tmp_path):
    with dask(tmp_path, {**ENVIRONMENT, "TOY_VERSION": "2"}) as (address, *_):
        status, said, complained = repel("study", "toy", "--out", tmp_path / "out", "--scheduler",
                                         address)
    assert status == 1
    assert "worker tcp://" in complained and "toy 2 and not 1" in complained
    assert not parts(tmp_path / "out")


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense", "carrier://pigeon:1"])
def test_refuses_a_scheduler_that_is_not_there(here, tmp_path, address):
    status, said, complained = here("study", "toy", "--out", tmp_path, "--scheduler", address)
    assert status == 1
    assert complained.startswith(f"repel: --scheduler {address}: ")
    assert "tcp://HOST:8786" in complained and len(complained.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("workers", [0, 1])
def test_a_bug_ends_the_study_and_names_the_run(here, tmp_path, workers):
    status, said, complained = here("study", "toy:bug=7", "--out", tmp_path, "--workers", workers)
    assert status == 1
    assert "run 7: ZeroDivisionError: a planted bug (toy_study.py:" in complained


def test_a_full_disk_leaves_what_is_whole(tmp_path):
    def small_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000))
    status, said, complained = repel("study", "toy:runs=400", "--out", tmp_path, "--workers", 0,
                                     preexec_fn=small_files)
    assert status == 4
    assert "not written: File too large" in complained and "--resume" in complained
    assert not (tmp_path / "results.parquet").exists()
    assert not list(tmp_path.glob("**/.*"))
    assert repel("study", "toy:runs=400", "--out", tmp_path, "--workers", 0, "--resume")[0] == 6


def test_exit_statuses_and_what_is_printed(here, tmp_path):
    held = "toy:runs=20,limit=2"
    status, said, complained = here("study", held, "--out", tmp_path, "--workers", 0, "--json")
    assert status == 0 and json.loads(said) == json.loads((tmp_path / "summary.json").read_text())
    assert here("study", held, "--out", tmp_path, "--resume", "--quiet") == (0, "", "")
    status, said, complained = here("study", held, "--out", tmp_path)
    assert status == 1 and "allowed: --resume" in complained
    status, said, complained = here("study", held + ",seed=2", "--out", tmp_path, "--resume")
    assert status == 1 and "another study" in complained
    status, said, complained = here("study", held, "--out", tmp_path, "--resume", "--runs", 10)
    assert status == 1 and "has run 19" in complained
    assert here("study", held, "--out", tmp_path, "--runs", 0)[0] == 2
    assert here("study", held)[0] == 2
    status, said, complained = here("study", held, "--out", tmp_path, "--resume", "--runs", 30,
                                    "--workers", 0)
    assert status == 0 and "30 of 30 runs held" in said
    assert f"repel study replay {held} " in said and said.count(" --runs 30\n") == 1


def test_a_replay_is_the_program_with_the_values(here):
    assert here("study", "replay", "toy", 3, "--view") == (0, "3 --view\n", "")  # by the clock
    status, said, complained = here("study", "replay", "toy", 3, "--print", "--log", "a b.csv")
    assert status == 0 and said.endswith(" 3 --fast --log 'a b.csv'\n")
    status, said, complained = here("study", "replay", "toy", 100)
    assert status == 1 and "no run 100; allowed: 0 to 99" in complained
    assert here("study", "replay", "toy", 100, "--runs", 101) == (0, "100 --fast\n", "")


def table_of(study):
    return decoded(encoded([study.row(i) for i in range(study.runs)], study.columns))


def test_a_folder_has_one_writer(tmp_path):
    with Store(tmp_path, ToyStudy()):
        with pytest.raises(SetupError, match="another process"):
            Store(tmp_path, ToyStudy(), resume=True)
    with pytest.raises(SetupError, match="another study"):  # none has been made, but of whom?
        Store(tmp_path, ToyStudy(salt="other"))
    (tmp_path / "study.yaml").write_bytes(b"\xff")
    with pytest.raises(SetupError, match="another study"):
        Store(tmp_path, ToyStudy())


def test_rows_that_come_twice_are_kept_once(tmp_path):
    study = ToyStudy(runs=50)
    table = table_of(study)
    with Store(tmp_path, study) as store:
        for rows in (table.slice(20, 30), table.slice(0, 30), table.slice(10, 20)):
            store.add(rows)
        store.flush()
        assert not store.missing
        store.finish()
    assert parquet.read_table(tmp_path / "results.parquet").equals(table)


def test_names_a_part_that_is_damaged(tmp_path):
    study = ToyStudy(runs=50)
    with Store(tmp_path, study) as store:
        store.add(table_of(study).slice(0, 30))
        store.flush()
    (tmp_path / "parts/0.parquet").write_bytes(b"PAR1")
    with pytest.raises(SetupError, match="0.parquet: cannot be read"):
        Store(tmp_path, study, resume=True)


def test_names_a_part_whose_rows_are_damaged(tmp_path):
    study = ToyStudy(runs=50)
    with Store(tmp_path, study) as store:
        store.add(table_of(study))
        store.flush()
        part, = parts(tmp_path)
        group = parquet.read_metadata(part).row_group(0)
        with open(part, "r+b") as file:  # not of its index, which is read to go on
            file.seek(group.column(group.num_columns - 1).data_page_offset)
            file.write(bytes(8))
        with pytest.raises(SetupError, match="0.parquet: cannot be read: .* allowed: to delete it"):
            store.finish()


def test_a_report_of_fewer_runs_goes_with_their_table(tmp_path):
    reported(ToyStudy(runs=5), tmp_path)
    Store(tmp_path, ToyStudy(runs=9), resume=True).close()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["parts", "study.yaml"]


def test_what_is_in_place_stays_until_the_new_one_is_whole(tmp_path):
    file = tmp_path / "file"
    file.write_text("old")
    with pytest.raises(NotWritten):
        with whole(file) as out:
            out.write(b"new")
            raise OSError(28, "No space left on device")
    assert file.read_text() == "old" and os.listdir(tmp_path) == ["file"]


def reported(study, folder):
    with Store(folder, study) as store:
        store.add(table_of(study))
        summary = report.write(folder, study, store.finish())
    json.loads((folder / "summary.json").read_text(), parse_constant=lambda word: 1 / 0)
    return summary, (folder / "report.html").read_text()


def test_reports_what_failed(tmp_path):
    study = ToyStudy(runs=300, odd=5, refuse=7)
    summary, page = reported(study, tmp_path)
    rows = table_of(study).to_pylist()
    failed = [row for row in rows if not row["held"]]
    assert summary["failed"] == len(failed) and summary["refused"] == 1
    worst = min(rows, key=lambda row: row["margin"] if row["margin"] == row["margin"] else 9)
    assert summary["worst"]["index"] == worst["index"]
    assert summary["worst"]["values"]["speed"] == worst["speed"]
    assert summary["bounds"][0]["not_measured"] == 2
    assert summary["bounds"][0]["least_margin"] == summary["worst"]["margin"] == worst["margin"]
    assert len(summary["worst_ten"]) == 10
    assert f"replay toy {worst['index']}" in page
    assert "<rod>" not in page and "&lt;rod&gt;" in page
    assert "http" not in page.replace("http://www.w3.org", "")
    assert page.index("speed: explains") < page.index("weight: explains")


@pytest.mark.parametrize("study, held", [(ToyStudy(runs=3, limit=2), "yes"),
                                         (ToyStudy(runs=3, limit=-1), "NO"),
                                         (ToyStudy(runs=3, limit=2, odd=1), "not known"),
                                         (ToyStudy(runs=3, limit=2, refuse=1), "not known")])
def test_a_bound_that_was_not_measured_is_not_said_to_have_held(tmp_path, study, held):
    summary, page = reported(study, tmp_path)
    assert f">{held}</span>" in page.partition("What held")[2].partition("</table>")[0]
    assert ("1 not measured" in report.as_text(summary)) == (held == "not known")


class Design(ToyStudy):
    """Its runs are chosen, and its tools have long names."""

    is_random = False
    tools = tuple(f"a long name, {i}" for i in range(12))
    quantities = (Quantity("tool", is_word=True, low=None, high=None, choices=tools),
                  Quantity("other", is_word=True, low=None, high=None, choices=tools))
    columns = (*ToyStudy.columns, ("other", "string"))

    def values(self, index):
        word = self.tools[index % 12]
        return {**super().values(index), "tool": word, "other": word}


def test_what_is_no_random_sample_proves_no_share(tmp_path):
    summary, page = reported(Design(runs=40), tmp_path)
    assert summary["upper_bound"] is None
    assert "95 %" not in page + report.as_text(summary) and "no random sample" in page


def test_long_words_below_a_chart_do_not_overlap(tmp_path):
    page = reported(Design(runs=40), tmp_path)[1]
    assert page.count("rotate(-40") == 24
    assert "matter most" not in page  # neither explains anything


def test_the_bound_is_that_of_clopper_and_pearson():
    assert report.upper_bound(0, 100) == pytest.approx(1 - 0.05 ** (1 / 100))
    assert report.upper_bound(3, 10) == pytest.approx(0.60662, abs=1e-5)
    assert report.upper_bound(10, 10) == 1
    assert report.percent(0.0299) == "3 %" and report.percent(0.02951) == "3 %"


class Odd(ToyStudy):
    """Nothing varies, and nothing is measured."""

    quantities, measures = (), ()
    columns = tuple(each for each in ToyStudy.columns if each[0] in (
        "index", "margin", "refused", "held"))
    bounds = ()


class Words(ToyStudy):
    """All that varies is a word, and the bound is of one that has no room."""

    quantities = (Quantity("tool", "<b>", True, None, None, choices=("ball", "<rod>")),)
    bounds = (Bound("depth_m", "<i>m", "below", 5.0),)


@pytest.mark.parametrize("study", [Odd(runs=1), Odd(runs=20), Words(runs=30), ToyStudy(runs=1),
                                   Words(runs=1, odd=0), ToyStudy(runs=1, refuse=0)])
def test_reports_of_odd_studies(tmp_path, study):
    summary, page = reported(study, tmp_path)
    assert summary["runs"] == study.runs and page.endswith("</html>\n")
    assert "<b>" not in page and "<i>m" not in page and "nan" not in page
    assert report.as_text(summary)
