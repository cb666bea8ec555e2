# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import repel


def at(x, y, z):
    X = np.eye(4)
    X[:3, 3] = x, y, z
    return X


def test_an_ellipsoid_has_its_radii():
    shape = repel.Shape.ellipsoid([0.1, 0.2, 0.3])
    assert shape.reach == 0.3
    assert shape.inscribed_radius == pytest.approx(0.1)
    ball = repel.Shape.sphere(0.1)
    for axis, radius in enumerate([0.1, 0.2, 0.3]):
        p = np.zeros(3)
        p[axis] = 1.0
        s = repel.separation(shape, np.eye(4), ball, at(*p))
        assert s.distance == pytest.approx(0.9 - radius, abs=1e-14)


def test_an_ellipsoid_without_thickness_is_refused():
    with pytest.raises(repel.SetupError, match="semi-axis z"):
        repel.Shape.ellipsoid([0.1, 0.2, 0.0])
