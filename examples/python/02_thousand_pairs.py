# SPDX-License-Identifier: BSD-3-Clause
"""A thousand pairs in one call: which of many things are near, and how sure that is."""

import numpy as np

import repel

rng = np.random.default_rng(1)
shapes = [repel.Shape.box(rng.uniform(0.02, 0.1, 3)) for _ in range(50)]
shapes += [repel.Shape.hull(rng.normal(scale=0.05, size=(12, 3))) for _ in range(50)]
positions = rng.uniform(-1.0, 1.0, (100, 3))  # [m]
turns = rng.normal(size=(100, 4))
turns /= np.linalg.norm(turns, axis=1)[:, None]  # unit quaternions w x y z
pairs = rng.choice(100, (1000, 2))
pairs = pairs[pairs[:, 0] != pairs[:, 1]]

warm = repel.WarmStarts(len(pairs))  # what one call leaves for the next
rows = repel.separations(shapes, (positions, turns), pairs, warm=warm)
near = rows["distance"] < 0.05
print(f"{len(pairs)} pairs, {near.sum()} nearer than 50 mm, {(rows['distance'] < 0).sum()} overlap")
apart = rows[rows["distance"] > 0]
print(f"widest bracket of those apart: {(apart['upper'] - apart['lower']).max():.1e} m")

positions[:, 2] += 1e-3 * rng.normal(size=100)  # a little later
again = repel.separations(shapes, (positions, turns), pairs, warm=warm)
print(f"support pairs: {rows['iterations'].sum()}, then {again['iterations'].sum()}")
