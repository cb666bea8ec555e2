# SPDX-License-Identifier: BSD-3-Clause
"""What a program may do wrong, and what the package says instead of ending the interpreter."""

import pathlib
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import repel
from gantry import Gantry, gantry_cell

EYE = np.eye(4)
START = """
import gc, sys, threading, time
import numpy as np
import repel
from gantry import Gantry, gantry_cell
"""


def survives(program):
    """Runs it in an interpreter of its own, which must come to its end."""
    done = subprocess.run([sys.executable, "-X", "faulthandler", "-c",
                           START + textwrap.dedent(program)], cwd=pathlib.Path(__file__).parent,
                          capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("the end\n"), done.stdout
    assert "terminate called" not in done.stderr and "Fatal" not in done.stderr, done.stderr


def test_pairs_may_lie_in_the_rows_that_are_written():
    survives("""
        shapes = [repel.Shape.sphere(0.1)] * 4
        X_W = np.stack([np.eye(4)] * 4)
        X_W[1:, 0, 3] = 1.0
        out = np.zeros(1000, repel.SEPARATION)
        pairs = out.view(np.int64).reshape(-1)[:2000].reshape(1000, 2)
        pairs[:] = [0, 1]
        repel.separations(shapes, X_W, pairs, out=out)
        assert (out["distance"] == repel.separation(shapes[0], X_W[0], shapes[1], X_W[1]).distance
                ).all()
        print("the end")
    """)


def test_pairs_may_be_changed_by_another_thread():
    survives("""
        shapes = [repel.Shape.sphere(0.1)] * 4
        X_W = np.stack([np.eye(4)] * 4)
        pairs = np.zeros((20000, 2), np.int64)
        pairs[:, 1] = 1
        done = []
        def change():
            while not done:
                pairs[:] = 10**12
                pairs[:] = [0, 1]
        thread = threading.Thread(target=change)
        thread.start()
        for _ in range(20):
            try:
                repel.separations(shapes, X_W, pairs)
            except IndexError:
                pass
        done.append(True)
        thread.join()
        print("the end")
    """)


def test_a_cell_whose_description_was_refused_is_collected():
    survives("""
        class Own(repel.Cell):
            pass
        for _ in range(100):
            cell = Own.__new__(Own)
            cell.me = cell
            try:
                cell.__init__(rate_hz=-1.0, arms=[])
            except repel.SetupError:
                pass
            del cell
            gc.collect()
        print("the end")
    """)


@pytest.mark.parametrize("thing", ["np.datetime64('2020-01-01')", "np.timedelta64(1, 's')",
                                   "np.zeros((4, 4), 'M8[s]')", "memoryview(b'abcd')", "b'abcd'",
                                   "np.float64(1)", "np.zeros((4, 4), [('a', 'f8')])",
                                   "np.zeros((4, 4), object)", "np.bytes_(b'abc')", "'x'"])
def test_what_is_no_pose_is_refused(thing):
    survives(f"""
        sphere = repel.Shape.sphere(0.1)
        for ask in (lambda X: repel.separation(sphere, X, sphere, np.eye(4)),
                    lambda X: repel.separations([sphere], X, [[0, 0]]),
                    lambda X: repel.Shape.box(X), lambda X: repel.Command(linear=X)):
            try:
                ask({thing})
                raise AssertionError("it was taken")
            except (TypeError, ValueError) as error:
                assert "expected" in str(error), error
        print("the end")
    """)


CALLS = {
    "step": "cell = gantry_cell(); z = np.zeros(3)\ncall = lambda: cell.step(z, z, command)",
    "step with slow kinematics": """
class Slow(Gantry):
    def update(self, q):
        time.sleep(0.001)
        super().update(q)
cell = gantry_cell(Slow()); z = np.zeros(3)
call = lambda: cell.step(z, z, command)""",
    "sense and act": """
cell = gantry_cell(); z = np.zeros(3)
call = lambda: (cell.sense([(z, z)]), cell.act([command]))""",
    "separations": """
shapes = [repel.Shape.sphere(0.1)] * 100
X_W = np.stack([np.eye(4)] * 100).astype(np.float32)
call = lambda: repel.separations(shapes, X_W, [[0, 1]] * 500)""",
    "near": """
world = repel.World(); body = world.add_body("b")
world.add_pair(world.add_part(0, "a", repel.Shape.sphere(1)),
               world.add_part(body, "b", repel.Shape.sphere(1)), repel.ForceLaw())
call = lambda: (world.place(body, np.eye(4)), world.near())""",
}


@pytest.mark.parametrize("call", CALLS)
def test_the_interpreter_ends_while_threads_are_in(call):
    lines = textwrap.indent(textwrap.dedent(CALLS[call]), " " * 8)
    survives(f"""
        command = repel.Command()
        {lines.strip()}
        def loop():
            while True:
                call()
        threading.Thread(target=loop, daemon=True).start()
        time.sleep(0.1)
        print("the end")
    """)


@pytest.mark.skipif(not hasattr(repel._repel, "LiveView"), reason="built without the live view")
def test_the_interpreter_ends_while_a_view_is_open():
    survives("""
        cell = gantry_cell()
        view = repel.LiveView(cell, port=0)
        cell.step(np.zeros(3), np.zeros(3), repel.Command())
        view.publish()
        del cell  # the view keeps it
        view.publish()
        print("the end")
    """)


def test_readings_of_another_length_are_refused():
    cell, z, rest = gantry_cell(), np.zeros(3), repel.Command()
    for wrong in (np.zeros(2), np.zeros(4), np.zeros(0)):
        with pytest.raises(ValueError, match=f"q: expected 3 numbers, one .* got {len(wrong)}"):
            cell.step(wrong, z, rest)
        with pytest.raises(ValueError, match=f"v: expected 3 numbers, one .* got {len(wrong)}"):
            cell.sense([(z, wrong)])
    assert cell.step(z, z, rest).status == ()  # no tick was made of them


def test_a_world_and_a_simulated_arm_take_one_call_at_a_time():
    survives("""
        world = repel.World()
        body = world.add_body("body")
        cloud = [world.add_part(0, f"{i}", repel.Shape.sphere(0.1)) for i in range(2000)]
        world.add_pairs([world.add_part(body, "tool", repel.Shape.sphere(0.1))], cloud,
                        repel.ForceLaw())
        refused, done = [], []
        def ask():
            while not done:
                try:
                    world.place(body, np.eye(4))
                    world.near()
                except RuntimeError as error:
                    refused.append(str(error))
        threads = [threading.Thread(target=ask) for _ in range(3)]
        for thread in threads:
            thread.start()
        time.sleep(0.5)
        done.append(True)
        for thread in threads:
            thread.join()
        assert all("allowed is one call at a time" in each for each in refused), refused
        print("the end")
    """)


@pytest.mark.parametrize("wrong, words", [
    (lambda: repel.Arm("x.urdf"), r"links: expected a sequence of repel.Link, got 'x.urdf'; the "
                                  r"arm of a URDF file is repel.Arm.from_urdf\(path\)"),
    (lambda: repel.Arm(pathlib.Path("x.urdf")), "links: expected a sequence of repel.Link"),
    (lambda: repel.Arm(["a"]), r"links\[0\]: expected a repel.Link, got str"),
    (lambda: repel.Arm([], parts=[repel.Shape.sphere(1)]),
     r"parts\[0\]: expected a repel.Part, got Shape"),
    (lambda: repel.separations([], np.zeros((0, 4, 4)), np.zeros((0, 2), int), out=[]),
     "out: expected an array, got list"),
])
def test_what_is_not_of_a_kind_is_refused_at_once(wrong, words):
    with pytest.raises(TypeError, match=words):
        wrong()


def test_rows_that_cannot_be_written_are_refused():
    spheres, pairs = [repel.Shape.sphere(0.1)] * 2, [[0, 1]] * 2
    still = np.zeros(2, repel.SEPARATION)
    still.flags.writeable = False
    odd = np.zeros(2 * repel.SEPARATION.itemsize + 1, np.uint8)[1:].view(repel.SEPARATION)
    for out in (still, odd, np.zeros(4, repel.SEPARATION)[::2]):
        with pytest.raises(ValueError, match="out: expected rows one after the other"):
            repel.separations(spheres, np.stack([EYE, EYE]), pairs, out=out)


def stiff_cell(**change):
    return repel.Cell(rate_hz=1000.0, **{
        "arms": [repel.Arm([repel.Link("rail", type="prismatic", lower=-1, upper=1,
                                       rotor_inertia=4.0, axis_J=(1, 0, 0))],
                           kinematics=Rail(),
                           parts=[repel.Part("ball", repel.Shape.sphere(0.05))])],
        "obstacles": [repel.Obstacle("wall", repel.Shape.box([0.1, 1, 1]),
                                     ([0.35, 0, 0], [1, 0, 0, 0]),
                                     repel.ForceLaw(surface_force=1e6, damping=1.0))], **change})


class Rail(Gantry):
    def update(self, q):
        self.p = np.array([q[0], 0.0, 0.0])

    def tool_jacobian(self):
        return np.eye(6, 1)

    def gravity_torques(self):
        return np.zeros(1)


def test_a_wall_that_is_too_stiff_runs_as_the_message_says():
    with pytest.raises(repel.SetupError, match="wall too stiff.*'gain_check: warning'"):
        stiff_cell()
    assert "stiffness" in stiff_cell(gain_check="warning").warnings[0]
    with pytest.raises(repel.SetupError, match="gain_check is 'no'; allowed: error, warning"):
        stiff_cell(gain_check="no")


def test_a_start_inside_a_wall_runs_as_the_message_says():
    wall = [repel.Obstacle("wall", repel.Shape.box([0.1, 1, 1]))]
    with pytest.raises(repel.SetupError, match="starts inside 'wall'.*'start_inside: push_out'"):
        stiff_cell(obstacles=wall)
    for way in ("push_out", "allow"):
        cell = stiff_cell(obstacles=wall, start_inside=way)
        assert "starts inside 'wall'" in cell.warnings[0]
    with pytest.raises(repel.SetupError, match="start_inside is 'no'; allowed: refuse, push_out"):
        stiff_cell(obstacles=wall, start_inside="no")


def test_parts_that_meet_may_touch_as_the_message_says():
    links = [repel.Link(f"rail {i}", type="prismatic", lower=-1, upper=1, rotor_inertia=4.0)
             for i in range(3)]
    parts = [repel.Part("first", repel.Shape.sphere(0.1), link=0),
             repel.Part("last", repel.Shape.sphere(0.1))]

    class Linked(Gantry):
        def X_WL(self, link):
            return EYE

        def jacobian(self, link, p_WQ):
            return np.eye(6, 3)

    def cell(**change):
        return repel.Cell(rate_hz=1000.0, arms=[repel.Arm(
            links, kinematics=Linked(), parts=parts, self_law=repel.ForceLaw(), **change)])

    with pytest.raises(repel.SetupError, match="'first' and 'last' meet.*may_touch"):
        cell()
    assert cell(may_touch=[(0, 1)]).pairs == []


def test_more_bodies_than_the_capacities_allow_fit_into_larger_ones():
    world = repel.World(limits=repel.Capacities(bodies=2))
    world.add_body("one")
    with pytest.raises(repel.SetupError, match="more bodies than Capacities::bodies allows: 2"):
        world.add_body("two")
    world = repel.World(limits=repel.Capacities(bodies=100))
    assert [world.add_body(f"{i}") for i in range(99)][-1] == 99
    with pytest.raises(repel.SetupError, match="bodies is 0; allowed: 1 to"):
        repel.World(limits=repel.Capacities(bodies=0))
    with pytest.raises(repel.SetupError, match="more bodies than Capacities::bodies"):
        stiff_cell(gain_check="warning", limits=repel.Capacities(bodies=1))


def test_a_law_says_where_it_is_given():
    assert repel.ForceLaw().given_at == "part"
    assert repel.ForceLaw(given_at="tool").given_at == "tool"
    with pytest.raises(repel.SetupError, match="given_at is 'link'; allowed: part, tool"):
        repel.ForceLaw(given_at="link")


@pytest.mark.skipif(not hasattr(repel, "load_scene"), reason="built without scenes")
def test_scenes_of_the_package_are_known_by_their_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert repel.load_scene("anderson_4x8").name == "anderson_4x8"
    assert repel.Cell.from_scene("empty").arm_count == 1
    with pytest.raises(repel.SetupError, match="nowhere: no such scene; allowed: a file, or one "
                                               "of .*anderson_4x8, .*empty") as refused:
        repel.load_scene("nowhere")
    assert refused.value.file == "nowhere"
    for path in ("nowhere.yaml", "here/nowhere", pathlib.Path("here/nowhere")):
        with pytest.raises(repel.SetupError, match="cannot be opened"):
            repel.load_scene(path)
    pathlib.Path("empty").write_text("not a scene")  # a file comes first, as with run
    with pytest.raises(repel.SetupError) as refused:
        repel.load_scene("empty")
    assert refused.value.file == "empty"
