"""Solution of the symmetric systems of a net, front by front.

Each front is a small dense matrix: what its own unknowns have with one another and with later ones, and what the two
fronts before it have passed on. Its own unknowns are eliminated without pivoting (L·D·Lᵀ), the rest is passed on.

Source: I. S. Duff and J. K. Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM
Trans. Math. Software 9 (1983).
"""

from __future__ import annotations

import numpy as np

from geomdrap.fishnet.dissection import FURTHER, Fronts
from geomdrap.geodesic.compiled import kernel, tight


@tight
def eliminate(a: np.ndarray, first: int) -> None:
    """Eliminate the ``first`` unknowns of the upper half of a (s, s) in place.

    Their rows are left as they were when their turn came: D·Lᵀ. Four at a time, from two rows at once, so that what
    is left is touched less often; columns are unsigned, without which the loops are not vectorised. What is below the
    diagonal is not used, and spoilt.
    """
    s = a.shape[0]
    for k in range(0, first, 4):
        end = min(k + 4, first)
        for p in range(k, end):
            for q in range(p + 1, end):
                subtract(a, p, q)
        if end < k + 4:
            for p in range(k, end):
                for q in range(end, s):
                    subtract(a, p, q)
            continue
        d0, d1, d2, d3 = 1.0 / a[k, k], 1.0 / a[k + 1, k + 1], 1.0 / a[k + 2, k + 2], 1.0 / a[k + 3, k + 3]
        for i in range(end, s - 1, 2):
            b0, b1, b2, b3 = a[k, i] * d0, a[k + 1, i] * d1, a[k + 2, i] * d2, a[k + 3, i] * d3
            c0, c1, c2, c3 = a[k, i + 1] * d0, a[k + 1, i + 1] * d1, a[k + 2, i + 1] * d2, a[k + 3, i + 1] * d3
            for j in range(np.uint64(i), np.uint64(s)):
                x0, x1, x2, x3 = a[k, j], a[k + 1, j], a[k + 2, j], a[k + 3, j]
                a[i, j] -= b0 * x0 + b1 * x1 + b2 * x2 + b3 * x3
                a[i + 1, j] -= c0 * x0 + c1 * x1 + c2 * x2 + c3 * x3
        if (s - end) % 2 == 1:
            for p in range(k, end):
                subtract(a, p, s - 1)


@tight
def subtract(a: np.ndarray, p: int, q: int) -> None:
    """Take from row q of a what eliminates unknown p < q."""
    c = a[p, q] / a[p, p]
    for j in range(np.uint64(q), np.uint64(a.shape[0])):
        a[q, j] -= c * a[p, j]


@tight
def add_own(
    a: np.ndarray,
    f: int,
    fronts: Fronts,
    place: np.ndarray,
    nodes: tuple[np.ndarray, np.ndarray],
    number: np.ndarray,
    blocks: np.ndarray,
    slopes: np.ndarray,
    soft: float,
) -> None:
    """Add to the front a (s, s) what its own unknowns have among themselves and with later ones."""
    n = len(nodes[0])
    for t in range(fronts.own[f]):
        unknown = fronts.unknowns[fronts.start[f] + t]
        if unknown >= 2 * n:
            a[t, t] -= soft
            continue
        node, r = unknown // 2, unknown % 2
        i, j = nodes[0][node], nodes[1][node]
        a[t, t] += blocks[node, 0, r, r]
        if r == 0:
            a[t, t + 1] += blocks[node, 0, 0, 1]
        for k in range(1, blocks.shape[1]):
            for turn in range(2):  # those after the node, and those before it
                k_i = i + FURTHER[k][0] if turn == 0 else i - FURTHER[k][0]
                k_j = j + FURTHER[k][1] if turn == 0 else j - FURTHER[k][1]
                if k_i < 0 or k_j < 0 or k_i >= number.shape[0] or k_j >= number.shape[1]:
                    continue
                other = number[k_i, k_j]
                if other < 0 or fronts.home[2 * other] < f or (turn == 1 and fronts.home[2 * other] == f):
                    continue
                for c in range(2):
                    q = place[2 * other + c]
                    a[min(t, q), max(t, q)] += blocks[node, k, r, c] if turn == 0 else blocks[other, k, c, r]
        if soft > 0.0:
            q = place[2 * n + j]
            a[min(t, q), max(t, q)] += slopes[0, unknown]
            q = place[2 * n + number.shape[1] + i]
            a[min(t, q), max(t, q)] += slopes[1, unknown]


@tight
def add_passed(a: np.ndarray, fronts: Fronts, place: np.ndarray, g: int, to: np.ndarray) -> None:
    """Add to the front a (s, s) what front g has passed on; ``to`` is room for places of its unknowns."""
    at, left, from_ = fronts.start[g] + fronts.own[g], fronts.left, fronts.passed[g]
    size = fronts.start[g + 1] - at
    for p in range(size):
        to[p] = place[fronts.unknowns[at + p]]
    for p in range(size):
        row = to[p]
        for q in range(p, size):
            other = to[q]
            if other >= row:
                a[row, other] += left[from_ + p * size + q]
            else:
                a[other, row] += left[from_ + p * size + q]


@tight
def reduce_right(a: np.ndarray, fronts: Fronts, f: int, x: np.ndarray, own: np.ndarray) -> None:
    """Eliminate front f, of which a (s, s) has the rows D·Lᵀ, from the right-hand side x; ``own`` is room for s."""
    first, s = fronts.start[f], a.shape[0]
    for q in range(s):
        own[q] = x[fronts.unknowns[first + q]]
    for t in range(fronts.own[f]):
        z = own[t] / a[t, t]
        for q in range(np.uint64(t + 1), np.uint64(s)):
            own[q] -= a[t, q] * z
    for q in range(s):
        x[fronts.unknowns[first + q]] = own[q]


@tight
def substitute_back(fronts: Fronts, f: int, x: np.ndarray, own: np.ndarray) -> None:
    """Solve for the unknowns of front f, whose rows D·Lᵀ are kept, in place in x; ``own`` is room for its unknowns.

    Sums run in four parts, which wait for one another less.
    """
    first, rows, from_ = fronts.start[f], fronts.rows, fronts.held[f]
    s = fronts.start[f + 1] - first
    for q in range(s):
        own[q] = x[fronts.unknowns[first + q]]
    for t in range(fronts.own[f] - 1, -1, -1):
        row = from_ + t * s
        z0, z1, z2, z3 = own[t], 0.0, 0.0, 0.0
        q = t + 1
        while q + 4 <= s:
            z0 -= rows[row + q] * own[q]
            z1 -= rows[row + q + 1] * own[q + 1]
            z2 -= rows[row + q + 2] * own[q + 2]
            z3 -= rows[row + q + 3] * own[q + 3]
            q += 4
        while q < s:
            z0 -= rows[row + q] * own[q]
            q += 1
        own[t] = (z0 + z1 + z2 + z3) / rows[row + t]
    for t in range(fronts.own[f]):
        x[fronts.unknowns[first + t]] = own[t]


@kernel
def solve(
    fronts: Fronts,
    nodes: tuple[np.ndarray, np.ndarray],
    number: np.ndarray,
    blocks: np.ndarray,
    slopes: np.ndarray,
    soft: float,
    right: np.ndarray,
) -> np.ndarray:
    """Solution (2n,) for ``right`` (2n,).

    ``blocks`` (n, 5, 2, 2) of each node with those ``AFTER`` it, or (n, 7, 2, 2) ``FURTHER``; ``slopes`` (2, 2n)
    of the unknowns with the tensions of their warp and weft yarns, whose diagonal is -``soft``: with soft = 1/κ the
    matrix is that with κ·slope·slopeᵀ added. With soft = 0 there are no yarns. Not finite where a pivot vanishes.
    """
    m, rows, left = len(fronts.own), fronts.rows, fronts.left
    place, x = np.zeros(len(fronts.home), np.int64), np.zeros(len(fronts.home))
    to, own = np.empty(len(fronts.home), np.int64), np.empty(len(fronts.home))
    x[: len(right)] = right
    for f in range(m):
        first, s, e = fronts.start[f], fronts.start[f + 1] - fronts.start[f], fronts.own[f]
        for t in range(s):
            place[fronts.unknowns[first + t]] = t
        a = fronts.front[: s * s].reshape(s, s)
        a[:] = 0.0
        for g in fronts.halves[f]:
            if g >= 0:
                add_passed(a, fronts, place, g, to)
        add_own(a, f, fronts, place, nodes, number, blocks, slopes, soft)
        eliminate(a, e)
        reduce_right(a, fronts, f, x, own)
        rows[fronts.held[f] : fronts.held[f] + e * s] = fronts.front[: e * s]
        for t in range(s - e):
            at = fronts.passed[f] + t * (s - e)
            left[at + t : at + s - e] = a[e + t, e + t :]
    for f in range(m - 1, -1, -1):
        substitute_back(fronts, f, x, own)
    return x[: len(right)]
