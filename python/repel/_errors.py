# SPDX-License-Identifier: BSD-3-Clause
"""The exception of the package, and what is said of a part that a build goes without."""

from __future__ import annotations

import importlib
from typing import Any

from ._left_out import PACKAGES


class SetupError(ValueError):
    """An error in an input: what is wrong, where, the value found and what is allowed.

    `file` and `line` say where it is, if it is in a file; otherwise they are empty and 0.
    """

    def __init__(self, message: str, file: str = "", line: int = 0):
        super().__init__(message)
        self.file = file
        self.line = line


def how_to_have(part: str) -> str:
    """What to install before the package is built again, for it to have that part."""
    if part not in PACKAGES:
        return "its part was switched off when this was built"
    return f"to have it: apt-get install {PACKAGES[part]}, then pip install . again"


def needed(module: str, package: str | None = None, *, extra: str) -> Any:
    """A module of an optional package. Raises SetupError with the command that installs it.

    extra: what the package is part of, in the optional dependencies of this one.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = package or module
        raise SetupError(f"{package} is not installed; to have it: pip install {package}, or "
                         f"pip install 'repel-haptics[{extra}]'") from error
