#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""bumpy_sphere.py N FILE: a sphere of 0.1 m with bumps of 5 mm as a binary STL file of 4 N (N - 1)
triangles: a million for N = 500. By hand: a facet is one line of struct."""

import math
import struct
import sys


def point(n, i, k):
    """Latitude i of n, longitude k of 2 n, as three floats; the poles are the same for every k."""
    u, v = math.pi * i / n, math.pi * (k % (2 * n)) / n
    r = 0.1 * (1 + 0.05 * math.sin(9 * u) * math.sin(7 * v) * math.sin(u) ** 2)
    around = r * math.sin(u) if 0 < i < n else 0.0
    return struct.pack("<3f", around * math.cos(v), around * math.sin(v), r * math.cos(u))


def main(n, path):
    n = int(n)
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", 4 * n * (n - 1)))
        above = [point(n, 0, k) for k in range(2 * n)]
        for i in range(n):
            below = [point(n, i + 1, k) for k in range(2 * n)]
            for k in range(2 * n):
                j = (k + 1) % (2 * n)
                if i < n - 1:
                    file.write(bytes(12) + above[k] + below[k] + below[j] + bytes(2))
                if i > 0:
                    file.write(bytes(12) + above[k] + below[j] + above[j] + bytes(2))
            above = below


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
