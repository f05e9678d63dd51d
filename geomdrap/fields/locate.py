"""Fabric coordinates of points of the part, by walking through the net from a point where they are known.

Coordinates here count cells from the first node of the lattice: (p, q) is between nodes floor(p) and floor(p) + 1.
Walking from neighbour to neighbour keeps to one sheet of thin walls and of nets that come near themselves, where the
nearest cell in space may be the wrong one.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.geodesic.compiled import inlined, kernel

ROUNDS = 60
INSIDE = 1e-6  # cells: rounding at the border between two
OFF = 0.2  # cells: a point further than this from the patch of its cell is not on it, or the patch cuts a corner


@inlined
def cell_at(valid: np.ndarray, p: float, q: float) -> tuple[int, int]:
    """Cell that holds (p, q), clipped to the lattice."""
    i = min(max(int(math.floor(p)), 0), valid.shape[0] - 1)
    j = min(max(int(math.floor(q)), 0), valid.shape[1] - 1)
    return i, j


@inlined
def newton_step(
    lattice: np.ndarray, i: int, j: int, s: float, t: float, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """Gauss-Newton step (ds, dt) toward the foot of a point on the bilinear patch of a cell, and its distance²."""
    ss = st = tt = sr = tr = away2 = 0.0
    for k in range(3):
        a, b = lattice[i, j, k], lattice[i + 1, j, k]
        c, d = lattice[i + 1, j + 1, k], lattice[i, j + 1, k]
        here = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d
        along_s = (1 - t) * (b - a) + t * (c - d)
        along_t = (1 - s) * (d - a) + s * (c - b)
        r = (x if k == 0 else y if k == 1 else z) - here
        ss += along_s * along_s
        st += along_s * along_t
        tt += along_t * along_t
        sr += along_s * r
        tr += along_t * r
        away2 += r * r
    det = ss * tt - st * st
    if det <= 1e-14 * ss * tt:
        return 0.0, 0.0, away2
    return (tt * sr - st * tr) / det, (ss * tr - st * sr) / det, away2


@kernel
def locate(
    lattice: np.ndarray, valid: np.ndarray, p: float, q: float, x: float, y: float, z: float, side: float
) -> tuple[bool, float, float]:
    """Fabric coordinates of a point that lies in a valid cell, walking from (p, q).

    ``lattice`` (nu, nv, 3) mm, ``valid`` (nu - 1, nv - 1), ``side`` mm. False where the walk ends outside.
    """
    i, j = cell_at(valid, p, q)
    for _ in range(ROUNDS):
        if not valid[i, j]:
            return False, p, q
        s, t = p - i, q - j
        ds, dt, away2 = newton_step(lattice, i, j, s, t, x, y, z)
        ds, dt = min(max(ds, -1.0), 1.0), min(max(dt, -1.0), 1.0)
        p, q = p + ds, q + dt
        k, m = cell_at(valid, p, q)
        # at the border of the net the foot may lie a rounding error outside; further out there is no cell
        if (k != i or m != j) and not valid[k, m]:
            p = min(max(p, float(i)), i + 1.0) if abs(p - min(max(p, float(i)), i + 1.0)) < INSIDE else p
            q = min(max(q, float(j)), j + 1.0) if abs(q - min(max(q, float(j)), j + 1.0)) < INSIDE else q
            if p < i or p > i + 1.0 or q < j or q > j + 1.0:
                return False, p, q
            k, m = i, j
        if abs(ds) < 1e-9 and abs(dt) < 1e-9:
            out_p = max(k - p, p - k - 1.0)
            out_q = max(m - q, q - m - 1.0)
            return max(out_p, out_q) <= INSIDE and away2 <= (OFF * side) ** 2, p, q
        i, j = k, m
    return False, p, q
