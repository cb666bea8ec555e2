# SPDX-License-Identifier: BSD-3-Clause
"""Convex parts of meshes."""

import numpy as np
import pytest

import repel

pytestmark = pytest.mark.skipif(not hasattr(repel, "cover"), reason="built without covers")


def corner():
    """An L: a prism that is not convex."""
    outline = np.array([[0, 0], [0.2, 0], [0.2, 0.1], [0.1, 0.1], [0.1, 0.2], [0, 0.2]])
    vertices = np.concatenate([np.c_[outline, np.full(6, z)] for z in (0.0, 0.1)])
    fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]
    triangles = [[c, b, a] for a, b, c in fan] + [[a + 6, b + 6, c + 6] for a, b, c in fan]
    for i in range(6):
        k = (i + 1) % 6
        triangles += [[i, k, k + 6], [i, k + 6, i + 6]]
    return vertices, np.array(triangles)


def test_a_mesh_is_covered_by_convex_parts():
    vertices, triangles = corner()
    cover = repel.cover(vertices, triangles, error=1e-3)
    assert cover.is_closed and cover.faults == [] and len(cover.parts) >= 2
    assert cover.excess_m <= 1e-3 and cover.uncovered_m <= 1e-6
    shapes = [repel.Shape.hull(part) for part in cover.parts]
    X = np.eye(4)
    X[:3, 3] = 0.15, 0.15, 0.05  # in the notch, 0.05 m from its sides
    point = repel.Shape.sphere(0.0)
    nearest = min(repel.separation(point, X, shape, np.eye(4)).distance for shape in shapes)
    assert nearest == pytest.approx(0.05, abs=1.1e-3)


@pytest.mark.parametrize("change, kind, words", [
    ({"vertices": np.zeros((4, 2))}, ValueError, r"vertices: expected points \(N, 3\)"),
    ({"triangles": [[0, 1, 99]]}, repel.SetupError, r"triangles\[0\] is 99; allowed: 0 to 11"),
    ({"triangles": np.zeros((0, 3))}, repel.SetupError, "triangle"),
    ({"engine": "saw"}, repel.SetupError, "engine is 'saw'; allowed: automatic"),
    ({"error": -1.0}, repel.SetupError, "error"),
])
def test_what_cannot_be_covered_is_refused(change, kind, words):
    vertices, triangles = corner()
    with pytest.raises(kind, match=words):
        repel.cover(**{"vertices": vertices, "triangles": triangles, **change})
