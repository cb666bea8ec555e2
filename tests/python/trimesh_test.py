# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of trimesh become shapes, and shapes become meshes of trimesh, as docs/python.md has it."""

import numpy as np
import pytest

import repel

trimesh = pytest.importorskip("trimesh", reason="to have it: pip install trimesh")
EYE = np.eye(4)


def mesh_of(shape, level=0):
    return trimesh.Trimesh(*shape.mesh(level), process=False)


@pytest.mark.parametrize("shape, volume, error", [
    (repel.Shape.box([0.1, 0.2, 0.3]), 8 * 0.1 * 0.2 * 0.3, 1e-12),
    (repel.Shape.sphere(0.1), 4 / 3 * np.pi * 0.1 ** 3, 0.05),
    (repel.Shape.cylinder(0.1, 0.2), np.pi * 0.1 ** 2 * 0.4, 0.05),
    (repel.Shape.cone(0.1, 0.2), np.pi * 0.1 ** 2 * 0.4 / 3, 0.05),
    (repel.Shape.capsule(0.1, 0.2), np.pi * 0.1 ** 2 * (0.4 + 4 / 3 * 0.1), 0.05),
    (repel.Shape.ellipsoid([0.1, 0.2, 0.3]), 4 / 3 * np.pi * 0.006, 0.05),
])
def test_a_shape_is_a_closed_mesh_of_its_volume(shape, volume, error):
    """Chords lie inside, and faces look outside: a volume is not negative."""
    mesh = mesh_of(shape)
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert (1 - error) * volume <= mesh.volume <= (1 + 1e-12) * volume


def test_a_convex_mesh_comes_back_as_it_was():
    rng = np.random.default_rng(seed := 5)
    for case in range(20):
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=0.2)
        mesh.vertices = mesh.vertices @ rng.normal(size=(3, 3))
        back = mesh_of(repel.Shape.hull(mesh.vertices))
        assert back.is_watertight, (seed, case)
        assert back.volume == pytest.approx(abs(mesh.volume), rel=1e-9), (seed, case)
        np.testing.assert_allclose(back.bounds, mesh.bounds, atol=1e-12)


def test_distances_of_shapes_are_those_of_their_meshes():
    rng = np.random.default_rng(6)
    mesh = trimesh.creation.box([0.2, 0.4, 0.6])
    shape, point = repel.Shape.hull(mesh.vertices), repel.Shape.sphere(0.0)
    for p in rng.uniform(-1, 1, size=(50, 3)):
        ours = repel.separation(shape, EYE, point, (p, [1, 0, 0, 0])).distance
        nearest = np.clip(p, mesh.bounds[0], mesh.bounds[1])
        if (nearest != p).any():
            assert ours == pytest.approx(np.linalg.norm(p - nearest), abs=1e-9)


@pytest.mark.skipif(not hasattr(repel._repel, "cover"), reason="built without covers")
def test_a_mesh_becomes_convex_parts_that_contain_it():
    """An L of two boxes."""
    mesh = trimesh.util.concatenate([trimesh.creation.box([0.4, 0.1, 0.1]),
                                     trimesh.creation.box([0.1, 0.1, 0.4],
                                                          trimesh.transformations.
                                                          translation_matrix([-0.15, 0, 0.25]))])
    found = repel.cover(mesh.vertices, mesh.faces, parts=4)
    assert found.uncovered_m < 1e-6 and 2 <= len(found.parts) <= 4
    point = repel.Shape.sphere(0.0)
    shapes = [repel.Shape.hull(part) for part in found.parts]
    for p in mesh.vertices:
        assert min(repel.separation(shape, EYE, point, (p, [1, 0, 0, 0])).distance
                   for shape in shapes) < 1e-6
    for shape in shapes:
        assert mesh_of(shape).is_watertight
