# SPDX-License-Identifier: BSD-3-Clause
"""The commands `repel study`, `repel study replay` and `repel falsify`."""

from __future__ import annotations

import argparse
import json
import math
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._errors import SetupError
from . import falsify, report
from .engine import engine
from .store import NotWritten, Store, try_to_write

if TYPE_CHECKING:
    from .plan import Study

HELD, BAD, NOT_WHOLE, NOT_HELD = 0, 1, 4, 6  #: exit statuses; argparse has 2

_STATUS = ("exit status: 0 all held, 1 the study is wrong or its workers are gone, 2 wrong usage, "
           "4 stopped or not written whole, 6 not all held")
_LINE_S = 10.0  # between lines of progress where there is no terminal


class Progress:
    """How far the runs are, on standard error: a bar on a terminal, else a line now and then."""

    def __init__(self, total: int, done: int = 0, quiet: bool = False):
        """done: of total, runs of before."""
        self._total, self._before, self._quiet = total, done, quiet
        self._done, self._failed = done, 0
        self._is_terminal = sys.stderr.isatty()
        self._began = self._shown = time.monotonic()
        self._has_bar = False

    def add(self, done: int, failed: int) -> None:
        """Counts runs, and shows them if it is time to."""
        self._done += done
        self._failed += failed
        now = time.monotonic()
        if self._quiet or now - self._shown < (0.2 if self._is_terminal else _LINE_S):
            return
        self._shown = now
        self._show(now)

    def _show(self, now: float) -> None:
        made = self._done - self._before
        rate = made / max(now - self._began, 1e-9)
        left = f"{_clock((self._total - self._done) / rate)} left" if made else "-"
        text = (f"{self._done} of {self._total} runs, {rate:.3g}/s, {self._failed} did not hold, "
                f"{left}")
        if self._is_terminal:
            full = 24 * self._done // max(self._total, 1)
            text = f"\r[{'#' * full}{'.' * (24 - full)}] {text}\x1b[K"
            self._has_bar = True
        print(text, end="" if self._is_terminal else "\n", file=sys.stderr, flush=True)

    def say(self, text: str) -> None:
        """A line for the person."""
        self.end()
        print(f"repel: {text}", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Takes the bar away."""
        if self._has_bar:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
            self._has_bar = False


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes}:{seconds:02}"


def read_study(file: str, runs: int | None = None) -> Study:
    """The study of a file. runs: in place of its own number. Raises SetupError."""
    from .plan import load_study
    return load_study(file, runs=runs)


def add_to(commands: Any) -> None:
    """Adds the commands to the sub-commands of a parser of argparse; each has `act`, which takes
    what was parsed and returns the exit status."""
    studying = commands.add_parser("study", help="run a scene many times with varied numbers, and "
                                   "say what held", epilog=_STATUS)
    studying.add_argument("study", metavar="STUDY", help="a file, see docs/qualify.md")
    studying.add_argument("--out", metavar="FOLDER", required=True, help="of table and report")
    studying.add_argument("--resume", action="store_true", help="make the runs that are missing "
                          "in the folder")
    studying.add_argument("--runs", type=_whole(1), metavar="N", help="in place of the study's")
    studying.set_defaults(act=_run_study)
    replaying = commands.add_parser("study replay", help="make one run of a study again")
    replaying.add_argument("study", metavar="STUDY")
    replaying.add_argument("index", metavar="INDEX", type=_whole(0))
    replaying.add_argument("--runs", type=_whole(1), metavar="N", help="as the study was made")
    how = replaying.add_mutually_exclusive_group()
    how.add_argument("--view", action="store_true", help="in the live view")
    how.add_argument("--print", action="store_true", help="print the command only")
    replaying.add_argument("--log", metavar="FILE", help="every tick: .mcap a recording, else CSV")
    replaying.set_defaults(act=_replay)
    searching = commands.add_parser("falsify", help="search for the values and the hand for which "
                                    "a study does not hold", epilog=_STATUS)
    searching.add_argument("study", metavar="STUDY")
    searching.add_argument("--out", metavar="FOLDER", help="default: NAME_falsified")
    searching.add_argument("--runs", type=_whole(1), metavar="N", default=500,
                           help="of the search (default: %(default)s)")
    searching.add_argument("--minutes", type=_minutes, metavar="M", default=math.inf,
                           help="of the search, at most")
    searching.add_argument("--seed", type=_whole(0, 2**31), metavar="S", default=1)
    searching.add_argument("--all", action="store_true", help="go on after the first failure, for "
                           "the worst one")
    searching.add_argument("--no-compare", dest="compare", action="store_false",
                           help="do not make as many random runs for comparison")
    searching.set_defaults(act=_falsify)
    for each in (studying, searching):
        where = each.add_mutually_exclusive_group()
        where.add_argument("--workers", type=_whole(0), metavar="N", help="processes of this "
                           "machine (default: as many as processors; 0: in this process)")
        where.add_argument("--scheduler", metavar="ADDRESS", help="of Dask, as tcp://HOST:8786")
        each.add_argument("--quiet", action="store_true", help="no progress, no summary")
        each.add_argument("--json", action="store_true", help="print the summary as JSON")


def _whole(least: int, most: int = 10**9) -> Callable[[str], int]:
    """Reads a whole number."""
    def read(text: str) -> int:
        if not text.isdecimal() or len(text) > 20 or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"{text} is no whole number from {least} to {most}")
        return int(text)
    return read


def _minutes(text: str) -> float:
    try:
        minutes = float(text)
    except ValueError:
        minutes = math.nan
    if not minutes > 0:
        raise argparse.ArgumentTypeError(f"{text} is no number above 0")
    return minutes


def words(arguments: Sequence[str]) -> list[str]:
    """The arguments with `study replay` as one word, the name of its parser."""
    if list(arguments[:2]) == ["study", "replay"]:
        return ["study replay", *arguments[2:]]
    return list(arguments)


def guarded(act: Callable[[argparse.Namespace], int], chosen: argparse.Namespace) -> int:
    """The exit status of a command; says what went wrong with the files."""
    def stop(*_: object) -> None:
        raise KeyboardInterrupt
    before = signal.signal(signal.SIGTERM, stop)
    try:
        return act(chosen)
    except NotWritten as error:
        print(f"repel: {error}", file=sys.stderr)
        return NOT_WHOLE
    finally:
        signal.signal(signal.SIGTERM, before)


def _run_study(chosen: argparse.Namespace) -> int:
    return guarded(_study, chosen)


def _study(chosen: argparse.Namespace) -> int:
    study = read_study(chosen.study, chosen.runs)
    with Store(chosen.out, study, chosen.resume) as store:
        missing = store.missing
        progress = Progress(study.runs, study.runs - len(missing), chosen.quiet)
        if chosen.resume and not chosen.quiet:
            progress.say(f"{len(missing)} of {study.runs} runs are missing")
        again = shlex.join(["repel", "study", chosen.study, "--out", chosen.out, "--resume"]
                           + (["--runs", str(chosen.runs)] if chosen.runs else []))
        try:
            try:
                if missing:
                    with engine(chosen.workers, chosen.scheduler, progress.say) as workers:
                        for made in workers.made(study, missing):
                            progress.add(*(0, 0) if made is None else _counts(made.rows))
                            if made is not None:
                                store.add(made.rows)
            finally:
                progress.end()
                store.flush()
            results = store.finish()
            summary = report.write(store.folder, study, results)
        except KeyboardInterrupt:
            progress.say(f"stopped with {study.runs - len(store.missing)} of {study.runs} runs; to "
                         f"go on: {again}")
            return NOT_WHOLE
        except SetupError:
            store.discard()
            raise
        except NotWritten as error:
            progress.say(f"{error}; what was written before is sound; to go on: {again}")
            return NOT_WHOLE
    if chosen.json:
        print(json.dumps(summary, indent=2))
    elif not chosen.quiet:
        print(report.as_text(summary))
        print(f"{store.folder / 'report.html'}, summary.json, results.parquet")
    return HELD if summary["failed"] == 0 else NOT_HELD


def _counts(rows: Any) -> tuple[int, int]:
    """How many, and how many of them did not hold."""
    held = rows["held"].to_numpy()
    return len(held), int(len(held) - held.sum())


def _replay(chosen: argparse.Namespace) -> int:
    study = read_study(chosen.study, chosen.runs)
    if chosen.index >= study.runs:
        raise SetupError(f"{chosen.study} has no run {chosen.index}; allowed: 0 to "
                         f"{study.runs - 1}, or --runs as the study was made")
    if chosen.print:
        folder = Path(tempfile.mkdtemp(prefix="repel-replay-"))  # stays, as the line needs it
        print(shlex.join(_line(study, chosen, folder)))
        return 0
    with tempfile.TemporaryDirectory(prefix="repel-replay-") as made:
        with subprocess.Popen(_line(study, chosen, Path(made))) as child:
            while True:
                try:
                    return child.wait()
                except KeyboardInterrupt:
                    pass  # the child got it too; it fades its forces and ends by itself


def _line(study: Study, chosen: argparse.Namespace, folder: Path) -> list[str]:
    line = study.command(chosen.index, folder)
    if chosen.view:  # by the clock, as nobody sees it otherwise
        line = [*(word for word in line if word != "--fast"), "--view"]
    return [*line, *(["--log", chosen.log] if chosen.log else [])]


def _falsify(chosen: argparse.Namespace) -> int:
    return guarded(_search, chosen)


def _search(chosen: argparse.Namespace) -> int:
    study = read_study(chosen.study)
    folder = Path(chosen.out or f"{Path(chosen.study).stem}_falsified")
    if (folder / "falsify.json").exists():
        raise SetupError(f"{folder}: has what a search found; allowed: another --out", str(folder))
    progress = Progress(chosen.runs, quiet=chosen.quiet)
    try:
        with engine(chosen.workers, chosen.scheduler, progress.say) as workers:
            try_to_write(folder)
            found = falsify.search(
                study, workers, runs=chosen.runs, seconds=60 * chosen.minutes,
                seed=chosen.seed, every=chosen.all, compare=chosen.compare, tick=progress.add)
    except KeyboardInterrupt:
        progress.say("stopped; nothing was written")
        return NOT_WHOLE
    finally:
        progress.end()
    status = NOT_HELD if found.failed else HELD
    try:
        summary = falsify.write(folder, study, found)
    except NotWritten as error:
        elsewhere = Path(tempfile.mkdtemp(prefix="repel-falsify-"))
        summary = falsify.write(elsewhere, study, found)
        progress.say(f"{error}; what the search found is in {elsewhere}")
        status = NOT_WHOLE
    if chosen.json:
        print(json.dumps(summary, indent=2))
    elif not chosen.quiet:
        print(falsify.as_text(summary))
    return status


def main(arguments: list[str] | None = None) -> int:
    """These commands alone."""
    parser = argparse.ArgumentParser(prog="repel")
    add_to(parser.add_subparsers(required=True, metavar="COMMAND"))
    chosen = parser.parse_args(words(sys.argv[1:] if arguments is None else arguments))
    try:
        status: int = chosen.act(chosen)
    except SetupError as error:
        print(f"repel: {error}", file=sys.stderr)
        return BAD
    return status
