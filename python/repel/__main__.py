# SPDX-License-Identifier: BSD-3-Clause
"""python -m repel: runs scenes by the program `teleop`, views them in the browser, studies them."""

import argparse
import json
import sys

from . import SetupError, __version__, program, read_recording, run, view
from .study import command as study

EPILOGUE = """\
SCENE is a file, or the name of one that comes with the program. What follows -- goes to the
program: repel view SCENE -- --listen 127.0.0.1:0
"""


def parsed(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="repel", description=__doc__.split(": ", 1)[1],
                                     epilog=EPILOGUE,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    running = commands.add_parser("run", help="run a scene and print its report as JSON")
    running.add_argument("--seconds", type=float, default=20.0, help="of scene time [s]")
    pace = running.add_mutually_exclusive_group()
    pace.add_argument("--fast", action="store_true", help="not by the clock (the default)")
    pace.add_argument("--by-the-clock", action="store_true", help="in real time")
    running.add_argument("--log", metavar="FILE", help="every tick: .mcap a recording, else CSV")
    viewing = commands.add_parser("view", help="show a scene in the browser, until it is stopped")
    viewing.add_argument("--no-browser", action="store_true", help="only print the address")
    for each in (running, viewing):
        each.add_argument("scene", metavar="SCENE")
        each.add_argument("rest", nargs="*", metavar="-- ARGUMENT", help="for the program")
    reading = commands.add_parser("columns", help="list the columns of a log")
    reading.add_argument("file", metavar="FILE")
    commands.add_parser("program", help="print the path of the program")
    study.add_to(commands)
    return parser.parse_args(study.words(sys.argv[1:] if arguments is None else arguments))


def main(arguments: list[str] | None = None) -> int:
    chosen = parsed(arguments)
    try:
        if chosen.command == "run":
            report = run(chosen.scene, seconds=chosen.seconds, fast=not chosen.by_the_clock,
                         log=chosen.log, arguments=chosen.rest)
            print(json.dumps(report, indent=2))
            return int(report["exit_status"])
        if chosen.command == "view":
            return view(chosen.scene, chosen.rest, browser=not chosen.no_browser)
        if chosen.command == "columns":
            recording = read_recording(chosen.file)
            print(f"{recording.ticks} ticks", *recording, sep="\n")
        elif chosen.command == "program":
            print(program())
        else:
            return int(chosen.act(chosen))
    except SetupError as error:
        print(f"repel: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
