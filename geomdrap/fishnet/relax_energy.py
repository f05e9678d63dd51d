"""Energy of a net that resists stretching and shear, with its exact first and second derivatives.

E = piece·Σ e² over yarn pieces + yarn·Σ (Σ e)² over whole yarns + Σ W(s) over corners of cells, with the strain
e = l/c − 1 of a piece, s = sin γ at a corner less a target, and W = ratio/4·(1 ± alpha)·s² + lock/4·(|s| − s_lock)²₊.
Usually piece = 1, and yarn and targets are 0; the other way round yarns slide at their crossings. Lengths and angles
are those of the straight lines between nodes; c is the length of that line in the geometric net, so that what a chord
cuts short of a curved yarn counts nowhere.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from geomdrap.geodesic.compiled import inlined, kernel


class Law(NamedTuple):
    """The factors of the energy: see the module."""

    ratio: float
    alpha: float = 0.0
    lock: float = 0.0
    lock_sine: float = 1.0
    piece: float = 1.0
    yarn: float = 0.0


@kernel
def strain_sums(x: np.ndarray, rest_u: np.ndarray, rest_v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sum of the strains of the pieces of each warp yarn (nv,) and of each weft yarn (nu,)."""
    warp, weft = np.zeros(x.shape[1]), np.zeros(x.shape[0])
    for i in range(x.shape[0]):
        for j in range(x.shape[1]):
            if i + 1 < x.shape[0] and rest_u[i, j] > 0.0:
                warp[j] += math.sqrt(((x[i + 1, j] - x[i, j]) ** 2).sum()) / rest_u[i, j] - 1.0
            if j + 1 < x.shape[1] and rest_v[i, j] > 0.0:
                weft[i] += math.sqrt(((x[i, j + 1] - x[i, j]) ** 2).sum()) / rest_v[i, j] - 1.0
    return warp, weft


@inlined
def shear_energy(law: Law, s: float) -> tuple[float, float, float]:
    """W at the sine s of the shear, and its first two derivatives."""
    stiff = 0.5 * law.ratio * (1.0 + law.alpha if s > 0.0 else 1.0 - law.alpha)
    over = abs(s) - law.lock_sine
    w, dw, ddw = 0.5 * stiff * s * s, stiff * s, stiff
    if over > 0.0:
        w += 0.25 * law.lock * over * over
        dw += 0.5 * law.lock * math.copysign(over, s)
        ddw += 0.5 * law.lock
    return w, dw, ddw


@kernel
def energy(
    x: np.ndarray, valid: np.ndarray, target: np.ndarray, rest_u: np.ndarray, rest_v: np.ndarray, law: Law
) -> float:
    """Energy of nodes x (nu, nv, 3) in the cells ``valid`` (nu - 1, nv - 1) with sines ``target`` (nu - 1, nv - 1, 2,
    2).

    ``rest_u`` (nu - 1, nv), ``rest_v`` (nu, nv - 1): lengths c of the pieces, mm, 0 where there is none.
    """
    warp, weft = strain_sums(x, rest_u, rest_v)
    total = law.yarn * ((warp**2).sum() + (weft**2).sum())
    for i in range(x.shape[0]):
        for j in range(x.shape[1]):
            if i + 1 < x.shape[0] and rest_u[i, j] > 0.0:
                total += law.piece * (math.sqrt(((x[i + 1, j] - x[i, j]) ** 2).sum()) / rest_u[i, j] - 1.0) ** 2
            if j + 1 < x.shape[1] and rest_v[i, j] > 0.0:
                total += law.piece * (math.sqrt(((x[i, j + 1] - x[i, j]) ** 2).sum()) / rest_v[i, j] - 1.0) ** 2
    for i in range(valid.shape[0]):
        for j in range(valid.shape[1]):
            if valid[i, j]:
                for di in range(2):
                    for dj in range(2):
                        p = x[i + di, j + dj]
                        q, t = x[i + 1 - di, j + dj] - p, x[i + di, j + 1 - dj] - p
                        f = (q * t).sum() / math.sqrt((q * q).sum() * (t * t).sum())
                        total += shear_energy(law, (f if di == dj else -f) - target[i, j, di, dj])[0]
    return total


@kernel
def add_block(h: np.ndarray, basis: np.ndarray, i: int, j: int, k: int, m: int, block: np.ndarray) -> None:
    """Add a second derivative (3, 3) between nodes (i, j) and (k, m) to the tangent one h (nu, nv, 3, 3, 2, 2)."""
    for a in range(2):
        for b in range(2):
            total = 0.0
            for r in range(3):
                for s in range(3):
                    total += basis[i, j, r, a] * block[r, s] * basis[k, m, s, b]
            h[i, j, k - i + 1, m - j + 1, a, b] += total


@kernel
def add_piece_terms(
    x: np.ndarray,
    basis: np.ndarray,
    g: np.ndarray,
    h: np.ndarray,
    size: np.ndarray,
    i: int,
    j: int,
    k: int,
    m: int,
    c: float,
    stiffness: float,
    tension: float,
    full: bool,
) -> None:
    """Derivatives of one yarn piece from node (i, j) to (k, m), with the ``tension`` of its whole yarn."""
    d = x[k, m] - x[i, j]
    length = math.sqrt((d * d).sum())
    d = d / length
    pull = (2.0 * stiffness * (length / c - 1.0) + tension) / c
    g[k, m] += pull * d
    g[i, j] -= pull * d
    size[i, j] += abs(pull)
    size[k, m] += abs(pull)
    across = pull / length if full else max(pull / length, 0.0)
    block = np.empty((3, 3))
    for r in range(3):
        for s in range(3):
            block[r, s] = (2.0 * stiffness / c**2 - across) * d[r] * d[s] + (across if r == s else 0.0)
    add_block(h, basis, i, j, i, j, block)
    add_block(h, basis, k, m, k, m, block)
    add_block(h, basis, i, j, k, m, -block)
    add_block(h, basis, k, m, i, j, -block)


@kernel
def add_corner_terms(
    x: np.ndarray,
    basis: np.ndarray,
    g: np.ndarray,
    h: np.ndarray,
    size: np.ndarray,
    i: int,
    j: int,
    k: int,
    m: int,
    sign: float,
    target: float,
    law: Law,
    full: bool,
) -> None:
    """Derivatives of the corner at node (i, j) between its neighbours (k, j) and (i, m)."""
    q, t = x[k, j] - x[i, j], x[i, m] - x[i, j]
    lq, lt = math.sqrt((q * q).sum()), math.sqrt((t * t).sum())
    q, t = q / lq, t / lt
    f = (q * t).sum()
    _, dw, ddw = shear_energy(law, sign * f - target)
    dw *= sign
    gq, gt = (t - f * q) / lq, (q - f * t) / lt
    g[k, j] += dw * gq
    g[i, m] += dw * gt
    g[i, j] -= dw * (gq + gt)
    size[k, j] += abs(dw) / lq
    size[i, m] += abs(dw) / lt
    size[i, j] += abs(dw) / lq + abs(dw) / lt
    qq, tt, qt = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    bend = dw if full else 0.0
    for r in range(3):
        for s in range(3):
            one = 1.0 if r == s else 0.0
            qq[r, s] = ddw * gq[r] * gq[s] - bend * (gq[r] * q[s] + q[r] * gq[s] + f * (one - q[r] * q[s]) / lq) / lq
            tt[r, s] = ddw * gt[r] * gt[s] - bend * (gt[r] * t[s] + t[r] * gt[s] + f * (one - t[r] * t[s]) / lt) / lt
            both = one - q[r] * q[s] - t[r] * t[s] + f * q[r] * t[s]
            qt[r, s] = ddw * gq[r] * gt[s] + bend * both / (lq * lt)
    tq = qt.T.copy()
    add_block(h, basis, k, j, k, j, qq)
    add_block(h, basis, i, m, i, m, tt)
    add_block(h, basis, k, j, i, m, qt)
    add_block(h, basis, i, m, k, j, tq)
    add_block(h, basis, i, j, k, j, -(qq + tq))
    add_block(h, basis, k, j, i, j, -(qq + qt))
    add_block(h, basis, i, j, i, m, -(tt + qt))
    add_block(h, basis, i, m, i, j, -(tt + tq))
    add_block(h, basis, i, j, i, j, qq + tt + qt + tq)


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
    """Gradient (nu, nv, 3), second derivative (nu, nv, 3, 3, 2, 2) and size of the forces (nu, nv).

    The second derivative is that along the tangent vectors ``basis`` (nu, nv, 3, 2) of a node and of its eight
    neighbours, without the part of the surface's curvature and that of whole yarns; where not ``full`` it is made
    positive by leaving out what may be negative. The size is the sum of the forces at a node without regard to their
    directions.
    """
    nu, nv = x.shape[0], x.shape[1]
    g = np.zeros((nu, nv, 3))
    h = np.zeros((nu, nv, 3, 3, 2, 2))
    size = np.zeros((nu, nv))
    warp, weft = strain_sums(x, rest_u, rest_v)
    warp, weft = 2.0 * law.yarn * warp, 2.0 * law.yarn * weft
    for i in range(nu):
        for j in range(nv):
            if i + 1 < nu and rest_u[i, j] > 0.0:
                add_piece_terms(x, basis, g, h, size, i, j, i + 1, j, rest_u[i, j], law.piece, warp[j], full)
            if j + 1 < nv and rest_v[i, j] > 0.0:
                add_piece_terms(x, basis, g, h, size, i, j, i, j + 1, rest_v[i, j], law.piece, weft[i], full)
    for i in range(nu - 1):
        for j in range(nv - 1):
            if valid[i, j]:
                for di in range(2):
                    for dj in range(2):
                        sign = 1.0 if di == dj else -1.0
                        k, m, far_k, far_m = i + di, j + dj, i + 1 - di, j + 1 - dj  # the corner, and those beside it
                        aim = target[i, j, di, dj]
                        add_corner_terms(x, basis, g, h, size, k, m, far_k, far_m, sign, aim, law, full)
    return g, h, size
