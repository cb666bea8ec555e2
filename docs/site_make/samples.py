#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""samples.py: checks the code and the commands that the pages show, as they stand there.

A ```cpp fence with a main is compiled; where the page says what it prints, it is run and must print
that. A fragment that stands in a file of examples/ is compiled with it. Any other fragment becomes
the body of a function, behind what tests/samples/PAGE.hpp declares. A ```python fence must be valid
and use names that exist. A ```yaml fence, or an indented block that begins with a key of scenes, is
loaded where teleop has been built: as a scene, or in place of the same keys of the scene that
scenes/README.md shows. There `- ...` stands for the modules that follow. A command of a program of
this repository has options of docs/options.md."""

import ast
import os
import re
import shlex
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build/site_work/samples"
INCLUDES = ["core", "control", "robots", *sorted(f"backends/{p.name}" for p in (ROOT / "backends").iterdir()
                                            if (p / "repel").is_dir())]
EIGEN = os.environ.get("REPEL_EIGEN", "/usr/include/eigen3")
FLAGS = ["-std=c++20", "-Wall", "-Werror", "-Wno-unused", f"-I{ROOT}/tests/samples",
         "-isystem", EIGEN, *(f"-I{ROOT}/{folder}" for folder in INCLUDES)]
COMPILER = [os.environ.get("CXX", "g++")]
CACHED = ["ccache", *COMPILER] if shutil.which("ccache") else COMPILER
PROGRAMS = {"./run": "teleop"} | {name: name for name in
                                  ("teleop", "qualify", "robot_info", "cover", "deadline")}


class Fence:
    """A fenced block: its page, line, language and text, and the text of the page behind it."""

    def __init__(self, page, line, language, text, behind):
        self.page, self.line, self.language, self.text, self.behind = (
            page, line, language, text, behind)

    def __str__(self):
        return f"{self.page}:{self.line}"


def pages():
    out = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "*.md"], cwd=ROOT,
                         text=True, capture_output=True, check=True).stdout
    return [p for p in out.splitlines() if not p.startswith("tests/") and (ROOT / p).is_file()]


def fences_of(page):
    lines = (ROOT / page).read_text().split("\n")
    begin = None
    for number, line in enumerate(lines):
        mark = re.match(r" *```(\w*)", line)
        if mark and begin is None:
            begin, language = number, mark[1]
        elif mark:
            behind = "\n".join(lines[number + 1:])
            text = "\n".join(lines[begin + 1:number]) + "\n"
            yield Fence(page, begin + 2, language, text, behind)
            begin = None


def flush_left(text):
    return "".join(line.strip() + "\n" for line in text.splitlines())


def said_to_print(fence):
    """The output that the page gives for a program: the indented block below a line of its text
    that ends in `prints`, before the next fence or heading."""
    rest = re.split(r"(?m)^(?:#|```)", fence.behind)[0]
    found = re.search(r"prints\n\n((?:    .*\n)+)", rest)
    return re.sub(r"(?m)^    ", "", found[1]) if found else None


def errors_of(*command):
    run = subprocess.run(command, text=True, capture_output=True)
    return run.stderr or f"{command[0]} fails" if run.returncode else ""


def errors_in(name, text):
    """The errors of compiling a text; none when there are none."""
    path = WORK / f"{name}.cpp"
    path.write_text(text)
    return errors_of(*COMPILER, *FLAGS, "-fsyntax-only", path)


def is_of_the_machine(text):
    """Whether it includes a header that stands in control/, not in core/."""
    return any((ROOT / "control" / header).is_file()
               for header in re.findall(r"#include <(repel/[^>]+)>", text))


def check_program(fence):
    name = f"{fence.page.replace('/', '.')}.{fence.line}"
    text = f'#line {fence.line} "{fence.page}"\n{fence.text}'
    wanted = said_to_print(fence)
    if wanted is None:
        return errors_in(name, text)
    source, unit, machine, binary = (WORK / f"{name}{end}"
                                     for end in (".cpp", ".o", ".machine.o", ".bin"))
    source.write_text(text)
    errors = errors_of(*CACHED, *FLAGS, "-c", source, "-o", unit)
    parts = [unit]
    if not errors and is_of_the_machine(text):
        errors = errors_of(*CACHED, *FLAGS, "-c", ROOT / "control/repel/control.cpp", "-o", machine)
        parts.append(machine)
    errors = errors or errors_of(*COMPILER, *parts, "-o", binary, "-lpthread")
    if errors:
        return errors
    said = subprocess.run([binary], text=True, capture_output=True, timeout=60)
    if said.returncode or said.stdout != wanted:
        return f"{fence}: it prints\n{said.stdout}and not, as the page says,\n{wanted}"
    return ""


def check_fragments(page, fences):
    """All fragments of a page in one file, each the body of a function."""
    preamble = page.replace("/", ".").removesuffix(".md") + ".hpp"
    if not (ROOT / "tests/samples" / preamble).is_file():
        return (f"{fences[0]}: neither a whole program nor in a file of examples/, and "
                f"tests/samples/{preamble} does not exist; see docs/site_make/samples.py")
    includes, bodies = [], []
    for fence in fences:
        includes += re.findall(r"(?m)^#include .*$", fence.text)
        body = re.sub(r"(?m)^#include .*$", "", fence.text)
        bodies.append(f'[[maybe_unused]] static void at_line_{fence.line}() {{\n'
                      f'#line {fence.line} "{page}"\n{body}}}\n')
    text = "\n".join([*includes, f'#include "{preamble}"', *bodies])
    return errors_in(page.replace("/", "."), text)


def check_python(fence):
    try:
        tree = ast.parse(fence.text)
        compile(tree, str(fence), "exec")
    except SyntaxError as error:
        return f"{fence}: {error}"
    known = set(re.findall(r"\w+", "".join(
        p.read_text() for p in (ROOT / "python/repel").glob("__init__.py*"))))
    used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Name) and node.value.id == "repel"}
    return "".join(f"{fence}: repel.{name} does not exist\n" for name in sorted(used - known))


def blocks_of(page):
    """Indented blocks that begin with a key of scenes, as fences of YAML."""
    text = (ROOT / page).read_text()
    begin = r"(?m)^    (?:robot|laws|network|obstacles|script):\n"
    for found in re.finditer(begin + r"(?:    .*\n)+", text):
        line = text.count("\n", 0, found.start()) + 1
        yield Fence(page, line, "yaml", re.sub(r"(?m)^    ", "", found[0]), "")


def keys_of(scene):
    """The top-level keys of a scene, each with its lines."""
    return {re.match(r"\w+", part)[0]: part for part in re.split(r"(?m)^(?=\w+:)", scene) if part}


def whole_scene(text):
    """A scene, or the frame with the keys of a fragment in it."""
    if re.search(r"(?m)^ +urdf:", text):
        return text
    frame, given = keys_of(next(fences_of("scenes/README.md")).text), keys_of(text)
    if "network" in given:
        modules = frame["network"].splitlines(True)
        kbb2 = next(i for i, line in enumerate(modules) if "kbb2" in line)
        rest = modules[kbb2 + ("kbb2" in given["network"]):]
        given["network"] = re.sub(r"(?m)^.*- \.\.\.\n", "".join(rest), given["network"])
        frame.pop("script")  # of other masters
    frame["laws"] = re.sub(", damping: [^,}]*", "", frame["laws"])  # as much as its robot needs
    if "robot" in given:
        given["robot"] = frame["robot"] + given["robot"].split("\n", 1)[1]
    return "".join((frame | given).values())


def check_scene(fence):
    """None where it is of other files, or where it cannot be loaded here."""
    teleop = ROOT / "build/release/bin/teleop"
    if not re.match(r"[\w ]+:", fence.text) or not teleop.is_file():
        return None
    path = WORK / f"{fence.page.replace('/', '.')}.{fence.line}.yaml"
    text = whole_scene(fence.text).replace("../robots/", f"{ROOT}/robots/")
    # A file that is only named is like one that is there.
    mesh = ROOT / "scenes/meshes/glove_box_glass.stl"
    path.write_text(re.sub(r"file: \w+\.stl", f"file: {mesh}", text))
    run = subprocess.run([teleop, "check", path], text=True, capture_output=True)
    return f"{fence}: {run.stderr}" if run.returncode else ""


def commands_of(page):
    """Commands in code: whole lines of blocks, and what stands between backquotes."""
    for number, line in enumerate((ROOT / page).read_text().split("\n"), 1):
        found = [line] if re.match(r"    |\$ |\./", line) else re.findall(r"`([^`]+)`", line)
        for text in found:
            text = re.sub(r"^ *(?:\$ )?(?:build/release/bin/)?", "", text)
            if re.match(r"(\./run|\w+) +.*--\w", text) and text.split()[0] in PROGRAMS:
                yield number, re.split(r"  +#| # |\||;|&&", text)[0]


def known_options():
    """The options of each program by docs/options.md."""
    known, program = {}, None
    for line in (ROOT / "docs/options.md").read_text().split("\n"):
        if line.startswith("## "):
            program = line[3:].strip("` ")
        elif line.startswith("| `-"):
            known.setdefault(program, set()).update(re.findall(r"-[-\w]+", line.split("|")[1]))
    return known


def check_commands(known):
    wrong, count = [], 0
    for page in pages():
        if page in {"CHANGELOG.md", "docs/options.md"}:
            continue
        for number, command in commands_of(page):
            try:
                words = shlex.split(command)
            except ValueError:
                words = command.split()
            program = PROGRAMS[words[0]]
            if program == "teleop":  # without a command it is run
                named = f"teleop {words[1]}"
                program = named if named in known else "teleop run"
            count += 1
            wrong += [f"{page}:{number}: {program} has no option {word.split('=')[0]}"
                      for word in words[1:] if word.startswith("--")
                      and word.rstrip(",.").split("=")[0] not in known.get(program, {"--help"})]
    return wrong, count


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    shown = "".join(flush_left(p.read_text()) for p in sorted((ROOT / "examples").rglob("*.[ch]pp")))
    fences = [fence for page in pages() for fence in fences_of(page)]
    cpp = [fence for fence in fences if fence.language == "cpp"]
    programs = [fence for fence in cpp if "int main(" in fence.text]
    examples = [f for f in cpp if f not in programs and flush_left(f.text) in shown]
    fragments = {}
    for fence in cpp:
        if fence not in programs and fence not in examples:
            fragments.setdefault(fence.page, []).append(fence)
    with ThreadPoolExecutor(2) as pool:
        wrong = [*pool.map(check_program, programs),
                 *pool.map(lambda page: check_fragments(page, fragments[page]), fragments)]
    python = [check_python(fence) for fence in fences if fence.language == "python"]
    yaml = [fence for fence in fences if fence.language == "yaml"]
    yaml += [block for page in pages() for block in blocks_of(page)]
    scenes = [check_scene(fence) for fence in yaml]
    commands, count = check_commands(known_options())
    wrong = [text for text in wrong + python + scenes + commands if text]
    print("\n".join(wrong), end="\n" if wrong else "")
    run = sum(said_to_print(fence) is not None for fence in programs)
    print(f"{len(cpp)} samples of C++: {len(programs)} programs ({run} run, with the output of the "
          f"page), {len(examples)} from examples/, {sum(map(len, fragments.values()))} fragments; "
          f"{len(python)} of Python, {sum(s is not None for s in scenes)} of scenes; {count} commands; "
          f"{len(wrong)} wrong")
    return 1 if wrong or not cpp or not count else 0


if __name__ == "__main__":
    sys.exit(main())
