# SPDX-License-Identifier: BSD-3-Clause
"""Parts of a cell that come and go, are moved and held, and what a depth camera makes of them."""

import numpy as np
import pytest

import repel
from gantry import gantry_cell
from world_test import moved

REST = repel.Command()
NOISE = np.random.default_rng(1)
LAW = repel.ForceLaw(range=0.02, surface_force=50.0, damping=50.0)
BOTTLE = repel.Loose("bottle", repel.Shape.sphere(0.05), moved(0, 0.11, 0), LAW, mass=0.5)


def ticks(cell, count, q=(0, 0, 0)):
    for _ in range(count):
        # A joint that is pushed does not report the same position again and again.
        tick = cell.step(np.array(q) + 1e-9 * NOISE.random(), np.zeros(3), REST)
    return tick


def test_a_part_comes_moves_is_held_and_goes():
    cell = gantry_cell(loose=[BOTTLE])
    assert cell.loose["bottle"]["there"] == 0.0 and ticks(cell, 1).peak_force == 0.0
    cell.add("bottle", over=0.01)
    force = [ticks(cell, 1).peak_force for _ in range(20)]
    assert 0.0 < force[1] < force[5] < force[12]  # it came over 10 ms
    assert force[-1] == pytest.approx(LAW(0.01))
    assert cell.loose["bottle"]["there"] == 1.0 and cell.loose["bottle"]["holder"] is None
    cell.move("bottle", moved(0, 0.115, 0), speed=0.1)
    assert ticks(cell, 60).peak_force == pytest.approx(LAW(0.015))
    cell.attach("bottle", over=0.01)
    assert ticks(cell, 30).peak_force == 0.0  # a part of the tool
    for x in np.linspace(0, 0.02, 201):
        tick = cell.step([x, 0, 0], [0.1, 0, 0], REST)
    state = cell.loose["bottle"]
    assert state["holder"] == 0
    np.testing.assert_allclose(state["X_WP"], moved(0.02, 0.115, 0), atol=1e-8)
    assert tick.torques[2] == pytest.approx((4.0 + 0.5) * 9.81, rel=1e-6)  # it has a weight
    cell.release("bottle", over=0.01)
    ticks(cell, 30, q=(0.02, 0, 0))
    assert cell.loose["bottle"]["holder"] is None
    cell.remove("bottle", over=0.0)
    assert ticks(cell, 2, q=(0.02, 0, 0)).peak_force == 0.0
    assert cell.changes == {"applied": 5, "refused": 0, "waited": 0}
    cell.add("bottle", moved(0, 0.5, 0), over=0.0)
    ticks(cell, 2)
    np.testing.assert_allclose(cell.loose["bottle"]["X_WP"], moved(0, 0.5, 0))


def test_a_new_shape_takes_a_part_that_is_free():
    spare = [repel.Loose(f"spare {i}", repel.Shape.sphere(0.01), law=LAW, room=0.3)
             for i in range(2)]
    cell = gantry_cell(loose=[BOTTLE, *spare])
    box = repel.Shape.box([0.05, 0.05, 0.05])
    names = [cell.add(box, moved(0, y, 0), over=0.0) for y in (0.11, -0.11)]
    assert sorted(names) == ["spare 0", "spare 1"]
    assert ticks(cell, 3).peak_force == pytest.approx(LAW(0.01), rel=0.1)
    with pytest.raises(repel.SetupError, match="no loose part is free with room for a shape that "
                                               "reaches 0.0866 m"):
        cell.add(box, moved(0, 1, 0))
    cell.remove(names[0], over=0.0)
    assert cell.add(box, moved(0, 1, 0)) == names[0]


def test_a_part_that_is_placed_has_the_velocity_that_is_said():
    cell = gantry_cell(loose=[BOTTLE])
    cell.add("bottle", over=0.0)
    still = ticks(cell, 3).peak_force
    cell.place("bottle", BOTTLE.X_WP, [0, -0.1, 0, 0, 0, 0])
    assert ticks(cell, 1).peak_force == pytest.approx(still + 50.0 * 0.1, rel=0.2)
    cell.place("bottle", ([0, 0.2, 0], [1, 0, 0, 0]))
    assert ticks(cell, 1).peak_force == 0.0


def test_what_the_state_of_a_part_does_not_allow_is_counted():
    cell = gantry_cell(loose=[BOTTLE])
    cell.attach("bottle")  # it is not there
    cell.release("bottle")
    ticks(cell, 2)
    assert cell.changes == {"applied": 0, "refused": 2, "waited": 0}


@pytest.mark.parametrize("wrong, words", [
    (lambda c: c.add("glass"), "no loose part is called 'glass'; allowed: the name of one of"),
    (lambda c: c.add("bottle", np.full((4, 4), np.nan)), "X_WP: an entry is not finite"),
    (lambda c: c.add("bottle", over=-1.0), "over is -1 s; allowed: 0 to 3600"),
    (lambda c: c.move("bottle", np.eye(4), speed=100.0), "speed is 100 m/s; allowed"),
    (lambda c: c.attach("bottle", arm=1), "arm is 1; allowed: 0"),
    (lambda c: c.place("bottle", np.eye(4), np.full(6, np.nan)), "V_WP: an entry is not finite"),
    (lambda c: [c.remove("bottle") for _ in range(2000)], "too many changes wait"),
    (lambda c: gantry_cell(loose=[BOTTLE], limits=repel.Capacities(loose=0)), "loose is 0"),
    (lambda c: gantry_cell(loose=[BOTTLE] * 2, limits=repel.Capacities(loose=1)),
     "more loose than Capacities::loose"),
])
def test_what_cannot_be_changed_is_refused_by_name(wrong, words):
    with pytest.raises(repel.SetupError, match=words):
        wrong(gantry_cell(loose=[BOTTLE]))


SIZE = {"width": 64, "height": 48, "fx": 60.0, "fy": 60.0, "cx": 31.5, "cy": 23.5}
#: Above the gantry, looking down: x to the right, y of the image is -y of the world.
X_WC = np.array([[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 1], [0, 0, 0, 1]], float)


def watched_cell(count=40):
    seen = [repel.Loose(f"seen {i}", repel.Shape.sphere(0.01), law=LAW, room=1.1, can_be_held=False)
            for i in range(count)]
    return gantry_cell(loose=seen)


needs_cameras = pytest.mark.skipif(not hasattr(repel._repel, "DepthCamera"),
                                   reason="built without cameras")


@needs_cameras
def test_what_a_camera_sees_pushes_the_arm():
    """A floor that is 10 mm below the ball, and the ball itself, which is no obstacle."""
    cell = watched_cell()
    camera = repel.DepthCamera(cell, **SIZE, margin=0.005, tolerance=0.002, room=1.0)
    ticks(cell, 1)
    depth = np.full((48, 64), 1.06, np.float32)
    v, u = np.mgrid[:48, :64]
    depth[np.hypot(u - 31.5, v - 23.5) * 1.0 / 60.0 < 0.05] = 0.951  # on the ball
    depth[5:8, 5:8] = np.nan
    counts = camera.see(depth, X_WC, 0.0)
    assert counts["cells"] == counts["added"] > 0 and counts["left_out"] == 0
    tick = ticks(cell, 300)
    assert tick.peak_force > 1.0 and tick.hardest_pair.startswith("ball - seen ")
    assert tick.virtual_force[2] > 1.0  # upwards
    again = camera.see(depth, X_WC, 0.3)
    assert again["kept"] == again["cells"] == counts["cells"] and again["added"] == 0
    camera.clear()
    assert ticks(cell, 300).peak_force == 0.0


@needs_cameras
@pytest.mark.parametrize("wrong, kind, words", [
    (lambda c: c.see(np.ones((64, 48)), X_WC, 0.0), ValueError,
     r"depth: expected depths \[m\], height x width of the camera, got .*\(64, 48\)"),
    (lambda c: c.see("picture", X_WC, 0.0), TypeError, "depth: expected"),
    (lambda c: c.see(np.ones((48, 64)), np.eye(3), 0.0), ValueError, "X_WC: expected"),
    (lambda c: c.see(np.ones((48, 64)), X_WC, np.nan), repel.SetupError, "time"),
    (lambda c: repel.DepthCamera(watched_cell(), **{**SIZE, "fx": 0.0}), repel.SetupError,
     "focal length is 0 px"),
    (lambda c: repel.DepthCamera(watched_cell(), **SIZE, share=(0, 41)), repel.SetupError,
     "count of share is 41; allowed: 0 to 40"),
])
def test_images_that_cannot_be_used_are_refused(wrong, kind, words):
    with pytest.raises(kind, match=words):
        wrong(repel.DepthCamera(watched_cell(), **SIZE))


@needs_cameras
def test_a_share_of_the_parts_is_of_one_camera():
    cell = watched_cell()
    camera = repel.DepthCamera(cell, **SIZE, share=(30, 10))
    counts = camera.see(np.full((48, 64), 2.0), X_WC, 0.0)
    ticks(cell, 100)
    there = [name for name, part in cell.loose.items() if part["there"] > 0.0]
    assert len(there) == counts["added"] and set(there) <= {f"seen {i}" for i in range(30, 40)}
