# SPDX-License-Identifier: BSD-3-Clause
"""The exception of the package."""


class SetupError(ValueError):
    """An error in an input: what is wrong, where, the value found and what is allowed.

    `file` and `line` say where it is, if it is in a file; otherwise they are empty and 0.
    """

    def __init__(self, message: str, file: str = "", line: int = 0):
        super().__init__(message)
        self.file = file
        self.line = line
