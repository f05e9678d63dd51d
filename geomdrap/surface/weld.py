"""Vertices that are one and the same, found in one pass over a hash of grid cells.

Optimisation note: an STL of a million facets has three million corners; the pass costs about 0.1 µs each.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from geomdrap.surface.types import Floats, Ints

#: vertices closer than this share of the part's diagonal are one vertex
NEAR = 1e-6
#: but never more than this share of the median edge, so that a far-off facet cannot collapse real edges
SHARE_OF_EDGE = 1e-3


def weld_vertices(points: Floats, triangles: Ints) -> tuple[Ints, float]:
    """Number of the first vertex at the same place for each vertex (n,) int64, and the tolerance used.

    points (n, 3), triangles (m, 3). Vertices within the tolerance are one; it scales with the part. Vertices
    without a triangle stay alone and do not count.
    """
    used, low, high = used_points(points, triangles)
    all_used = len(used) == len(points)
    places = points if all_used else points[used]
    diagonal = float(np.linalg.norm(high - low))
    edge = float(np.sqrt(np.median(edge_lengths_squared(points, triangles))))
    tolerance = max(min(NEAR * diagonal, SHARE_OF_EDGE * edge), 1e-12 * diagonal)
    first = weld(places, tolerance, low)
    if all_used:
        return first, tolerance
    whole = np.arange(len(points))
    whole[used] = used[first]
    return whole, tolerance


def used_points(points: Floats, triangles: Ints) -> tuple[Ints, Floats, Floats]:
    """Numbers (k,) of the points that a triangle names, and their least and greatest coordinates (3,)."""
    mark, box = mark_used(points, triangles)
    return np.flatnonzero(mark), box[0], box[1]


@njit(cache=True)
def mark_used(points, triangles):  # type: ignore[no-untyped-def]
    """Whether a triangle names each point (n,), and the bounding box (2, 3) of those that are named."""
    mark = np.zeros(len(points), np.bool_)
    box = np.empty((2, 3))
    for a in range(3):
        box[0, a] = box[1, a] = points[triangles[0, 0], a]
    for f in range(len(triangles)):
        for k in range(3):
            i = triangles[f, k]
            mark[i] = True
            for a in range(3):
                box[0, a] = min(box[0, a], points[i, a])
                box[1, a] = max(box[1, a], points[i, a])
    return mark, box


@njit(cache=True)
def edge_lengths_squared(points, triangles):  # type: ignore[no-untyped-def]
    """Return squared lengths (3 m,) of the edges of all triangles."""
    lengths = np.empty(3 * len(triangles))
    for f in range(len(triangles)):
        for k in range(3):
            i, j = triangles[f, k], triangles[f, (k + 1) % 3]
            x = points[i, 0] - points[j, 0]
            y = points[i, 1] - points[j, 1]
            z = points[i, 2] - points[j, 2]
            lengths[3 * f + k] = x * x + y * y + z * z
    return lengths


@njit(cache=True)
def weld(points, tolerance, low):  # type: ignore[no-untyped-def]
    """Give each point (n, 3) the number of the first point within the tolerance: (n,) int64.

    low (3,) is the least corner of the points' bounding box.

    Each point joins the nearest representative in reach or becomes one itself, so chains of close points
    do not collapse into one. Cells are four tolerances wide: a point looks into a second cell only where
    it lies within a tolerance of the cell's wall.
    """
    n = len(points)
    size = 16
    while size < 2 * n:
        size *= 2
    mask = np.uint64(size - 1)
    table = np.full(size, -1, np.int32)
    width = 4.0 * tolerance if tolerance > 0 else 1.0
    limit = tolerance * tolerance
    first = np.empty(n, np.int64)
    cells = np.empty((n, 3), np.int64)
    corner, cell = np.empty((2, 3), np.int64), np.empty(3, np.int64)
    for i in range(n):
        best, best_distance = -1, limit
        for a in range(3):
            cells[i, a] = np.int64(np.floor((points[i, a] - low[a]) / width))
        # the same cell first: an exact twin there ends the search
        start = _cell_hash(cells[i, 0], cells[i, 1], cells[i, 2]) & mask
        best, best_distance = _look(table, mask, start, points, cells, i, cells[i], best, best_distance)
        if best < 0 or best_distance > 0.0:
            for a in range(3):
                corner[0, a] = np.int64(np.floor((points[i, a] - tolerance - low[a]) / width))
                corner[1, a] = np.int64(np.floor((points[i, a] + tolerance - low[a]) / width))
            for x in range(corner[0, 0], corner[1, 0] + 1):
                for y in range(corner[0, 1], corner[1, 1] + 1):
                    for z in range(corner[0, 2], corner[1, 2] + 1):
                        if x == cells[i, 0] and y == cells[i, 1] and z == cells[i, 2]:
                            continue
                        cell[0], cell[1], cell[2] = x, y, z
                        slot = _cell_hash(x, y, z) & mask
                        best, best_distance = _look(
                            table, mask, slot, points, cells, i, cell, best, best_distance
                        )
        if best >= 0:
            first[i] = best
            continue
        first[i] = i
        while table[start] >= 0:
            start = (start + np.uint64(1)) & mask
        table[start] = i
    return first


@njit(cache=True, inline="always")
def _cell_hash(x, y, z):  # type: ignore[no-untyped-def]
    h = np.uint64(x) * np.uint64(0x9E3779B97F4A7C15)
    h ^= np.uint64(y) * np.uint64(0xC2B2AE3D27D4EB4F)
    h ^= np.uint64(z) * np.uint64(0x165667B19E3779F9)
    h ^= h >> np.uint64(29)
    h *= np.uint64(0xBF58476D1CE4E5B9)
    return h ^ (h >> np.uint64(32))


@njit(cache=True)
def _look(  # type: ignore[no-untyped-def]
    table, mask, slot, points, cells, i, cell, best, best_distance
):
    """Nearest representative of point i in one cell, if nearer than the best so far."""
    while table[slot] >= 0:
        j = table[slot]
        if cells[j, 0] == cell[0] and cells[j, 1] == cell[1] and cells[j, 2] == cell[2]:
            x = points[i, 0] - points[j, 0]
            y = points[i, 1] - points[j, 1]
            z = points[i, 2] - points[j, 2]
            distance = x * x + y * y + z * z
            if distance < best_distance or (best < 0 and distance <= best_distance):
                best, best_distance = j, distance
        slot = (slot + np.uint64(1)) & mask
    return best, best_distance
