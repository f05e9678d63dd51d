"""The order in which the unknowns of a net are eliminated: nested dissection.

A rectangle of the net is cut in two by a line of nodes, each half again, down to a few nodes. What lies inside a
rectangle is eliminated before the line that cuts it, so that it meets only the ring of nodes around the rectangle:
the system falls apart into small dense ones (fronts), each of which passes on what is left on its ring. Where nodes
also meet those next but one along their yarns (a reach of 2), cuts and rings are two nodes wide.

Whole yarns may have an unknown each, their tension, which meets all nodes of the yarn. It is eliminated with the
smallest rectangle that holds the whole yarn.

Source: A. George, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10 (1973).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geomdrap.geodesic.compiled import kernel, tight

LEAF = 16  # nodes of a rectangle that is not cut any more
AFTER = (0, 0), (0, 1), (1, -1), (1, 0), (1, 1)  # a node itself, and those after it that it meets
FURTHER = (*AFTER, (0, 2), (2, 0))  # with a reach of 2


class Fronts(NamedTuple):
    """The order of elimination for n nodes and, if any, k yarns: unknowns 2·node and 2·node + 1, then 2n + yarn.

    ``unknowns`` [start[f] : start[f + 1]] of front f, of which the first ``own`` [f] are eliminated there; ``home``
    (2n + k,) the front of each; ``halves`` (fronts, 2) that come before it, -1 for none, in post-order, so that what
    they pass on lies on top of a stack. ``rows`` and ``left`` are room for what is kept of all fronts and what they
    pass on, at ``held`` and ``passed`` (fronts,), ``front`` for the largest; ``solve`` works in these, so not twice
    at a time.
    """

    unknowns: np.ndarray
    start: np.ndarray
    own: np.ndarray
    home: np.ndarray
    halves: np.ndarray
    held: np.ndarray
    passed: np.ndarray
    rows: np.ndarray
    left: np.ndarray
    front: np.ndarray


@kernel
def rectangles(number: np.ndarray, reach: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Nested rectangles i0, i1, j0, j1 (m, 4) of nodes ``number`` (nu, nv), their cuts and halves.

    A rectangle is followed by all that lies in one half of it, then by all that lies in the other. Cuts (m, 2) are
    the axis, -1 for none, and the first of ``reach`` rows or columns; halves (m, 2) are rectangles, -1 where empty.
    """
    most = 2 * number.size + 1
    box, cut, halves = np.zeros((most, 4), np.int64), np.full((most, 2), -1), np.full((most, 2), -1)
    waiting = np.zeros((most, 2), np.int64)  # halves: of which rectangle, and which of the two
    waiting[0] = -1
    count, left = 0, 1
    while left > 0:
        left -= 1
        at, (whole, half) = count, waiting[left]
        count += 1
        if whole < 0:
            box[at, 1], box[at, 3] = number.shape
        else:
            box[at] = half_of(box[whole], cut[whole], half, reach)
            halves[whole, half] = at
        i0, i1, j0, j1 = box[at]
        if (i1 - i0) * (j1 - j0) <= LEAF:
            continue
        axis = 0 if i1 - i0 >= j1 - j0 else 1
        cut[at, 0], cut[at, 1] = axis, (i0 + i1) // 2 if axis == 0 else (j0 + j1) // 2
        for half in range(2):
            i0, i1, j0, j1 = half_of(box[at], cut[at], half, reach)
            if (number[i0:i1, j0:j1] >= 0).any():
                waiting[left, 0], waiting[left, 1] = at, half
                left += 1
    return box[:count], cut[:count], halves[:count]


@kernel
def half_of(box: np.ndarray, cut: np.ndarray, half: int, reach: int) -> np.ndarray:
    """One of the two rectangles (4,) beside the cut."""
    out = box.copy()
    out[2 * cut[0] + 1 - half] = cut[1] + half * reach
    return out


@kernel
def homes_of_yarns(box: np.ndarray, nu: int, nv: int) -> np.ndarray:
    """Fronts (nv + nu,) that hold the whole of each warp and weft yarn; rectangles (m, 4) precede their halves."""
    last = len(box) - 1
    home = np.full(nv + nu, last)
    for at in range(len(box)):
        i0, i1, j0, j1 = box[at]
        if i0 == 0 and i1 == nu:
            home[j0:j1] = last - at
        if j0 == 0 and j1 == nv:
            home[nv + i0 : nv + i1] = last - at
    return home


@tight
def list_nodes(
    number: np.ndarray,
    box: np.ndarray,
    cut: np.ndarray,
    at: int,
    ring: bool,
    reach: int,
    unknowns: np.ndarray,
    count: int,
) -> int:
    """Put the unknowns of a rectangle's cut, or of all if it has none, or of its ring on the list: its new length."""
    i0, i1, j0, j1 = box[at, 0], box[at, 1], box[at, 2], box[at, 3]
    margin = reach if ring else 0
    for i in range(max(i0 - margin, 0), min(i1 + margin, number.shape[0])):
        for j in range(max(j0 - margin, 0), min(j1 + margin, number.shape[1])):
            away_i, away_j = max(i0 - i, i - i1 + 1, 0), max(j0 - j, j - j1 + 1, 0)
            met = (away_i < 2 and away_j < 2) or away_i * away_j == 0  # next but one only along a yarn
            on_ring = away_i + away_j > 0 and met
            on_cut = cut[at, 0] < 0 or 0 <= (i if cut[at, 0] == 0 else j) - cut[at, 1] < reach
            if number[i, j] >= 0 and (on_ring if ring else on_cut):
                unknowns[count], unknowns[count + 1] = 2 * number[i, j], 2 * number[i, j] + 1
                count += 2
    return count


@tight
def list_yarns(
    home: np.ndarray,
    first: int,
    nv: int,
    box: np.ndarray,
    at: int,
    f: int,
    ring: bool,
    unknowns: np.ndarray,
    count: int,
) -> int:
    """Put the yarns of a rectangle, counted from ``first``, that end with front f, or later, on the list."""
    for axis in range(2):
        shift = first + (nv if axis == 0 else 0)
        for k in range(box[at, 2 * axis], box[at, 2 * axis + 1]):
            where = home[shift + k]
            if where > f if ring else where == f:
                unknowns[count] = shift + k
                count += 1
    return count


@kernel
def dissect(number: np.ndarray, n: int, yarns: bool, reach: int = 1) -> Fronts:
    """Fronts for n nodes ``number`` (nu, nv), -1 for none; with ``yarns`` also of nv warp and nu weft yarns.

    Nodes meet those ``AFTER`` them, with a ``reach`` of 2 also those ``FURTHER``.
    """
    nu, nv = number.shape
    box, cut, cut_halves = rectangles(number, reach)
    m = len(box)
    home = np.zeros(2 * n + (nu + nv if yarns else 0), np.int64)
    if yarns:
        home[2 * n :] = homes_of_yarns(box, nu, nv)
    halves, own, start = np.full((m, 2), -1), np.zeros(m, np.int64), np.zeros(m + 1, np.int64)
    unknowns = np.empty(16 * n, np.int64)
    count = 0
    for f in range(m):
        at = m - 1 - f  # halves before the whole
        for half in range(2):
            if cut_halves[at, half] >= 0:
                halves[f, half] = m - 1 - cut_halves[at, half]
        most = 8 * reach * (box[at, 1] - box[at, 0] + box[at, 3] - box[at, 2]) + 2 * LEAF + 16
        if count + most > len(unknowns):
            unknowns = np.concatenate((unknowns, np.empty(len(unknowns) + most, np.int64)))
        for ring in range(2):
            before = count
            count = list_nodes(number, box, cut, at, ring == 1, reach, unknowns, count)
            if ring == 0:
                home[unknowns[before:count]] = f
            if yarns:
                count = list_yarns(home, 2 * n, nv, box, at, f, ring == 1, unknowns, count)
            if ring == 0:
                own[f] = count - start[f]
        start[f + 1] = count
    size = start[1:] - start[:-1]
    held, passed, most = np.zeros(m, np.int64), np.zeros(m, np.int64), 0
    held[1:] = np.cumsum(own * size)[:-1]
    end = 0  # of what is passed on and still waits
    for f in range(m):
        for half in halves[f]:
            if half >= 0:
                end = min(end, passed[half])
        passed[f] = end
        end += (size[f] - own[f]) ** 2
        most = max(most, end)
    rows, left, front = np.empty(held[-1] + own[-1] * size[-1]), np.empty(most), np.empty(size.max() ** 2)
    return Fronts(unknowns[:count].copy(), start, own, home, halves, held, passed, rows, left, front)
