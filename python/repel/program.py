# SPDX-License-Identifier: BSD-3-Clause
"""Runs scenes."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tempfile
import webbrowser
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from . import _repel
from ._errors import SetupError, how_to_have
from ._scenes import path_of
from .description import _check_all

if TYPE_CHECKING:
    from ._repel import Command, Tick

    Hands: TypeAlias = Command | Sequence[Command | None] | None

#: What the exit codes of the program say beside "it ran".
_REFUSED = (1, 2)


def program() -> str:
    """The path of the program `teleop`: what the environment variable REPEL_TELEOP names, or the
    one in this package, or the first on PATH."""
    named = os.environ.get("REPEL_TELEOP")
    if named:
        if not os.access(named, os.X_OK):
            raise SetupError(f"REPEL_TELEOP is {named}, which is no program")
        return named
    packaged = Path(__file__).with_name("bin") / "teleop"
    if os.access(packaged, os.X_OK):
        return str(packaged)
    found = shutil.which("teleop")
    if found:
        return found
    raise SetupError("the program teleop is not here; allowed: its path in REPEL_TELEOP (./run in "
                     "the sources builds build/release/bin/teleop), or teleop on PATH; or build the "
                     f"package with it: {how_to_have('teleop')}")


def _path_of(scene: Any) -> str:
    """Of a Scene, a path, or the name of a scene that the program knows."""
    return str(getattr(scene, "file", scene))


def _refusal(text: str, status: int) -> SetupError:
    message = text.strip().removeprefix("teleop: ") or f"teleop ended with status {status}"
    place = re.match(r"(.+?):(\d+): ", message)
    return SetupError(message, place[1] if place else "", int(place[2]) if place else 0)


def run(scene: Any, *, seconds: float = 20.0, fast: bool = True, rate_hz: float | None = None,
        backend: str | None = None, log: str | os.PathLike[str] | None = None,
        on_tick: Callable[[list[Tick]], Hands] | None = None, every: int = 1, stop: Any = None,
        hands: Sequence[Any] = (), arguments: Sequence[str] = ()) -> dict[str, Any]:
    """Runs a scene and returns its report, the object that `teleop run --report` writes.

    scene: a Scene, the path of a scene file, or the name of one that comes with the package.
    seconds [s] of scene time. fast: not by the clock, bitwise repeatable, and the same bits as
    `teleop run --fast`. log: a file for every tick, a recording if its name ends in .mcap, else
    CSV; see read_recording. on_tick: called after each `every` ticks with the list of the ticks of
    all arms. It may return what operators do until it is called again, in place of the script: a
    Command of the first arm, or a list with a Command or None for each arm; None: the script goes
    on. What it raises ends the run and is raised here. stop: an Event of threading; once it is set the
    forces fade and the run ends. hands: by arm, what its operator does in place of the script, an
    array (rows, 7) or (rows, 11) with the columns of `teleop run --hand` (docs/recording.md): [s],
    three [m/s], three [rad/s], and of a lever [rad/s] and its direction. arguments: further ones of
    `teleop run --help`. With one beyond its groups Run, Arm and Walls, and in a build without runs,
    the program runs as a child, without on_tick, stop and hands.

    The report has the key `exit_status`: 0, or 3 to 5 where docs/recording.md says what happened.
    Raises SetupError if the scene cannot be run.
    """
    _check_all("arguments", arguments, str)
    if log is not None and not os.fspath(log):
        raise SetupError("log is ''; allowed: the name of a file, or None")
    if not _is_inside(arguments):
        if on_tick is not None or stop is not None or len(hands) > 0:
            raise SetupError(
                "on_tick, stop and hands go without arguments of views, links and files"
                if hasattr(_repel, "run_scene") else
                f"on_tick, stop and hands are not in this build: {how_to_have('teleop')}")
        return _run_child(scene, seconds, fast, rate_hz, backend, log, arguments)
    text, status = _repel.run_scene(
        path_of(getattr(scene, "file", scene)), seconds=seconds, fast=fast, rate_hz=rate_hz,
        backend=backend, log="" if log is None else os.fspath(log), on_tick=on_tick,
        every=every, stop=stop, arguments=list(arguments), hands=list(hands))
    return {**json.loads(text), "exit_status": status}


def _is_inside(arguments: Sequence[str]) -> bool:
    """Whether a run with these words needs no program as a child."""
    if not hasattr(_repel, "run_scene"):
        return False
    known = _repel.run_words()
    return all(word.partition("=")[0] in known for word in arguments if word.startswith("--"))


def _run_child(scene: Any, seconds: float, fast: bool, rate_hz: float | None, backend: str | None,
               log: str | os.PathLike[str] | None, arguments: Sequence[str]) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [program(), "run", _path_of(scene), "--seconds", repr(float(seconds)), "--report",
                   str(report)]
        command += ["--fast"] if fast else []
        command += ["--rate", repr(float(rate_hz))] if rate_hz is not None else []
        command += ["--backend", backend] if backend is not None else []
        command += ["--log", os.fspath(log)] if log is not None else []
        done = subprocess.run([*command, *arguments], capture_output=True, text=True, check=False)
        if done.returncode < 0 or done.returncode in _REFUSED or not report.exists():
            raise _refusal(done.stderr or done.stdout, done.returncode)
        return {**json.loads(report.read_text()), "exit_status": done.returncode}


def view(scene: Any, arguments: Sequence[str] = (), browser: bool = True) -> int:
    """Runs a scene in the live view until it is stopped, with the page in the browser. Returns the
    exit status of the program."""
    command = [program(), "run", _path_of(scene), "--view", *arguments]
    shown = not browser
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True) as running:
        assert running.stdout is not None
        try:
            for line in running.stdout:
                print(line, end="", flush=True)
                address = re.search(r"https?://\S+", line)
                if address and not shown:
                    shown = webbrowser.open(address[0])
        except KeyboardInterrupt:
            print(running.communicate()[0], end="")  # it fades its forces and ends by itself
        return running.wait()
