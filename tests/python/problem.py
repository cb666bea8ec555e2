# SPDX-License-Identifier: BSD-3-Clause
"""Random pairs of shapes, and the program of C++ that answers them as well."""

import pathlib
import shutil
import subprocess

import numpy as np

import repel

ROOT = pathlib.Path(__file__).resolve().parents[2]
KINDS = ("box", "sphere", "capsule", "cylinder", "cone", "hull")
COLUMNS = ("distance", "lower", "upper", "p_WA", "p_WB", "extraction_W")


def random_poses(rng, count, room):
    """(count, 4, 4) within `room` [m] of the origin, with any orientation."""
    q = rng.normal(size=(count, 4))
    w, x, y, z = (q / np.linalg.norm(q, axis=1)[:, None]).T
    X = np.zeros((count, 4, 4))
    X[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], 1)
    X[:, 1, :3] = np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], 1)
    X[:, 2, :3] = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1)
    X[:, :3, 3] = rng.uniform(-room, room, (count, 3))
    X[:, 3, 3] = 1.0
    return X


class Problem:
    """Shapes of every kind at random poses, and random pairs of them."""

    def __init__(self, seed, shapes, pairs, room=0.2):
        rng = np.random.default_rng(seed)
        self.kinds = [KINDS[i % len(KINDS)] for i in range(shapes)]
        self.sizes = [self._size(kind, rng) for kind in self.kinds]
        self.shapes = [self._shape(kind, size) for kind, size in zip(self.kinds, self.sizes)]
        self.X_W = random_poses(rng, shapes, room)
        first = rng.integers(0, shapes, pairs)
        self.pairs = np.stack([first, (first + rng.integers(1, shapes, pairs)) % shapes], 1)

    @staticmethod
    def _size(kind, rng):
        count = {"box": 3, "sphere": 1, "hull": 36}.get(kind, 2)
        return rng.uniform(-0.2, 0.2, count) if kind == "hull" else rng.uniform(0.02, 0.2, count)

    @staticmethod
    def _shape(kind, size):
        if kind == "box":
            return repel.Shape.box(size)
        if kind == "hull":
            return repel.Shape.hull(size.reshape(-1, 3))
        return getattr(repel.Shape, kind)(*size)

    def write(self, path):
        with open(path, "wb") as file:
            file.write(np.array([len(self.shapes), len(self.pairs)], np.int64).tobytes())
            for kind, size in zip(self.kinds, self.sizes):
                file.write(np.array([KINDS.index(kind), len(size)], np.int64).tobytes())
                file.write(size.tobytes())
            file.write(self.X_W.tobytes())
            file.write(self.pairs.astype(np.int64).tobytes())


def built_loop(folder):
    """The program of loop.cpp, compiled; None without a compiler or Eigen."""
    compiler = shutil.which("c++") or shutil.which("g++")
    eigen = pathlib.Path("/usr/include/eigen3")
    if compiler is None or not eigen.exists():
        return None
    program = pathlib.Path(folder) / "loop"
    cached = [shutil.which("ccache")] if shutil.which("ccache") else []
    built = pathlib.Path(folder) / "loop.o"
    flags = ["-std=c++20", "-O2", "-DNDEBUG", "-ffp-contract=off", "-I", str(ROOT / "core"),
             "-isystem", str(eigen)]
    subprocess.run([*cached, compiler, *flags, "-c", str(ROOT / "tests/python/loop.cpp"), "-o",
                    str(built)], check=True)
    subprocess.run([compiler, str(built), "-o", str(program)], check=True)
    return program


def answers_of_loop(program, problem, folder, repeats=1):
    """The answers of C++, {column: array}, and the least time of a pair [ns]."""
    path = pathlib.Path(folder)
    problem.write(path / "problem")
    said = subprocess.run([program, path / "problem", path / "answers", str(repeats)], check=True,
                          capture_output=True, text=True).stdout
    table = np.fromfile(path / "answers").reshape(-1, 12)
    parts = np.split(table, [1, 2, 3, 6, 9], axis=1)
    return {name: part[:, 0] if part.shape[1] == 1 else part
            for name, part in zip(COLUMNS, parts)}, float(said)
