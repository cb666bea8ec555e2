#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scenes/meshes/make.py: writes the meshes of this folder, as a CAD program would export them.

Binary STL in metres, by hand: a facet is one line of struct. Bodies may pass through each other. Their convex parts, NAME.stl.parts.yaml,
are made by `cover`; scenes/meshes/README.md has the lines.
"""

import math
import pathlib
import struct

HERE = pathlib.Path(__file__).resolve().parent


def quad(a, b, c, d):
    """Two triangles, counter-clockwise seen from outside."""
    return [(a, b, c), (a, c, d)]


def box(size, middle):
    """The twelve triangles of a box [m]."""
    def corner(x, y, z):
        return tuple(m + s * h / 2 for m, s, h in zip(middle, (x, y, z), size))
    return (quad(corner(-1, -1, -1), corner(-1, 1, -1), corner(1, 1, -1), corner(1, -1, -1))
            + quad(corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1))
            + quad(corner(-1, -1, -1), corner(1, -1, -1), corner(1, -1, 1), corner(-1, -1, 1))
            + quad(corner(1, 1, -1), corner(-1, 1, -1), corner(-1, 1, 1), corner(1, 1, 1))
            + quad(corner(1, -1, -1), corner(1, 1, -1), corner(1, 1, 1), corner(1, -1, 1))
            + quad(corner(-1, 1, -1), corner(-1, -1, -1), corner(-1, -1, 1), corner(-1, 1, 1)))


def ring(inner, outer, depth, middle, sides):
    """A ring around the x axis with a rectangular section [m]."""
    def at(i, radius, x):
        angle = 2 * math.pi * (i % sides) / sides
        return (middle[0] + x, middle[1] + radius * math.cos(angle),
                middle[2] + radius * math.sin(angle))
    triangles = []
    for i in range(sides):
        a, b = -depth / 2, depth / 2
        triangles += quad(at(i, outer, a), at(i + 1, outer, a), at(i + 1, outer, b), at(i, outer, b))
        triangles += quad(at(i + 1, inner, a), at(i, inner, a), at(i, inner, b), at(i + 1, inner, b))
        triangles += quad(at(i, outer, b), at(i + 1, outer, b), at(i + 1, inner, b), at(i, inner, b))
        triangles += quad(at(i + 1, outer, a), at(i, outer, a), at(i, inner, a), at(i + 1, inner, a))
    return triangles


def write(name, triangles):
    with open(HERE / name, "wb") as file:
        file.write(name.encode().ljust(80, b" ") + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *(x for p in triangle for x in p), 0))


# What stands and what is glass in a glove box; the same bodies as scenes/glove_box.yaml has, but
# for the ring, which is round here and of eight boxes there.
write("glove_box_frame.stl",
      box((0.64, 0.90, 0.03), (0.54, -0.13, 0.185))
      + box((0.06, 0.06, 0.97), (0.83, 0.29, 0.685))
      + box((0.06, 0.06, 0.97), (0.83, -0.55, 0.685))
      + ring(0.09, 0.11, 0.06, (0.83, -0.12, 0.42), 48))
write("glove_box_glass.stl",
      box((0.006, 0.90, 0.97), (0.863, -0.13, 0.685))
      + box((0.64, 0.006, 0.97), (0.54, 0.323, 0.685))
      + box((0.64, 0.006, 0.97), (0.54, -0.583, 0.685))
      + box((0.64, 0.90, 0.006), (0.54, -0.13, 1.173)))
