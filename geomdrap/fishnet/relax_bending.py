"""Energy of the bending of yarns in the surface, with its exact first derivatives and a positive second derivative.

E = bend·Σ (s/c)² over the nodes inside a yarn. With a and b the unit chords before and after a node, and n the normal
of the part there, s = n·(a × b) is the sine of the turn in the surface, left positive; c is the mean of the two rest
lengths, so that E → bend·∫κ² ds/pitch with the geodesic curvature κ. Yarns are straight at rest. The normal turns as
its node moves; on a sphere that is what lets neighbouring geodesics meet.
"""

from __future__ import annotations

import numpy as np

from geomdrap.fishnet.relax_energy import chords
from geomdrap.geodesic.compiled import kernel, tight


@tight
def put_turn_axis(line: np.ndarray, i: int, j: int, di: int, dj: int, axis: np.ndarray) -> None:
    """Put into ``axis`` (3,) the product a × b of the chords before and after node (i, j)."""
    k, m = i - di, j - dj
    axis[0] = line[k, m, 1] * line[i, j, 2] - line[k, m, 2] * line[i, j, 1]
    axis[1] = line[k, m, 2] * line[i, j, 0] - line[k, m, 0] * line[i, j, 2]
    axis[2] = line[k, m, 0] * line[i, j, 1] - line[k, m, 1] * line[i, j, 0]


@kernel
def bending_energy(x: np.ndarray, normal: np.ndarray, rest_u: np.ndarray, rest_v: np.ndarray, bend: float) -> float:
    """Energy of nodes x (nu, nv, 3) mm with unit normals (nu, nv, 3) of the part; rests as in ``energy``."""
    total, axis = 0.0, np.empty(3)
    for family in range(2):
        rest, di, dj = rest_u if family == 0 else rest_v, 1 - family, family
        line = chords(x, rest, di, dj)
        for i in range(di, rest.shape[0]):
            for j in range(dj, rest.shape[1]):
                if rest[i, j] > 0.0 and rest[i - di, j - dj] > 0.0:
                    put_turn_axis(line, i, j, di, dj, axis)
                    s = normal[i, j, 0] * axis[0] + normal[i, j, 1] * axis[1] + normal[i, j, 2] * axis[2]
                    total += (2.0 * s / (rest[i, j] + rest[i - di, j - dj])) ** 2
    return bend * total


@tight
def put_slopes(
    line: np.ndarray,
    normal: np.ndarray,
    turning: np.ndarray,
    i: int,
    j: int,
    di: int,
    dj: int,
    axis: np.ndarray,
    slope: np.ndarray,
) -> float:
    """The sine s at node (i, j); put into ``slope`` (3, 3) its derivatives by the node before, this one, and the next.

    ``axis`` (3,) is that of ``put_turn_axis``.
    """
    k, m = i - di, j - dj
    nx, ny, nz = normal[i, j, 0], normal[i, j, 1], normal[i, j, 2]
    ax, ay, az, a = line[k, m, 0], line[k, m, 1], line[k, m, 2], line[k, m, 3]
    bx, by, bz, b = line[i, j, 0], line[i, j, 1], line[i, j, 2], line[i, j, 3]
    s = nx * axis[0] + ny * axis[1] + nz * axis[2]
    slope[0, 0], slope[2, 0] = -(by * nz - bz * ny - s * ax) / a, (ny * az - nz * ay - s * bx) / b
    slope[0, 1], slope[2, 1] = -(bz * nx - bx * nz - s * ay) / a, (nz * ax - nx * az - s * by) / b
    slope[0, 2], slope[2, 2] = -(bx * ny - by * nx - s * az) / a, (nx * ay - ny * ax - s * bz) / b
    wx, wy, wz = axis[0] - s * nx, axis[1] - s * ny, axis[2] - s * nz  # a unit normal turns across itself only
    for r in range(3):
        turned = wx * turning[i, j, 0, r] + wy * turning[i, j, 1, r] + wz * turning[i, j, 2, r]
        slope[1, r] = turned - slope[0, r] - slope[2, r]
    return s


@tight
def add_turn(
    basis: np.ndarray,
    g: np.ndarray,
    h: np.ndarray,
    size: np.ndarray,
    i: int,
    j: int,
    di: int,
    dj: int,
    moment: float,
    stiffness: float,
    slope: np.ndarray,
    onto: np.ndarray,
) -> None:
    """Add the derivatives of the bend at node (i, j), from ``slope`` (3, 3); ``onto`` (3, 2) is for use in it."""
    for n in range(3):
        k, m = i + (n - 1) * di, j + (n - 1) * dj
        square = 0.0
        for r in range(3):
            g[k, m, r] += moment * slope[n, r]
            square += slope[n, r] * slope[n, r]
        size[k, m] += abs(moment) * np.sqrt(square)
        for a in range(2):
            onto[n, a] = (
                slope[n, 0] * basis[k, m, 0, a] + slope[n, 1] * basis[k, m, 1, a] + slope[n, 2] * basis[k, m, 2, a]
            )
    for n in range(3):
        k, m = i + (n - 1) * di, j + (n - 1) * dj
        for o in range(n, 3):
            at = 0 if o == n else (3 if di == 1 else 1) if o == n + 1 else (6 if di == 1 else 5)
            for a in range(2):
                for b in range(2):
                    h[k, m, at, a, b] += stiffness * onto[n, a] * onto[o, b]


@kernel
def add_bending(
    x: np.ndarray,
    basis: np.ndarray,
    normal: np.ndarray,
    turning: np.ndarray,
    rest_u: np.ndarray,
    rest_v: np.ndarray,
    bend: float,
    g: np.ndarray,
    h: np.ndarray,
    size: np.ndarray,
) -> None:
    """Add what bending has to the ``derivatives``: to g (nu, nv, 3), h (nu, nv, 7, 2, 2) and size (nu, nv).

    ``basis`` (nu, nv, 3, 2) tangent vectors, ``turning`` (nu, nv, 3, 3) per mm of the normals (``Footing``). The last
    two blocks of h are with the nodes next but one (``dissection``). Of the second derivative only the part that is
    positive is there: what it lacks is as the turns to one.
    """
    slope, onto, axis = np.empty((3, 3)), np.empty((3, 2)), np.empty(3)
    for family in range(2):
        rest, di, dj = rest_u if family == 0 else rest_v, 1 - family, family
        line = chords(x, rest, di, dj)
        for i in range(di, rest.shape[0]):
            for j in range(dj, rest.shape[1]):
                if rest[i, j] > 0.0 and rest[i - di, j - dj] > 0.0:
                    put_turn_axis(line, i, j, di, dj, axis)
                    s = put_slopes(line, normal, turning, i, j, di, dj, axis, slope)
                    c = 0.5 * (rest[i, j] + rest[i - di, j - dj])
                    stiffness = 2.0 * bend / (c * c)
                    add_turn(basis, g, h, size, i, j, di, dj, stiffness * s, stiffness, slope, onto)
