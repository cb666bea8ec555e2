# SPDX-License-Identifier: BSD-3-Clause
"""The signed distances of many pairs at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _repel

#: One row of what `separations` returns. Lengths in [m]; `end` is an index into `QUERY_ENDS`.
SEPARATION = np.dtype([("distance", "f8"), ("lower", "f8"), ("upper", "f8"), ("p_WA", "f8", 3),
                       ("p_WB", "f8", 3), ("extraction_W", "f8", 3), ("level", "i4"),
                       ("iterations", "i4"), ("end", "u1")], align=True)


def separations(shapes: Sequence[_repel.Shape], X_W: Any, pairs: Any, *,
                options: _repel.QueryOptions | None = None,
                warm: _repel.WarmStarts | None = None,
                out: np.ndarray | None = None) -> np.ndarray:
    """The signed distance of each pair, as one structured array of dtype `SEPARATION`.

    shapes: N of them. X_W [m]: their poses, (N, 4, 4), or positions (N, 3) and unit quaternions
    w x y z (N, 4). pairs: (M, 2) indices of shapes, A and B of each pair. warm: WarmStarts(M), kept
    by the caller from call to call. out: the array of an earlier call, to be used again.

    X_W may also be an array (B, N, 4, 4), which places all shapes B times: then the result is (B, M),
    and WarmStarts has B M rows. Row i has the same bits as `separation` gives for that pair. Other threads run
    meanwhile.
    """
    batch: tuple[int, ...] = ()
    if isinstance(X_W, np.ndarray) and X_W.ndim == 4:
        batch, X_W = X_W.shape[:1], X_W.reshape(-1, *X_W.shape[2:])
    for name, value, kind in (("options", options, _repel.QueryOptions),
                              ("warm", warm, _repel.WarmStarts)):
        if value is not None and not isinstance(value, kind):
            raise TypeError(f"{name}: expected {kind.__name__}, got {type(value).__name__}")
    index = np.asarray(pairs)
    if index.ndim != 2 or index.shape[1] != 2:
        raise ValueError(f"pairs: expected indices of shapes (M, 2), got shape {index.shape}")
    if index.dtype.kind not in "iu":
        raise TypeError(f"pairs: expected whole numbers, got {index.dtype}")
    if index.size and int(index.max()) > np.iinfo(np.int64).max:
        raise IndexError(f"pairs name shape {index.max()}; allowed: 0 to {len(shapes) - 1}")
    rows = (*batch, len(index))
    if out is None:
        out = np.empty(rows, SEPARATION)
    elif not isinstance(out, np.ndarray):
        raise TypeError(f"out: expected an array, got {type(out).__name__}")
    elif out.dtype != SEPARATION or out.shape != rows:
        raise ValueError(f"out: expected {' x '.join(map(str, rows))} rows of repel.SEPARATION, "
                         f"got {out.dtype} of shape {out.shape}")
    elif not out.flags.carray:
        raise ValueError("out: expected rows one after the other that may be written, got others")
    _repel._fill_separations(list(shapes), X_W, batch[0] if batch else None,
                             np.ascontiguousarray(index, np.int64),
                             _repel.QueryOptions() if options is None else options, warm,
                             out.reshape(-1).view(np.uint8))
    return out
