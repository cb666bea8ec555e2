# SPDX-License-Identifier: BSD-3-Clause
"""The files that the runs of a study read: which they are, and whether they are as they were.

Which they are is told by the names in them: a scene names robots, meshes and packages, a robot
meshes and further files. A name that is no file is another word.
"""

from __future__ import annotations

import glob
import hashlib
import itertools
import os
import platform
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from .._errors import needed
from .._scenes import FOLDER

_OURS = "repel:/"  # begins the path of a file of the package, which other machines have elsewhere
_SHARE = f"{FOLDER.parent}/"
_MOST_BYTES = 1 << 24  # of a file whose names are read, as scenes have at most
_DEEPEST = 4  # levels of folders below one of packages, as robots are searched
_seen: dict[str, tuple[tuple[int, ...], str]] = {}  # by path: what stat told, and the digest


class CannotRun(Exception):
    """A run that cannot be made here, whatever its values are: it has no row."""


def anywhere(path: str) -> str:
    """The path as every machine has it."""
    return _OURS + path[len(_SHARE):] if path.startswith(_SHARE) else path


def here(path: str) -> str:
    """The path on this machine of what `anywhere` returned."""
    return _SHARE + path[len(_OURS):] if path.startswith(_OURS) else path


def read_by(scene: str, texts: Iterable[str], folder: str) -> dict[str, str]:
    """The files that runs of a scene read, with their digests. texts: values that are set in it,
    whose paths may be relative to `folder`, too."""
    found = {anywhere(scene): _digest_of(scene)}
    named: list[str] = []  # folders, of packages and of recorded images
    todo: list[tuple[str, list[str]]] = []
    for text, folders in ((_text_of(scene), [os.path.dirname(scene)]),
                          *((text, [os.path.dirname(scene), folder]) for text in texts)):
        words = _words_of_yaml(text)
        named += _folders_of(words, folders)
        todo += [(each, []) for word in words for each in _files_of(word, folders, named)]
    for each in named:
        if os.path.isfile(os.path.join(each, "camera.yaml")):
            inside = glob.glob(f"{glob.escape(each)}/**", recursive=True)
            todo += [(file, []) for file in sorted(inside) if os.path.isfile(file)]
    while todo:
        path, folders = todo.pop(0)
        if anywhere(path) in found:
            continue
        for each in (path, f"{path}.parts.yaml"):  # the parts of a mesh, also if they come later
            found[anywhere(each)] = _digest_of(each)
        words = _words_of_xml(_text_of(path))
        folders = list(dict.fromkeys([*folders, os.path.dirname(path)]))
        folders += _folders_of(words, folders)  # as the meshdir of MJCF
        todo += [(each, folders) for word in words for each in _files_of(word, folders, named)]
    return found


def require_same(digests: Mapping[str, str]) -> None:
    """Raises CannotRun unless the files are those of `read_by`. Reads what has changed by stat."""
    for path, digest in digests.items():
        found = _digest_of(here(path))
        if found != digest:
            what = "is missing" if not found else "is not as it was when the study began"
            raise CannotRun(f"{here(path)} {what}, on {platform.node()}; allowed: the files of the "
                            "beginning, on all workers, until the end")


def _digest_of(path: str) -> str:
    """Of what the file has; empty: it cannot be read."""
    try:
        about = os.stat(path)
        stamp = (about.st_mtime_ns, about.st_ctime_ns, about.st_size, about.st_ino)
        if _seen.get(path, ((), ""))[0] != stamp:
            _seen[path] = stamp, hashlib.blake2b(Path(path).read_bytes()).hexdigest()
    except OSError:
        return ""
    return _seen[path][1]


def _text_of(path: str) -> str:
    try:
        if os.path.getsize(path) <= _MOST_BYTES:
            return Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        pass  # a mesh; whoever needs a text says that it is none
    return ""


def _words_of_yaml(text: str) -> list[str]:
    yaml = needed("yaml", "PyYAML", extra="study")
    try:
        return [text, *(each.value for each in yaml.scan(text)
                        if isinstance(each, yaml.ScalarToken))]
    except yaml.YAMLError:
        return [text]


def _words_of_xml(text: str) -> list[str]:
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError):
        return []
    return list(dict.fromkeys(word for each in root.iter()
                              for word in ((each.text or "").strip(), *each.attrib.values())))


def _joined(folders: Iterable[str], word: str) -> list[str]:
    """The places of a path relative to the folders, each once."""
    if not 0 < len(word) < 4096 or "\0" in word:
        return []
    return list(dict.fromkeys(os.path.join(folder, word) for folder in folders))


def _folders_of(words: Iterable[str], folders: Sequence[str]) -> list[str]:
    return [each for word in words for each in _joined(folders, word) if os.path.isdir(each)]


def _files_of(word: str, folders: Sequence[str], packages: Sequence[str]) -> list[str]:
    """The files that a word may mean."""
    scheme, _, rest = word.rpartition("://")
    if scheme not in ("package", "model"):
        places = _joined(folders, rest)
    else:
        places = _in_packages(rest, folders, packages)
        places += [os.path.join(each, "model.config") for each in places]  # of a model's folder
    return [each for each in places if os.path.isfile(each)]


def _in_packages(rest: str, folders: Sequence[str], packages: Sequence[str]) -> list[str]:
    """Where NAME/PATH may be: below folders of packages, and in all above. The folder of a package
    may have another name."""
    above = [os.fspath(each) for folder in folders for each in Path(folder, "x").parents]
    for path in filter(None, (rest, rest.partition("/")[2])):
        found = [each for each in _joined(above, path) if os.path.exists(each)]
        for top, depth in itertools.product(packages, range(_DEEPEST + 1)):
            found += sorted(glob.glob(f"{glob.escape(top)}{'/*' * depth}/{glob.escape(path)}"))
        if found:
            return found
    return []
