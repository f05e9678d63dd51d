"""Energy of the bending of yarns in the surface, with its first and second derivatives.

E = bend·Σ (s/c)² over the nodes inside a yarn. With a and b the unit chords before and after a node, and n the normal
of the part there, s = n·(a × b) is the sine of the turn in the surface, left positive; c is the mean of the two rest
lengths, so that E → bend·∫κ² ds/pitch with the geodesic curvature κ. Yarns are straight at rest. The normal turns as
its node moves; on a sphere that is what lets neighbouring geodesics meet. Derivatives are exact where the vertex
normals of the part are those of a sphere or plane, else but for what facets change, which is of second order. Where a
yarn crosses an edge no normal tells its turn in the surface: such nodes are left out.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fishnet.relax_energy import chords
from geomdrap.fishnet.relax_surface import CREASE_COSINE
from geomdrap.geodesic.compiled import kernel, tight


@tight
def put_turn_axis(line: np.ndarray, i: int, j: int, di: int, dj: int, axis: np.ndarray) -> None:
    """Put into ``axis`` (3,) the product a × b of the chords before and after node (i, j)."""
    k, m = i - di, j - dj
    axis[0] = line[k, m, 1] * line[i, j, 2] - line[k, m, 2] * line[i, j, 1]
    axis[1] = line[k, m, 2] * line[i, j, 0] - line[k, m, 0] * line[i, j, 2]
    axis[2] = line[k, m, 0] * line[i, j, 1] - line[k, m, 1] * line[i, j, 0]


def smooth_bends(normal: np.ndarray) -> np.ndarray:
    """Which nodes of warp and weft yarns (2, nu, nv) have no edge of the part next to them.

    ``normal`` (nu, nv, 3) unit normals at the nodes, 0 where there is none.
    """
    smooth = np.zeros((2, *normal.shape[:2]), bool)
    for family in range(2):
        n = normal.swapaxes(0, family)
        step = np.einsum("ijk,ijk->ij", n[1:], n[:-1]) >= CREASE_COSINE
        smooth[family].swapaxes(0, family)[1:-1] = step[1:] & step[:-1]
    return smooth


@kernel
def bending_energy(
    x: np.ndarray, normal: np.ndarray, smooth: np.ndarray, rest_u: np.ndarray, rest_v: np.ndarray, bend: float
) -> float:
    """Energy of nodes x (nu, nv, 3) mm with unit normals (nu, nv, 3) of the part; rests as in ``energy``.

    ``smooth`` (2, nu, nv) bool: which nodes of warp and weft yarns count (``smooth_bends``).
    """
    total, axis = 0.0, np.empty(3)
    for family in range(2):
        rest, di, dj = rest_u if family == 0 else rest_v, 1 - family, family
        line = chords(x, rest, di, dj)
        for i in range(di, rest.shape[0]):
            for j in range(dj, rest.shape[1]):
                if smooth[family, i, j] and rest[i, j] > 0.0 and rest[i - di, j - dj] > 0.0:
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
    """The sine s at node (i, j); put into ``slope`` (3, 3) its derivatives by the nodes before, there, and after.

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
def put_variations(
    line: np.ndarray,
    normal: np.ndarray,
    turning: np.ndarray,
    basis: np.ndarray,
    i: int,
    j: int,
    di: int,
    dj: int,
    s: float,
    ones: np.ndarray,
    others: np.ndarray,
) -> None:
    """Put into ``ones`` and ``others`` (6, 14) what makes ∇²s at node (i, j): ones·othersᵀ + others·onesᵀ.

    Along the two tangent vectors of the node before, this one and the next. With δa, δb, δn of the chords and the
    normal, δ²s = 2 n·(δa × δb) + 2 δn·δ(a × b) + δ²n·(a × b) + n·(δ²a × b) + n·(a × δ²b), where δ²n = −n |δn|² and
    δ²a = −2 (a·δ)/|A| δa − a |δa|²: how the curvature of the part changes is left out.
    """
    k, m = i - di, j - dj
    nx, ny, nz = normal[i, j, 0], normal[i, j, 1], normal[i, j, 2]
    ax, ay, az, a = line[k, m, 0], line[k, m, 1], line[k, m, 2], line[k, m, 3]
    bx, by, bz, b = line[i, j, 0], line[i, j, 1], line[i, j, 2], line[i, j, 3]
    for r in range(6):
        node = r // 2
        p, q = i + (node - 1) * di, j + (node - 1) * dj
        tx, ty, tz = basis[p, q, 0, r % 2], basis[p, q, 1, r % 2], basis[p, q, 2, r % 2]
        by_a = (-1.0, 1.0, 0.0)[node] / a
        by_b = (0.0, -1.0, 1.0)[node] / b
        along_a, along_b = by_a * (ax * tx + ay * ty + az * tz), by_b * (bx * tx + by * ty + bz * tz)
        dax, day, daz = by_a * tx - along_a * ax, by_a * ty - along_a * ay, by_a * tz - along_a * az
        dbx, dby, dbz = by_b * tx - along_b * bx, by_b * ty - along_b * by, by_b * tz - along_b * bz
        ux, uy, uz = ny * daz - nz * day, nz * dax - nx * daz, nx * day - ny * dax  # n × δa
        vx, vy, vz = dby * nz - dbz * ny, dbz * nx - dbx * nz, dbx * ny - dby * nx  # δb × n
        ones[r, 0], ones[r, 1], ones[r, 2] = ux, uy, uz
        others[r, 0], others[r, 1], others[r, 2] = dbx, dby, dbz
        for e in range(3):
            ones[r, 3 + e] = 0.0
            if node == 1:
                ones[r, 3 + e] = turning[i, j, e, 0] * tx + turning[i, j, e, 1] * ty + turning[i, j, e, 2] * tz
        up = ones[r, 3] * nx + ones[r, 4] * ny + ones[r, 5] * nz
        ones[r, 3], ones[r, 4], ones[r, 5] = ones[r, 3] - up * nx, ones[r, 4] - up * ny, ones[r, 5] - up * nz
        others[r, 3] = day * bz - daz * by + ay * dbz - az * dby - 0.5 * s * ones[r, 3]
        others[r, 4] = daz * bx - dax * bz + az * dbx - ax * dbz - 0.5 * s * ones[r, 4]
        others[r, 5] = dax * by - day * bx + ax * dby - ay * dbx - 0.5 * s * ones[r, 5]
        ones[r, 6], others[r, 6] = -along_a, ux * bx + uy * by + uz * bz
        ones[r, 7], others[r, 7] = -along_b, vx * ax + vy * ay + vz * az
        others[r, 8], others[r, 9], others[r, 10] = dax, day, daz
        others[r, 11], others[r, 12], others[r, 13] = dbx, dby, dbz
        for e in range(8, 14):
            ones[r, e] = -0.5 * s * others[r, e]


@tight
def add_forces(
    g: np.ndarray, size: np.ndarray, i: int, j: int, di: int, dj: int, moment: float, slope: np.ndarray
) -> None:
    """Add the first derivatives of the bend at node (i, j), from ``slope`` (3, 3)."""
    for n in range(3):
        k, m = i + (n - 1) * di, j + (n - 1) * dj
        square = 0.0
        for r in range(3):
            g[k, m, r] += moment * slope[n, r]
            square += slope[n, r] * slope[n, r]
        size[k, m] += abs(moment) * math.sqrt(square)


@tight
def put_positive(
    basis: np.ndarray, i: int, j: int, di: int, dj: int, stiffness: float, slope: np.ndarray, k: np.ndarray
) -> None:
    """Put stiffness·∇s∇sᵀ of the bend at node (i, j) into k (6, 6), from ``slope`` (3, 3)."""
    for r in range(6):
        n, p, q = r // 2, i + (r // 2 - 1) * di, j + (r // 2 - 1) * dj
        k[r, r] = (
            slope[n, 0] * basis[p, q, 0, r % 2]
            + slope[n, 1] * basis[p, q, 1, r % 2]
            + slope[n, 2] * basis[p, q, 2, r % 2]
        )
    for r in range(6):
        for s in range(r):
            k[s, r] = stiffness * k[r, r] * k[s, s]
            k[r, s] = k[s, r]
    for r in range(6):
        k[r, r] = stiffness * k[r, r] * k[r, r]


@tight
def add_variations(ones: np.ndarray, others: np.ndarray, moment: float, k: np.ndarray) -> None:
    """Add moment·∇²s to k (6, 6), from ``put_variations``."""
    for r in range(6):
        for s in range(6):
            total = 0.0
            for e in range(14):
                total += ones[r, e] * others[s, e] + ones[s, e] * others[r, e]
            k[r, s] += moment * total


@tight
def add_turn(h: np.ndarray, i: int, j: int, di: int, dj: int, k: np.ndarray) -> None:
    """Add the second derivative k (6, 6) of the bend at node (i, j) to h."""
    for n in range(3):
        p, q = i + (n - 1) * di, j + (n - 1) * dj
        for o in range(n, 3):
            at = 0 if o == n else (3 if di == 1 else 1) if o == n + 1 else (6 if di == 1 else 5)
            for a in range(2):
                for b in range(2):
                    h[p, q, at, a, b] += k[2 * n + a, 2 * o + b]


@kernel
def add_bending(
    x: np.ndarray,
    basis: np.ndarray,
    normal: np.ndarray,
    turning: np.ndarray,
    smooth: np.ndarray,
    rest_u: np.ndarray,
    rest_v: np.ndarray,
    bend: float,
    full: bool,
    g: np.ndarray,
    h: np.ndarray,
    size: np.ndarray,
) -> None:
    """Add what bending has to the ``derivatives``: to g (nu, nv, 3), h (nu, nv, 7, 2, 2) and size (nu, nv).

    ``basis`` (nu, nv, 3, 2) tangent vectors, ``turning`` (nu, nv, 3, 3) per mm of the normals (``Footing``),
    ``smooth`` (2, nu, nv) which nodes count. The last two blocks of h are with the nodes next but one
    (``dissection``). Where not ``full`` the second derivative is made positive by leaving out that of the turns.
    """
    slope, axis, k = np.empty((3, 3)), np.empty(3), np.empty((6, 6))
    ones, others = np.empty((6, 14)), np.empty((6, 14))
    for family in range(2):
        rest, di, dj = rest_u if family == 0 else rest_v, 1 - family, family
        line = chords(x, rest, di, dj)
        for i in range(di, rest.shape[0]):
            for j in range(dj, rest.shape[1]):
                if smooth[family, i, j] and rest[i, j] > 0.0 and rest[i - di, j - dj] > 0.0:
                    put_turn_axis(line, i, j, di, dj, axis)
                    s = put_slopes(line, normal, turning, i, j, di, dj, axis, slope)
                    c = 0.5 * (rest[i, j] + rest[i - di, j - dj])
                    stiffness = 2.0 * bend / (c * c)
                    add_forces(g, size, i, j, di, dj, stiffness * s, slope)
                    put_positive(basis, i, j, di, dj, stiffness, slope, k)
                    if full:
                        put_variations(line, normal, turning, basis, i, j, di, dj, s, ones, others)
                        add_variations(ones, others, stiffness * s, k)
                    add_turn(h, i, j, di, dj, k)
