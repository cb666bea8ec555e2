# SPDX-License-Identifier: BSD-3-Clause
"""The scenes that the package has, and the page of the live view."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ._errors import SetupError

_SHARE = Path(__file__).with_name("share") / "repel"
FOLDER = _SHARE / "scenes"
PAGE = str(_SHARE / "page")


def names() -> list[str]:
    return sorted(each.stem for each in FOLDER.glob("*.yaml"))


def path_of(scene: Any) -> str:
    """Of a path, or of the name of a scene in the package, as the program `teleop` takes it."""
    path = os.fspath(scene)
    shipped = FOLDER / f"{path}.yaml"
    if os.path.exists(path) or os.path.basename(path) != path or path.endswith(".yaml"):
        return path  # whoever opens it says what is wrong with it
    if not shipped.is_file():
        raise SetupError(f"{path or repr('')}: no such scene; allowed: a file, or one of "
                         f"{', '.join(names())}", path)
    return str(shipped)
