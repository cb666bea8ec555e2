# SPDX-License-Identifier: BSD-3-Clause
"""Distances: the figures of C++, the same bits one by one and together, and what is refused."""

import threading
import time

import numpy as np
import pytest

import repel
from problem import COLUMNS, Problem, answers_of_loop

EYE = np.eye(4)
SEED = 20261125


def moved(x, y, z):
    X = np.eye(4)
    X[:3, 3] = x, y, z
    return X


def test_the_figures_of_the_first_program():
    # Those that README.md shows, which the first program of C++ prints.
    tool = repel.Shape.box([0.05, 0.05, 0.10])
    table = repel.Shape.box([0.60, 0.40, 0.02])
    wall = repel.ForceLaw(range=0.02, surface_force=100.0, damping=50.0)
    figures = {0.150: (0.030, 0.0), 0.135: (0.015, 6.25), 0.125: (0.005, 56.25),
               0.119: (-0.001, 110.0), 0.100: (-0.020, 300.0)}
    for height, (distance, force) in figures.items():
        s = repel.separation(tool, moved(0.1, 0.0, height), table, EYE)
        assert s.distance == pytest.approx(distance, abs=1e-12)
        assert wall(s.distance) == pytest.approx(force, abs=1e-8)
        assert s.lower <= s.distance <= s.upper
        assert s.bracket == (s.lower, s.upper)
        np.testing.assert_allclose(s.extraction_W, [0, 0, 1], atol=1e-12)
        assert s.end in repel.QUERY_ENDS


def test_the_answers_are_those_of_cpp_bit_for_bit(loop, tmp_path):
    problem = Problem(SEED, shapes=60, pairs=3000)
    rows = repel.separations(problem.shapes, problem.X_W, problem.pairs)
    answers, _ = answers_of_loop(loop, problem, tmp_path)
    for name in COLUMNS:
        assert rows[name].tobytes() == answers[name].tobytes(), f"{name}, seed {SEED}"
    # The sample means something: there are gaps, overlaps, and every kind of shape.
    assert (rows["distance"] > 0).sum() > 300 and (rows["distance"] < 0).sum() > 300
    assert len(np.unique(problem.pairs[:, 0] % 6)) == 6


def test_a_batch_has_the_bits_of_single_calls():
    problem = Problem(SEED + 1, shapes=30, pairs=500)
    options = repel.QueryOptions(measure="exact", relative_width=1e-12)
    rows = repel.separations(problem.shapes, problem.X_W, problem.pairs, options=options)
    for row, (a, b) in zip(rows, problem.pairs):
        s = repel.separation(problem.shapes[a], problem.X_W[a], problem.shapes[b], problem.X_W[b],
                             options=options)
        assert (s.distance, s.lower, s.upper) == (row["distance"], row["lower"], row["upper"])
        assert np.array_equal(s.p_WA, row["p_WA"]) and np.array_equal(s.p_WB, row["p_WB"])
        assert np.array_equal(s.extraction_W, row["extraction_W"])
        assert (s.level, s.iterations) == (row["level"], row["iterations"])
        assert s.end == repel.QUERY_ENDS[row["end"]]


def test_warm_starts_save_work_and_keep_the_answer():
    problem = Problem(SEED + 2, shapes=30, pairs=500, room=2.0)
    warm = repel.WarmStarts(500)
    assert len(warm) == 500
    cold = repel.separations(problem.shapes, problem.X_W, problem.pairs, warm=warm)
    again = repel.separations(problem.shapes, problem.X_W, problem.pairs, warm=warm)
    np.testing.assert_allclose(again["distance"], cold["distance"], rtol=1e-6, atol=1e-12)
    assert again["iterations"].sum() < cold["iterations"].sum()
    one = repel.WarmStart()
    a, b = repel.Shape.box([1, 1, 1]), repel.Shape.sphere(1.0)
    first = repel.separation(a, EYE, b, moved(5, 1, 0), warm=one)
    second = repel.separation(a, EYE, b, moved(5, 1, 0), warm=one)
    assert second.iterations <= first.iterations


def test_an_array_is_used_again():
    problem = Problem(SEED + 3, shapes=12, pairs=50)
    rows = repel.separations(problem.shapes, problem.X_W, problem.pairs)
    out = np.zeros_like(rows)
    assert repel.separations(problem.shapes, problem.X_W, problem.pairs, out=out) is out
    assert out.tobytes() == rows.tobytes() or np.array_equal(out["distance"], rows["distance"])


def test_poses_are_matrices_or_positions_with_quaternions():
    rng = np.random.default_rng(SEED)
    a, b = repel.Shape.box([0.1, 0.2, 0.3]), repel.Shape.cylinder(0.1, 0.2)
    p, q = rng.normal(size=(2, 3)), rng.normal(size=(2, 4))
    q /= np.linalg.norm(q, axis=1)[:, None]
    together = repel.separations([a, b], (p, q), [[0, 1]])[0]
    single = repel.separation(a, (p[0], q[0]), b, (list(p[1]), tuple(q[1])))
    assert single.distance == together["distance"]
    w, x, y, z = q[0]
    X = np.eye(4)
    X[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                 [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                 [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    X[:3, 3] = p[0]
    by_matrix = repel.separation(a, X, b, (p[1], q[1]))
    assert by_matrix.distance == pytest.approx(single.distance, abs=1e-12)
    # Lists, whole numbers and arrays in another order are numbers too.
    assert repel.separation(a, np.asfortranarray(X), b, (p[1], q[1])).distance == by_matrix.distance
    assert repel.separation(a, np.eye(4, dtype=int).tolist(), b, moved(1, 0, 0)).distance > 0


NAN = np.full((4, 4), np.nan)


@pytest.mark.parametrize("X, kind, words", [
    (np.eye(3), ValueError, r"X_WA: expected a 4x4 rigid pose.*got an array of shape \(3, 3\)"),
    (np.zeros(16), ValueError, r"X_WA: .*shape \(16,\)"),
    ("eye", TypeError, "X_WA: expected a 4x4 rigid pose.*got str"),
    (None, TypeError, "X_WA: expected a 4x4 rigid pose.*got NoneType"),
    (1j * EYE, TypeError, "X_WA: .*complex"),
    (NAN, repel.SetupError, "X_WA: an entry is not finite"),
    (moved(0, np.inf, 0), repel.SetupError, "X_WA: an entry is not finite"),
    (2 * EYE, repel.SetupError, "X_WA: the last row"),
    (np.diag([1.0, 1, -1, 1]), repel.SetupError, "X_WA: the rotation is not"),
    (np.diag([1.0, 1, 1 + 1e-6, 1]), repel.SetupError, "X_WA: the rotation is not"),
    (([0, 0, 0], [1, 1, 0, 0]), repel.SetupError,
     "X_WA: the quaternion has length 1.41.*; allowed: 0.999999 to 1.000001"),
    (([0, 0], [1, 0, 0, 0]), ValueError, r"X_WA: .*shape \(2,\)"),
    (([0, 0, np.nan], [1, 0, 0, 0]), repel.SetupError, "X_WA: an entry is not finite"),
])
def test_poses_that_are_none_are_refused_by_name(X, kind, words):
    a, b = repel.Shape.sphere(0.1), repel.Shape.box([1, 1, 1])
    with pytest.raises(kind, match=words):
        repel.separation(a, X, b, EYE)


def test_poses_too_far_off_are_refused():
    a, b = repel.Shape.cylinder(0.1, 0.1), repel.Shape.box([1, 1, 1])
    with pytest.raises(repel.SetupError, match="beyond 1e15 m"):
        repel.separation(a, moved(1e16, 0, 0), b, EYE)
    row = repel.separations([a, b], np.stack([moved(1e16, 0, 0), EYE]), [[0, 1]])[0]
    assert repel.QUERY_ENDS[row["end"]] == "bad_input" and row["lower"] == -np.inf


@pytest.mark.parametrize("change, kind, words", [
    ({"X_W": np.stack([EYE] * 3)}, ValueError, "X_W: expected a pose for each of 2 shapes, got 3"),
    ({"X_W": EYE}, ValueError, r"X_W: expected N rigid poses.*got an array of shape \(4, 4\)"),
    ({"X_W": np.stack([EYE, NAN])}, repel.SetupError, r"X_W\[1\]: an entry is not finite"),
    ({"X_W": np.stack([[EYE, EYE], [EYE, NAN]])}, repel.SetupError, r"X_W\[1, 1\]: an entry"),
    ({"pairs": [[0, 2]]}, IndexError, r"pairs\[0\] names shape 2; allowed: 0 to 1"),
    ({"pairs": [[0, -1]]}, IndexError, r"pairs\[0\] names shape -1"),
    ({"pairs": [0, 1]}, ValueError, r"pairs: expected indices.*shape \(2,\)"),
    ({"pairs": [[0.0, 1.0]]}, TypeError, "pairs: expected whole numbers"),
    ({"shapes": [repel.Shape.sphere(1.0), "box"]}, TypeError, r"shapes\[1\]: expected a Shape"),
    ({"shapes": [], "X_W": np.zeros((0, 4, 4))}, IndexError, "allowed: none, of no shapes"),
    ({"pairs": np.array([[0, 2**63 + 1]], np.uint64)}, IndexError, "shape 9223372036854775809"),
    ({"options": 0}, TypeError, "options: expected QueryOptions, got int"),
    ({"warm": []}, TypeError, "warm: expected WarmStarts, got list"),
    ({"warm": repel.WarmStarts(2)}, ValueError, "warm: expected 1 rows"),
    ({"out": np.zeros(1)}, ValueError, "out: expected 1 rows of repel.SEPARATION"),
])
def test_batches_that_cannot_be_answered_are_refused_by_name(change, kind, words):
    call = {"shapes": [repel.Shape.sphere(1.0), repel.Shape.box([1, 1, 1])],
            "X_W": np.stack([EYE, EYE]), "pairs": [[0, 1]], **change}
    with pytest.raises(kind, match=words):
        repel.separations(**call)


@pytest.mark.parametrize("build, words", [
    (lambda: repel.Shape.sphere(-1.0), "radius is -1 m; allowed: 0 to"),
    (lambda: repel.Shape.sphere(float("nan")), "radius is nan m"),
    (lambda: repel.Shape.box([1, 2, np.inf]), "half_extents: an entry is not finite"),
    (lambda: repel.Shape.hull(np.zeros((0, 3))), "number of points is 0"),
    (lambda: repel.Shape.hull([[0, 0, np.nan]]), r"points\[0\]: an entry is not finite"),
    (lambda: repel.Shape.box([1, 1, 1], levels=65), "reduction levels is 65"),
    (lambda: repel.ForceLaw(range=-1.0), "range is -1 m"),
    (lambda: repel.ForceLaw(passable=True), "ceiling of a passable body"),
    (lambda: repel.QueryOptions(measure="depth"), "measure is 'depth'; allowed: deepest_point"),
    (lambda: repel.QueryOptions(iterations=0), "iterations is 0; allowed: 1 to"),
    (lambda: repel.QueryOptions(tolerance=-1.0), "tolerance is -1; allowed: 0 to"),
    (lambda: repel.WarmStarts(-1), "count is -1"),
])
def test_numbers_out_of_range_are_refused(build, words):
    with pytest.raises(repel.SetupError, match=words) as refused:
        build()
    assert isinstance(refused.value, ValueError)
    assert (refused.value.file, refused.value.line) == ("", 0)


def test_no_pairs_are_no_rows():
    rows = repel.separations([repel.Shape.sphere(1.0)], EYE[None], np.zeros((0, 2), int))
    assert rows.shape == (0,) and rows.dtype == repel.SEPARATION


def test_other_threads_run_meanwhile():
    problem = Problem(SEED + 4, shapes=60, pairs=200_000)
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(1e-4)

    counter = threading.Thread(target=count)
    counter.start()
    time.sleep(0.01)
    before = counted[0]
    repel.separations(problem.shapes, problem.X_W, problem.pairs)
    during = counted[0] - before
    done.set()
    counter.join()
    assert during > 10  # a call that kept the interpreter would have let it count once or twice


def test_meshes_of_shapes_are_closed():
    for shape in (repel.Shape.box([0.1, 0.2, 0.3]), repel.Shape.capsule(0.1, 0.2)):
        vertices, triangles = shape.mesh()
        edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]],
                                        triangles[:, [2, 0]]]), axis=1)
        assert vertices.shape[1] == 3
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


def test_batches_of_poses_are_answered_one_after_the_other():
    problem = Problem(SEED + 9, shapes=20, pairs=50)
    places = np.stack([problem.X_W, problem.X_W, problem.X_W])
    places[1, :, 0, 3] *= 1.5
    places[2, :, 1, 3] += np.arange(len(problem.shapes))
    warm = repel.WarmStarts(3 * len(problem.pairs))
    rows = repel.separations(problem.shapes, places, problem.pairs)
    assert rows.shape == (3, len(problem.pairs))
    for X_W, answers in zip(places, rows):
        alone = repel.separations(problem.shapes, X_W, problem.pairs)
        for name in COLUMNS:
            assert answers[name].tobytes() == alone[name].tobytes(), f"{name}, seed {SEED + 9}"
    out = np.empty_like(rows)
    assert repel.separations(problem.shapes, places, problem.pairs, out=out, warm=warm) is out
    np.testing.assert_allclose(out["distance"], rows["distance"], atol=1e-9)
    assert repel.separations(problem.shapes, places[:0], problem.pairs).shape == (
        0, len(problem.pairs))
    for wrong in (places[:, 1:], places[:, :, :3]):
        with pytest.raises(ValueError, match="X_W: expected"):
            repel.separations(problem.shapes, wrong, problem.pairs)
    with pytest.raises(ValueError, match="out: expected 3 x 50 rows"):
        repel.separations(problem.shapes, places, problem.pairs, out=rows[0])
