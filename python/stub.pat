# SPDX-License-Identifier: BSD-3-Clause
# What the stub says in place of what it is told by values.
_repel.QUERY_ENDS:
    QUERY_ENDS: tuple[str, ...]

_repel.Tick.FIELDS:
    FIELDS: tuple[str, ...]
