"""The nearest point of a surface, exact at any scale."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit

from geomdrap.surface.types import Floats, Ints

ON_SIDE = 1e-9  # share of a face: a point that has less of a corner lies on the side across from it


@dataclass(frozen=True)
class Nearest:
    """Nearest points of a surface: face (k,) int64, point (k, 3) mm, distance (k,) mm.

    A query that is not finite has face -1 and NaN.
    """

    face: Ints
    point: Floats
    distance: Floats


class NearestTree:
    """Tree of boxes over the triangles.

    The tree works on coordinates shifted to the centre and divided by the diagonal: libraries compare
    squared distances with absolute tolerances, which is wrong for parts in metres or far from the origin.
    """

    def __init__(self, points: Floats, triangles: Ints) -> None:
        import igl

        low, high = points.min(axis=0), points.max(axis=0)
        self.center = 0.5 * (low + high)
        self.scale = float(np.linalg.norm(high - low))
        self.points = np.ascontiguousarray((points - self.center) / self.scale)
        self.triangles = np.ascontiguousarray(triangles, dtype=np.int64)
        self.tree: Any = igl.AABB()
        self.tree.init(self.points, self.triangles)

    def query(self, points: Floats) -> Nearest:
        """Nearest points to points (k, 3)."""
        queries = np.ascontiguousarray(np.atleast_2d(points), dtype=np.float64)
        good = np.isfinite(queries).all(axis=1)
        face = np.full(len(queries), -1, np.int64)
        point = np.full((len(queries), 3), np.nan)
        if good.any():
            local = (queries[good] - self.center) / self.scale
            _, found, at = self.tree.squared_distance(self.points, self.triangles, local)
            face[good] = found.ravel()
            point[good] = at * self.scale + self.center
        return Nearest(face, point, np.linalg.norm(point - queries, axis=1))


def nearest_to_one(points: Floats, triangles: Ints, query: Floats) -> Nearest:
    """The nearest point to one query (1, 3), by a tree of the faces about it only: a whole one takes far longer."""
    some = faces_about(points, triangles, query[0]) if np.isfinite(query).all() else np.zeros(0, np.int64)
    if len(some) == 0:
        return Nearest(np.array([-1]), np.full((1, 3), np.nan), np.array([np.nan]))
    found = NearestTree(points, triangles[some]).query(query)
    return Nearest(some[found.face], found.point, found.distance)


def of_lowest_number(found: Nearest, points: Floats, triangles: Ints) -> Nearest:
    """A point found (1, 3) on the face of the lowest number of those that hold it.

    On a side or in a corner trees choose by how they were made, and the same origin had another heading.
    """
    if found.face[0] < 0:
        return found
    corners = triangles[found.face[0]]
    legs = points[corners] - found.point[0]
    share = np.linalg.norm(np.cross(np.roll(legs, -1, axis=0), np.roll(legs, -2, axis=0)), axis=1)
    has = share > ON_SIDE * share.sum()
    if has.all() or not has.any():  # inside, or on a face without area
        return found
    held = np.ones(len(triangles), np.bool_)
    for vertex in corners[has]:
        there = (points == points[vertex]).all(axis=1)  # both sides of a cut
        held &= there[triangles].any(axis=1)
    return Nearest(np.flatnonzero(held)[:1], found.point, found.distance)


@njit(cache=True)
def faces_about(points, triangles, query):  # type: ignore[no-untyped-def]
    """Numbers (k,) of the faces that may be nearest to a query (3,).

    Their nearest corner is further off than the nearest vertex by no more than their longest edge.
    """
    away = np.empty(len(points))
    for n in range(len(points)):
        x, y, z = points[n, 0] - query[0], points[n, 1] - query[1], points[n, 2] - query[2]
        away[n] = np.sqrt(x * x + y * y + z * z)
    least = away.min()
    near = np.zeros(len(triangles), np.bool_)
    for f in range(len(triangles)):
        longest = 0.0
        for k in range(3):
            a, b = triangles[f, k], triangles[f, (k + 1) % 3]
            x, y, z = points[a, 0] - points[b, 0], points[a, 1] - points[b, 1], points[a, 2] - points[b, 2]
            longest = max(longest, np.sqrt(x * x + y * y + z * z))
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        near[f] = min(away[a], away[b], away[c]) <= least + longest
    return np.flatnonzero(near)
