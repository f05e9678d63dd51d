"""Closed outlines of the draped part of a surface in the flat fabric."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from geomdrap.geodesic.compiled import inlined, kernel

SAME = 0.1  # cells: corners that agree this closely across an edge are joined in the flat fabric, not cut apart
TOUCH = 1e-6  # mm or cells: a point this close to a line lies on it


@inlined
def surely_joined(kind: np.ndarray, neighbours: np.ndarray, f: int, k: int) -> bool:
    """Whether both facets of edge k of facet f lie in the net (kind 1); most do.

    They take the coordinates of their vertices, so that two of them always join.
    """
    g = neighbours[f, k]
    return g >= 0 and kind[f] == 1 and kind[g] == 1


@kernel
def is_open(
    at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray, f: int, k: int
) -> bool:
    """Whether edge k of facet f is an edge of the flat pattern: nothing draped beyond it, or on another sheet."""
    g = neighbours[f, k]
    if g < 0 or kind[g] == 0:
        return True
    e = neighbour_edge[f, k]
    for side in range(2):
        mine, its = (k + side) % 3, (e + 1 - side) % 3
        if abs(at[f, mine, 0] - at[g, its, 0]) > SAME or abs(at[f, mine, 1] - at[g, its, 1]) > SAME:
            return True
    return False


@kernel
def walk_outlines(
    at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Outlines as half-edges ``3·facet + edge`` one after the other, and where each begins (and the end)."""
    m = len(kind)
    used = np.zeros(3 * m, np.bool_)
    walk = np.empty(3 * m, np.int64)
    begin = np.empty(3 * m + 1, np.int64)
    count = loops = 0
    for first in range(m):
        for edge in range(3):
            if kind[first] == 0 or surely_joined(kind, neighbours, first, edge) or used[3 * first + edge]:
                continue
            if not is_open(at, kind, neighbours, neighbour_edge, first, edge):
                continue
            begin[loops] = count
            loops += 1
            f, k = first, edge
            while not used[3 * f + k]:
                used[3 * f + k] = True
                walk[count] = 3 * f + k
                count += 1
                k = (k + 1) % 3
                while not is_open(at, kind, neighbours, neighbour_edge, f, k):
                    f, k = neighbours[f, k], (neighbour_edge[f, k] + 1) % 3
    begin[loops] = count
    return walk[:count], begin[: loops + 1]


def outlines(
    at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray
) -> list[np.ndarray]:
    """Closed polygons (k, 2) in cells; counter-clockwise around the fabric, clockwise around openings in it."""
    walk, begin = walk_outlines(at, kind, neighbours, neighbour_edge)
    points = at[walk // 3, walk % 3]
    return [points[a:b] for a, b in pairwise(begin)]


@kernel
def signed_area(polygon: np.ndarray) -> float:
    """Area of a closed polygon (k, 2), positive if counter-clockwise; from its first point, for the digits' sake."""
    total = 0.0
    for a in range(1, len(polygon) - 1):
        ux, uy = polygon[a, 0] - polygon[0, 0], polygon[a, 1] - polygon[0, 1]
        vx, vy = polygon[a + 1, 0] - polygon[0, 0], polygon[a + 1, 1] - polygon[0, 1]
        total += 0.5 * (ux * vy - uy * vx)
    return total


@kernel
def clip_to_rectangle(polygon: np.ndarray, half: tuple[float, float]) -> np.ndarray:
    """The part of a closed polygon (k, 2) with |x| ≤ half[0] and |y| ≤ half[1] (Sutherland and Hodgman, 1974)."""
    for axis in range(2):
        for sign in (1.0, -1.0):
            cut = np.empty((2 * len(polygon), 2))
            count = 0
            for a in range(len(polygon)):
                b = a + 1 if a + 1 < len(polygon) else 0
                over, over_next = sign * polygon[a, axis] - half[axis], sign * polygon[b, axis] - half[axis]
                if over <= 0.0:
                    cut[count] = polygon[a]
                    count += 1
                if (over > 0.0) != (over_next > 0.0):
                    cut[count] = polygon[a] + over / (over - over_next) * (polygon[b] - polygon[a])
                    count += 1
            polygon = cut[:count]
    return polygon


@kernel
def shares_in_rectangle(triangles: np.ndarray, half: tuple[float, float]) -> np.ndarray:
    """Share (m,) of the area of each triangle (m, 3, 2) with |x| ≤ half[0] and |y| ≤ half[1]; 0 where it has none."""
    share = np.zeros(len(triangles))
    for m in range(len(triangles)):
        whole = signed_area(triangles[m])
        if whole != 0.0:
            share[m] = signed_area(clip_to_rectangle(triangles[m], half)) / whole
    return share


def simplify(polygon: np.ndarray, tolerance: float) -> np.ndarray:
    """Leave out the points of a closed polygon (k, 2) that lie within ``tolerance`` of the line past them."""
    keep = np.ones(len(polygon), bool)
    for parity in (0, 1):
        points = polygon[keep]
        if len(points) < 6:
            break
        before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
        chord, way = after - before, points - before
        length = np.maximum(np.hypot(*chord.T), 1e-300)
        off = np.abs(chord[:, 0] * way[:, 1] - chord[:, 1] * way[:, 0]) / length
        between = (way * chord).sum(axis=1) * ((points - after) * -chord).sum(axis=1) > 0.0
        drop = (off <= tolerance) & between & (np.arange(len(points)) % 2 == parity)
        keep[np.flatnonzero(keep)[drop]] = False
    return polygon[keep]


@kernel
def find_crossings(a: np.ndarray, b: np.ndarray) -> tuple[int, int]:
    """Number of pairs of segments a → b (n, 2) that cross each other properly, and one of such a pair (or -1)."""
    count, where = 0, -1
    for i in range(len(a)):
        low_x, high_x = min(a[i, 0], b[i, 0]), max(a[i, 0], b[i, 0])
        low_y, high_y = min(a[i, 1], b[i, 1]), max(a[i, 1], b[i, 1])
        for j in range(i):
            if min(a[j, 0], b[j, 0]) > high_x or max(a[j, 0], b[j, 0]) < low_x:
                continue
            if min(a[j, 1], b[j, 1]) > high_y or max(a[j, 1], b[j, 1]) < low_y:
                continue
            if parts(a[i], b[i], a[j], b[j]) and parts(a[j], b[j], a[i], b[i]):
                count, where = count + 1, i
    return count, where


@kernel
def parts(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> bool:
    """Whether the line through p and q parts the points r and s (2,), neither of which touches it."""
    first, second = turns(p, q, r), turns(p, q, s)
    return first * second < 0.0 and min(abs(first), abs(second)) > TOUCH * math.hypot(q[0] - p[0], q[1] - p[1])


@kernel
def turns(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> float:
    """Twice the signed area of a triangle."""
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def self_crossings(polygons: Sequence[np.ndarray]) -> tuple[int, np.ndarray]:
    """How often closed polygons (k, 2) cross themselves and each other, and a point (2,) near where one does."""
    if not len(polygons):
        return 0, np.full(2, np.nan)
    starts, ends = np.concatenate(polygons), np.concatenate([np.roll(p, -1, axis=0) for p in polygons])
    count, where = find_crossings(starts, ends)
    return int(count), 0.5 * (starts[where] + ends[where]) if count else np.full(2, np.nan)


def is_simple(polygons: Sequence[np.ndarray]) -> bool:
    """Whether closed polygons (k, 2) bound a plane region once: none crosses, and they lie rightly in each other."""
    if self_crossings(polygons)[0] > 0:
        return False
    # a corner may touch another polygon: asked is the middle of the longest side
    around = [sum(winding(p, middle_of_longest(ring)) for p in polygons if p is not ring) for ring in polygons]
    return all(n == (0 if signed_area(p) > 0.0 else 1) for n, p in zip(around, polygons, strict=True))


def middle_of_longest(polygon: np.ndarray) -> np.ndarray:
    """Middle (2,) of the longest side of a closed polygon (k, 2)."""
    onward = np.roll(polygon, -1, axis=0)
    k = np.hypot(*(onward - polygon).T).argmax()
    return 0.5 * (polygon[k] + onward[k])


def winding(polygon: np.ndarray, point: np.ndarray) -> int:
    """How often a closed polygon (k, 2) goes counter-clockwise round a point (2,) that is not on it."""
    a = polygon - point
    b = np.roll(a, -1, axis=0)
    up, down = (a[:, 1] <= 0.0) & (b[:, 1] > 0.0), (a[:, 1] > 0.0) & (b[:, 1] <= 0.0)
    left = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return int((up & (left > 0.0)).sum() - (down & (left < 0.0)).sum())
