# SPDX-License-Identifier: BSD-3-Clause
"""Two boxes: how far apart they are, and the force that keeps them there."""

import numpy as np

import repel

tool = repel.Shape.box([0.05, 0.05, 0.10])  # half extents [m]
table = repel.Shape.box([0.60, 0.40, 0.02])
wall = repel.ForceLaw(range=0.02, surface_force=100.0, damping=50.0)

X_WTool = np.eye(4)
for height in (0.150, 0.135, 0.125, 0.119, 0.100):
    X_WTool[:3, 3] = 0.1, 0.0, height
    s = repel.separation(tool, X_WTool, table, np.eye(4))
    print(f"tool at {height:.3f} m: distance {s.distance:+.3f} m, force {wall(s.distance):.2f} N")
