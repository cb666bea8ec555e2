#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""options.py [--check] [FOLDER]: writes docs/options.md from what the programs in FOLDER,
build/release/bin by default, say with --help. With --check, compares it instead, for the programs
that are there; exit code 77 if none is."""

import re
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/options.md"
GROUPS = {f"{name}:" for name in ("Positionals", "Options", "Commands", "Run", "Arm", "Walls",
                                  "View", "Link", "Files")}
PROGRAMS = ["teleop", "qualify", "robot_info", "step_response", "cover", "deadline"]
HEAD = """<!-- SPDX-License-Identifier: BSD-3-Clause -->

# Options of the programs

Written by `docs/site --options` from what each program says with `--help`; a test compares. `./run`
builds `teleop` and passes its arguments on. The keys of scene files are on
[scenes/README.md](../scenes/README.md).
"""


def help_of(folder, program):
    """Of a program, or of one of its commands."""
    words = program.split()
    out = subprocess.run([Path(folder) / words[0], *words[1:], "--help"], text=True,
                         capture_output=True)
    if out.returncode or not out.stdout:
        sys.exit(f"options.py: {folder}/{program} --help: {out.stderr or 'says nothing'}")
    return out.stdout


def with_commands(folder, program):
    """The program, and its commands as `teleop run`."""
    block = re.search(r"(?m)^Commands:\n((?:  .*\n)+)", help_of(folder, program))
    commands = re.findall(r"(?m)^  (\S+)", block[1]) if block else []
    return [program, *(f"{program} {command}" for command in commands)]


def entries(lines):
    """Options and what is said of them, from column 30, beside each or below it."""
    found = []
    for line in lines:
        if re.match(r"  \S", line):
            found.append((line[2:], "") if line[28:30].strip() or len(line) < 30 else
                         (line[:30].strip(), line[30:]))
        else:
            head, text = found.pop()
            found.append((head, f"{text} {line.strip()}".strip()))
    return found


def in_words(value):
    """What an option takes, without the names of types."""
    value = re.sub(r"^(TEXT|FLOAT|UINT|INT):(?=.)", "", value).replace("FLOAT [UNIT]:", "")
    value = re.sub(r"INT in \[(\S+) - (\S+)\]", r"\1 to \2", value)
    value = re.sub(r"\{(.*)\}", lambda names: names[1].replace(",", ", "), value)
    value = re.sub(r"^([A-Z]+|X \[Y Z\]):(?=[-\da-z])", r"\1, ", value)
    return {"TEXT": "text", "UINT": "whole number"}.get(value, value.replace(" REQUIRED", ""))


def row(head, text):
    names, _, rest = head.partition(" ")
    names = names.replace("{false}", "").split(",")
    rest, _, excludes = rest.partition("Excludes:")
    rest, _, needs = rest.partition("Needs:")
    value, default = re.match(r"((?:[^=\[]|\[[^\]]*\])*)(?:=(.*))?$", rest.strip()).groups()
    more = [text]
    if needs.strip():
        more.append("Needs " + ", ".join(f"`{name}`" for name in needs.split()) + ".")
    if excludes.strip():
        more.append("Not with " + ", ".join(f"`{name}`" for name in excludes.split()) + ".")
    if len(more) > 1 and not text.endswith("."):
        more[0] += "."
    cells = [", ".join(f"`{name}`" for name in names), in_words(value.strip()),
             f"`{default.removesuffix(' ...')}`" if default else "", " ".join(more)]
    return "| " + " | ".join(cell.replace("|", "\\|").replace("<", "&lt;") for cell in cells) + " |"


def section(program, said):
    """A heading, what the program is for, a table, and what stands below its options."""
    blocks = re.split(r"\n\n+", said.strip())
    purpose = blocks[0].split("\nUsage: ")
    text = [f"## {program}", "", textwrap.fill(purpose[0], 100), "", f"    {purpose[1].strip()}", "",
            "| option | value | default | meaning |", "|---|---|---|---|"]
    below = []
    for block in blocks[1:]:
        title = block.split("\n")[0]
        if title in GROUPS:
            text += [row(head, said) for head, said in entries(block.split("\n")[1:])]
        elif title != "Scenes:":  # those that are installed: scenes/README.md
            below += [*(f"    {line}".rstrip() for line in block.split("\n")), ""]
    return "\n".join([*text, "", *below]).rstrip() + "\n"


def main(arguments):
    check = "--check" in arguments
    folder = Path(([a for a in arguments if a != "--check"] or [ROOT / "build/release/bin"])[0])
    programs = [each for program in PROGRAMS if not check or (folder / program).is_file()
                for each in with_commands(folder, program)]
    sections = [section(p, help_of(folder, p)) for p in programs]
    if not check:
        PAGE.write_text("\n".join([HEAD, *sections]))
        return 0
    page = PAGE.read_text()
    for text in sections:
        if f"\n{text}" not in page:
            print(f"docs/options.md is not what {text.split()[1]} says: docs/site --options writes it")
            return 1
    return 0 if sections else 77


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
