"""Energy of a net that resists stretching and shear, with its exact first and second derivatives.

E = piece·Σ e² over yarn pieces + yarn·Σ (Σ e)² over whole yarns + Σ W(s) over corners of cells, and what
``relax_bending`` has, with the strain e = l/c − 1 of a piece, s = sin γ at a corner, s* its target, and
W = ratio/4·(1 ± alpha)·(s − s*)² + lock/4·(|s| − s_lock)²₊.
Usually piece = 1, and yarn and targets are 0; with yarn in place of piece, yarns slide at their crossings; with the
sines of the geometric net for targets, friction holds the shear as it was laid. Lengths and angles
are those of the straight lines between nodes; c is the length of that line in the geometric net, so that what a chord
cuts short of a curved yarn counts nowhere.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from geomdrap.geodesic.compiled import inlined, kernel, tight


class Law(NamedTuple):
    """The factors of the energy: see the module."""

    ratio: float
    alpha: float = 0.0
    lock: float = 0.0
    lock_sine: float = 1.0
    piece: float = 1.0
    yarn: float = 0.0
    bend: float = 0.0


@inlined
def shear_energy(law: Law, s: float, target: float) -> tuple[float, float, float]:
    """W at the sine s of the shear, and its first two derivatives."""
    off = s - target
    stiff = 0.5 * law.ratio * (1.0 + law.alpha if off > 0.0 else 1.0 - law.alpha)
    over = abs(s) - law.lock_sine
    w, dw, ddw = 0.5 * stiff * off * off, stiff * off, stiff
    if over > 0.0:
        w += 0.25 * law.lock * over * over
        dw += 0.5 * law.lock * math.copysign(over, s)
        ddw += 0.5 * law.lock
    return w, dw, ddw


@kernel
def chords(x: np.ndarray, rest: np.ndarray, di: int, dj: int) -> np.ndarray:
    """Unit direction and length (..., 4) of the line from each node to the one (di, dj) further; 0 where no rest."""
    line = np.zeros((*rest.shape, 4))
    for i in range(rest.shape[0]):
        for j in range(rest.shape[1]):
            if rest[i, j] > 0.0:
                dx = x[i + di, j + dj, 0] - x[i, j, 0]
                dy = x[i + di, j + dj, 1] - x[i, j, 1]
                dz = x[i + di, j + dj, 2] - x[i, j, 2]
                length = math.sqrt(dx * dx + dy * dy + dz * dz)
                line[i, j, 0], line[i, j, 1], line[i, j, 2] = dx / length, dy / length, dz / length
                line[i, j, 3] = length
    return line


@tight
def cosine(a: np.ndarray, i: int, j: int, b: np.ndarray, k: int, m: int) -> float:
    """Of the angle between two chords: the sine of the shear where they are of warp and weft."""
    return a[i, j, 0] * b[k, m, 0] + a[i, j, 1] * b[k, m, 1] + a[i, j, 2] * b[k, m, 2]


@kernel
def strain_sums(line: np.ndarray, rest: np.ndarray, axis: int) -> tuple[np.ndarray, float]:
    """Sum of the strains of the pieces of each yarn along ``axis`` (0 warp, 1 weft), and of all their squares.

    ``line`` (..., 4) are their `chords`.
    """
    along, squares = np.zeros(rest.shape[1 - axis]), 0.0
    for i in range(rest.shape[0]):
        for j in range(rest.shape[1]):
            if rest[i, j] > 0.0:
                strain = line[i, j, 3] / rest[i, j] - 1.0
                along[j if axis == 0 else i] += strain
                squares += strain * strain
    return along, squares


@kernel
def energy(
    x: np.ndarray, valid: np.ndarray, target: np.ndarray, rest_u: np.ndarray, rest_v: np.ndarray, law: Law
) -> float:
    """Energy of nodes x (nu, nv, 3) in the cells ``valid`` (nu - 1, nv - 1) with sines ``target`` (nu - 1, nv - 1, 2,
    2).

    ``rest_u`` (nu - 1, nv), ``rest_v`` (nu, nv - 1): lengths c of the pieces, mm, 0 where there is none.
    """
    warp, weft = chords(x, rest_u, 1, 0), chords(x, rest_v, 0, 1)
    along_u, squares_u = strain_sums(warp, rest_u, 0)
    along_v, squares_v = strain_sums(weft, rest_v, 1)
    total = law.piece * (squares_u + squares_v) + law.yarn * ((along_u**2).sum() + (along_v**2).sum())
    for i in range(valid.shape[0]):
        for j in range(valid.shape[1]):
            if valid[i, j]:
                for di in range(2):
                    for dj in range(2):
                        s = cosine(warp, i, j + dj, weft, i + di, j)
                        total += shear_energy(law, s, target[i, j, di, dj])[0]
    return total


@tight
def add_piece_terms(
    basis: np.ndarray,
    line: np.ndarray,
    g: np.ndarray,
    h: np.ndarray,
    size: np.ndarray,
    i: int,
    j: int,
    k: int,
    m: int,
    neighbour: int,
    c: float,
    stiffness: float,
    tension: float,
    full: bool,
) -> None:
    """Derivatives of one yarn piece from node (i, j) to its ``neighbour`` (k, m), with the tension of its yarn."""
    dx, dy, dz, length = line[i, j, 0], line[i, j, 1], line[i, j, 2], line[i, j, 3]
    pull = (2.0 * stiffness * (length / c - 1.0) + tension) / c
    g[i, j, 0] -= pull * dx
    g[i, j, 1] -= pull * dy
    g[i, j, 2] -= pull * dz
    g[k, m, 0] += pull * dx
    g[k, m, 1] += pull * dy
    g[k, m, 2] += pull * dz
    size[i, j] += abs(pull)
    size[k, m] += abs(pull)
    across = pull / length if full else max(pull / length, 0.0)
    along = 2.0 * stiffness / c**2 - across
    for a in range(2):
        ax, ay, az = basis[i, j, 0, a], basis[i, j, 1, a], basis[i, j, 2, a]
        bx, by, bz = basis[k, m, 0, a], basis[k, m, 1, a], basis[k, m, 2, a]
        here, there = along * (ax * dx + ay * dy + az * dz), along * (bx * dx + by * dy + bz * dz)
        for b in range(2):
            px, py, pz = basis[i, j, 0, b], basis[i, j, 1, b], basis[i, j, 2, b]
            qx, qy, qz = basis[k, m, 0, b], basis[k, m, 1, b], basis[k, m, 2, b]
            own, other = px * dx + py * dy + pz * dz, qx * dx + qy * dy + qz * dz
            h[i, j, 0, a, b] += here * own + across * (ax * px + ay * py + az * pz)
            h[k, m, 0, a, b] += there * other + across * (bx * qx + by * qy + bz * qz)
            h[i, j, neighbour, a, b] -= here * other + across * (ax * qx + ay * qy + az * qz)


@tight
def add_shear_forces(
    warp: np.ndarray,
    weft: np.ndarray,
    g: np.ndarray,
    size: np.ndarray,
    i: int,
    j: int,
    di: int,
    dj: int,
    f: float,
    dw: float,
) -> None:
    """First derivatives of the corner (di, dj) of cell (i, j), where the cosine of its two chords is f."""
    k, m = i + di, j + dj
    by_u, by_v = dw / warp[i, m, 3], dw / weft[k, j, 3]
    for r in range(3):
        u, v = warp[i, m, r], weft[k, j, r]
        g[i, m, r] -= by_u * (v - f * u)
        g[i + 1, m, r] += by_u * (v - f * u)
        g[k, j, r] -= by_v * (u - f * v)
        g[k, j + 1, r] += by_v * (u - f * v)
    size[i, m] += abs(by_u)
    size[i + 1, m] += abs(by_u)
    size[k, j] += abs(by_v)
    size[k, j + 1] += abs(by_v)


@tight
def project_chords(basis: np.ndarray, warp: np.ndarray, weft: np.ndarray, i: int, j: int, onto: np.ndarray) -> None:
    """Put into ``onto`` (4, 8) the two warp and two weft chords of a cell along the tangents of its four nodes."""
    for n in range(4):
        for a in range(2):
            k, m = i + n // 2, j + n % 2
            bx, by, bz = basis[k, m, 0, a], basis[k, m, 1, a], basis[k, m, 2, a]
            for e in range(2):
                onto[e, 2 * n + a] = warp[i, j + e, 0] * bx + warp[i, j + e, 1] * by + warp[i, j + e, 2] * bz
                onto[2 + e, 2 * n + a] = weft[i + e, j, 0] * bx + weft[i + e, j, 1] * by + weft[i + e, j, 2] * bz


@tight
def add_corner_stiffness(
    onto: np.ndarray, vectors: np.ndarray, k: np.ndarray, di: int, dj: int, f: float, lu: float, lv: float, ddw: float
) -> None:
    """Add ddw·∇f∇fᵀ of a corner to the cell's k (8, 8), and leave the projections in ``vectors`` (7, 8)."""
    for n in range(4):
        by_u = (2.0 * (n // 2) - 1.0) if n % 2 == dj else 0.0  # how the chords change with this node
        by_v = (2.0 * (n % 2) - 1.0) if n // 2 == di else 0.0
        for r in range(2 * n, 2 * n + 2):
            u, v = onto[dj, r], onto[2 + di, r]
            vectors[0, r], vectors[1, r] = by_u * u, by_u * v
            vectors[2, r], vectors[3, r] = by_v * v, by_v * u
            vectors[4, r] = (by_u * v - f * by_u * u) / lu + (by_v * u - f * by_v * v) / lv
    for r in range(8):
        scaled = ddw * vectors[4, r]
        for s in range(8):
            k[r, s] += scaled * vectors[4, s]


@tight
def add_corner_bending(
    vectors: np.ndarray,
    k: np.ndarray,
    weights: np.ndarray,
    di: int,
    dj: int,
    f: float,
    lu: float,
    lv: float,
    dw: float,
) -> None:
    """Add dw·∇²f of a corner: to k (8, 8), and what multiplies products of tangents to ``weights`` (4, 4)."""
    uu, vv, uv = dw / (lu * lu), dw / (lv * lv), dw / (lu * lv)
    for r in range(8):
        a, c, b, d = vectors[0, r], vectors[1, r], vectors[2, r], vectors[3, r]
        vectors[5, r] = uu * (1.5 * f * a - c) + uv * (0.5 * f * b - d)
        vectors[6, r] = vv * (1.5 * f * b - d) + uv * (0.5 * f * a - c)
    for r in range(8):
        a, b, y, z = vectors[0, r], vectors[2, r], vectors[5, r], vectors[6, r]
        for s in range(8):
            k[r, s] += a * vectors[5, s] + y * vectors[0, s] + b * vectors[6, s] + z * vectors[2, s]
    for n in range(4):
        n_u = (2.0 * (n // 2) - 1.0) if n % 2 == dj else 0.0
        n_v = (2.0 * (n % 2) - 1.0) if n // 2 == di else 0.0
        for m in range(4):
            m_u = (2.0 * (m // 2) - 1.0) if m % 2 == dj else 0.0
            m_v = (2.0 * (m % 2) - 1.0) if m // 2 == di else 0.0
            weights[n, m] += uv * (n_u * m_v + n_v * m_u) - f * (uu * n_u * m_u + vv * n_v * m_v)


@tight
def add_cell(
    basis: np.ndarray, h: np.ndarray, i: int, j: int, k: np.ndarray, weights: np.ndarray, full: bool
) -> None:
    """Add the second derivative k (8, 8) of a cell, and its weights (4, 4) of products of tangents, to h."""
    for n in range(4):
        ni, nj = i + n // 2, j + n % 2
        for m in range(n, 4):
            mi, mj = i + m // 2, j + m % 2
            at = 3 * (mi - ni) + mj - nj
            for a in range(2):
                for b in range(2):
                    total = k[2 * n + a, 2 * m + b]
                    if full:
                        total += weights[n, m] * (
                            basis[ni, nj, 0, a] * basis[mi, mj, 0, b]
                            + basis[ni, nj, 1, a] * basis[mi, mj, 1, b]
                            + basis[ni, nj, 2, a] * basis[mi, mj, 2, b]
                        )
                    h[ni, nj, at, a, b] += total


@kernel
def derivatives(
    x: np.ndarray,
    basis: np.ndarray,
    valid: np.ndarray,
    target: np.ndarray,
    rest_u: np.ndarray,
    rest_v: np.ndarray,
    law: Law,
    full: bool,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gradient (nu, nv, 3), second derivative (nu, nv, 5, 2, 2) and size of the forces (nu, nv).

    The second derivative is that along the tangent vectors ``basis`` (nu, nv, 3, 2) of a node and of itself and the
    four of its neighbours that come ``AFTER`` it (``dissection``), without the part of the surface's curvature and
    that of whole yarns; where not ``full`` it is made positive by leaving out what may be negative. The size is the
    sum of the forces at a node without regard to their directions.
    """
    nu, nv = x.shape[0], x.shape[1]
    g, h, size = np.zeros((nu, nv, 3)), np.zeros((nu, nv, 5, 2, 2)), np.zeros((nu, nv))
    warp, weft = chords(x, rest_u, 1, 0), chords(x, rest_v, 0, 1)
    along_u, along_v = strain_sums(warp, rest_u, 0)[0], strain_sums(weft, rest_v, 1)[0]
    pull_u, pull_v = 2.0 * law.yarn * along_u, 2.0 * law.yarn * along_v
    for i in range(nu):
        for j in range(nv):
            if i + 1 < nu and rest_u[i, j] > 0.0:
                c = rest_u[i, j]
                add_piece_terms(basis, warp, g, h, size, i, j, i + 1, j, 3, c, law.piece, pull_u[j], full)
            if j + 1 < nv and rest_v[i, j] > 0.0:
                c = rest_v[i, j]
                add_piece_terms(basis, weft, g, h, size, i, j, i, j + 1, 1, c, law.piece, pull_v[i], full)
    onto, vectors, k, weights = np.zeros((4, 8)), np.zeros((7, 8)), np.zeros((8, 8)), np.zeros((4, 4))
    for i in range(nu - 1):
        for j in range(nv - 1):
            if not valid[i, j]:
                continue
            k[:], weights[:] = 0.0, 0.0
            project_chords(basis, warp, weft, i, j, onto)
            for di in range(2):
                for dj in range(2):
                    f, lu, lv = cosine(warp, i, j + dj, weft, i + di, j), warp[i, j + dj, 3], weft[i + di, j, 3]
                    _, dw, ddw = shear_energy(law, f, target[i, j, di, dj])
                    add_shear_forces(warp, weft, g, size, i, j, di, dj, f, dw)
                    add_corner_stiffness(onto, vectors, k, di, dj, f, lu, lv, ddw)
                    if full:
                        add_corner_bending(vectors, k, weights, di, dj, f, lu, lv, dw)
            add_cell(basis, h, i, j, k, weights, full)
    return g, h, size
